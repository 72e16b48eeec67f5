"""scripts/cloud_tracker.py: a world that is pulled to clouds follows the cable that they show."""
import pathlib
import sys

import numpy as np
import pytest

pytest.importorskip('verlet_cable.camera')
from verlet_cable.camera import Camera  # noqa: E402
from verlet_cable.sim import Scene, World  # noqa: E402

CHECKOUT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(CHECKOUT / 'scripts'))
from cloud_tracker import CloudTracker  # noqa: E402

HANDS = [('left_hand', [-0.4, 0, 1.05]), ('right_hand', [0.4, 0, 1.05])]
RADIUS, DENSITY = 0.012, 0.1


def moved(time):
    """Where the hands are [m]: a decimetre to and fro, each another way."""
    left, right = (np.array(position, dtype=float) for _, position in HANDS)
    return (left + [0, 0.1 * np.sin(2 * time), 0.08 * np.sin(3 * time)],
            right + [-0.15 * (1 - np.cos(1.5 * time)), 0, 0.1 * np.sin(2 * time)])


def test_a_world_follows_the_clouds_of_a_cable_that_hands_move():
    scene = Scene.load(str(CHECKOUT / 'config/examples/tracker.yaml'))
    truth, model = World(scene), World(scene)
    step, frame = scene.time_step, 0.02
    tracker = CloudTracker(model, 'rope', HANDS, RADIUS, DENSITY, step)
    camera = Camera(320, 240, horizontal_fov=1.094, noise={'axial': [0.001, 0, 0]}).look_at([0, -1.3, 0.9], [0, 0, 0.8])
    errors, unmoved = [], []
    for index in range(150):
        for _ in range(round(frame / step)):
            for name, position in zip(('left_hand', 'right_hand'), moved(truth.time)):
                truth.set_frame(name, position, [0, 0, 0, 1])
            truth.step()
        images = camera.render(truth, ['points', 'truth'])
        points = images['points'].reshape(-1, 3).astype(float)
        points = points[np.isfinite(points[:, 2])]
        tracker.update(in_fixed_frame(points, camera.pose), frame)
        if index >= 50:
            errors.append(np.linalg.norm(tracker.nodes - truth.positions('rope'), axis=1))
            unmoved.append(np.linalg.norm(World(scene).positions('rope') - truth.positions('rope'), axis=1))
    assert np.mean(errors) < 0.01
    assert np.max(errors) < 0.05
    assert np.mean(unmoved) > 5 * np.mean(errors)


def in_fixed_frame(points, pose):
    x, y, z, w = pose[3:]
    axes = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return points @ axes.T + pose[:3]
