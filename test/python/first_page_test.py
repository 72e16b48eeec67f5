"""The first page's rope, which a reader pulls at with the mouse: it comes to rest while he watches."""
import re
from pathlib import Path

import numpy as np

from verlet_cable.sim import Scene, World

PAGE = Path(__file__).resolve().parents[2] / 'doc/first_cable.md'
IDENTITY = [0, 0, 0, 1]
AT_REST = 1e-3  # [m] that it swings, from one side to the other: half a pixel where the rope is 800 wide


def swing(world, steps):
    """[m] How far the rope's nodes move within so many steps, at most."""
    places = []
    for _ in range(steps):
        world.step()
        places.append(world.positions('rope').copy())
    return np.ptp(places, axis=0).max()


def test_a_rope_that_was_pulled_is_at_rest_within_half_a_minute():
    scene = Scene.from_yaml(re.search(r'```yaml file=my_rope.yaml\n(.*?)```', PAGE.read_text(), re.DOTALL)[1])
    world = World(scene)
    middle = world.positions('rope')[30].copy()
    world.add_frame('mouse', middle, IDENTITY)
    pulled = world.pin('rope', node=30, frame_id='mouse')
    steps = round(1 / scene.time_step)
    for part in np.linspace(0, 1, steps):
        world.set_frame('mouse', middle + part * np.array([0, 0.3, 0.1]), IDENTITY)
        world.step()
    world.unpin(pulled.name)
    assert swing(world, 2 * steps) > 100 * AT_REST
    world.step(26 * steps)
    assert swing(world, 2 * steps) < AT_REST
