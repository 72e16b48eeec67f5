"""What rviz shows of a scene, see scripts/rviz_view.py."""
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
