"""What rviz shows of a scene, see scripts/rviz_view.py."""
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import yaml

PACKAGE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PACKAGE / 'scripts'))
import rviz_view  # noqa: E402


def view(name='cable'):
    return yaml.safe_load((PACKAGE / f'rviz/{name}.rviz').read_text(encoding='utf-8'))


def hanging(scale):
    """A rope between two frames, sagging."""
    held = [{'frame': name, 'initial_pose': [x * scale, 0, scale, 0, 0, 0]} for name, x in (('left', -0.4), ('right', 0.4))]
    return {'cables': [{'length': 1.2 * scale, 'attachments': held}]}


@pytest.mark.parametrize('scale', [0.05, 1, 300])
def test_the_camera_sees_the_whole_scene_and_little_else(scale):
    focus, distance = rviz_view.fitted(hanging(scale))
    assert np.abs(focus[:2]).max() < 0.01 * scale
    assert 0.3 * scale < focus[2] < scale
    half_height = distance * np.tan(rviz_view.FIELD_OF_VIEW / 2)
    lowest = scale - np.sqrt(0.6**2 - 0.4**2) * scale  # of a rope that is as deep as it may be, a triangle
    assert half_height > (scale - lowest) / 2
    assert half_height < 1.2 * scale


def test_the_camera_sees_what_is_fixed_in_the_world():
    ends = [{'at': 'start', 'offset': [1, 0, 5]}, {'at': 'end', 'offset': [2, 0, 5]}]
    focus, distance = rviz_view.fitted({'cables': [{'length': 1.2, 'attachments': ends}]})
    assert 1 < focus[0] < 2 and 4 < focus[2] < 5
    assert distance < 3


def test_the_camera_sees_loose_ends():
    held = [{'at': at, 'frame': str(at), 'initial_pose': [at, 0, 0, 0, 0, 0]} for at in (4, 6)]
    focus, distance = rviz_view.fitted({'cables': [{'length': 10, 'attachments': held}]})
    assert focus[0] == pytest.approx(5)
    assert distance * np.tan(rviz_view.FIELD_OF_VIEW / 2) > 5


@pytest.mark.parametrize('scale', [0.05, 300])
def test_axes_of_frames_are_as_large_on_the_screen_at_any_scale(scale):
    sizes = []
    for scene in (hanging(1), hanging(scale)):
        shown = view()
        rviz_view.aim(shown, scene)
        frames, = [item for item in shown['Visualization Manager']['Displays'] if item['Class'] == 'rviz/TF']
        sizes.append(frames['Marker Scale'])
    assert sizes[1] == pytest.approx(max(scale * sizes[0], rviz_view.AXES * rviz_view.CLOSEST))


def test_places_that_are_no_numbers_are_left_to_the_node():
    bad = {'cables': [{'length': 'x', 'attachments': [{'initial_pose': ['a', 0, 0]}, 7]}, 3], 'bodies': 'none'}
    focus, distance = rviz_view.fitted(bad)
    assert np.isfinite(focus).all() and distance > 0


def test_topics_are_those_of_the_node():
    shown = rviz_view.renamed(view(), '/cell/hose')
    text = yaml.safe_dump(shown)
    assert '/cell/hose/markers' in text and '/cell/hose/hands/update' in text and 'Node: /cell/hose' in text
    assert '/cable' not in text.replace('verlet_cable/', '')


def test_what_is_not_built_is_left_out():
    shown = view()
    assert 'verlet_cable/' in yaml.safe_dump(shown)
    rviz_view.without_plugins(shown)
    assert 'verlet_cable/' not in yaml.safe_dump(shown)
    assert any(display['Class'] == 'rviz/MarkerArray' for display in shown['Visualization Manager']['Displays'])


def test_an_aimed_view_can_be_written():
    shown = view()
    rviz_view.aim(shown, hanging(1))
    assert yaml.safe_load(yaml.safe_dump(shown)) == shown


@pytest.mark.parametrize('path', sorted(str(p.relative_to(PACKAGE)) for p in (PACKAGE / 'rviz').rglob('*.rviz')))
def test_every_view_has_the_panel_and_the_legend(path):
    shown = view(path[len('rviz/'):-len('.rviz')])
    assert 'verlet_cable/CablePanel' in [panel['Class'] for panel in shown['Panels']]
    assert 'verlet_cable/Legend' in [display['Class'] for display in shown['Visualization Manager']['Displays']]


def test_a_robot_has_room_around_the_cables_on_it():
    scene = hanging(1)
    _, without = rviz_view.fitted(scene)
    _, distance = rviz_view.fitted({**scene, 'robot': {'description': 'robot_description'}})
    assert distance > 1.2 * without


def test_rviz_is_started_in_the_frame_of_the_scene(tmp_path):
    """All the shipped scenes say "world": with another, nothing was drawn."""
    (tmp_path / 'rviz').write_text('#!/bin/sh\ncp "$2" "$SEEN"\n', encoding='utf-8')
    (tmp_path / 'rviz').chmod(0o755)
    scene, seen = tmp_path / 'scene.yaml', tmp_path / 'seen.rviz'
    for frame in ('base', 'odom'):
        scene.write_text(yaml.safe_dump({**hanging(1), 'frame_id': frame}), encoding='utf-8')
        subprocess.run([sys.executable, PACKAGE / 'scripts/rviz_view.py', PACKAGE / 'rviz/cable.rviz', 'cable', scene, 'true'], check=True,
                       env={**os.environ, 'PATH': f'{tmp_path}:{os.environ["PATH"]}', 'ROS_HOME': str(tmp_path), 'SEEN': str(seen)})
        shown = yaml.safe_load(seen.read_text(encoding='utf-8'))
        assert shown['Visualization Manager']['Global Options']['Fixed Frame'] == frame
        displays = shown['Visualization Manager']['Displays']
        assert {display['Reference Frame'] for display in displays if display['Class'] == 'rviz/Grid'} == {'<Fixed Frame>'}
