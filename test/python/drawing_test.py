"""World.draw makes a picture that shows what there is."""
import io
import sys

import numpy as np
import pytest

from verlet_cable.sim import Batch, Scene, World

image = pytest.importorskip('matplotlib.image')

START = b'\x89PNG\r\n\x1a\n'


@pytest.fixture(autouse=True, params=['camera', 'matplotlib'])
def drawn_by(request, monkeypatch):
    """Once by the camera, where it is built, and once as without it."""
    if request.param == 'camera':
        pytest.importorskip('verlet_cable.camera')
    else:
        monkeypatch.setitem(sys.modules, 'verlet_cable.camera', None)


def pixels(picture):
    """(height, width, 3) from 0 to 1."""
    return image.imread(io.BytesIO(picture))[:, :, :3]


def is_reddish(colors):
    return (colors[..., 0] > 0.3) & (colors[..., 1] < 0.35 * colors[..., 0]) & (colors[..., 2] < 0.35 * colors[..., 0])


@pytest.fixture
def wall(hang):
    """A red cable along x, from the front hidden by a wide box."""
    hang['cables'][0].update(color=[1, 0, 0, 1], initial={'type': 'straight', 'from': [-0.5, 0, 1], 'to': [0.5, 0, 1]}, attachments=[])
    hang['obstacles'] = [{'name': 'wall', 'type': 'box', 'size': [2, 0.1, 1], 'pose': [0, -0.5, 1, 0, 0, 0]}]
    return World(Scene.from_dict(hang))


def test_a_picture_is_written_or_returned(hang, tmp_path):
    world = World(Scene.from_dict(hang))
    picture = world.draw()
    assert picture.startswith(START) and pixels(picture).shape == (600, 800, 3)
    assert world.draw(tmp_path / 'a.png') is None
    assert (tmp_path / 'a.png').read_bytes() == picture == world._repr_png_()
    assert pixels(world.draw(size=(321, 200))).shape == (200, 321, 3)
    world.step()
    assert world.draw(view=(0, 0)) != world.draw(view=(0, 90))


def test_a_batch_draws_its_worlds(hang, tmp_path):
    batch = Batch(Scene.from_dict(hang), 2)
    batch.tune(1, gravity=[0, 5, -5])
    batch.step(20)
    for index in (0, 1, -1):
        assert batch.draw(index, view=(0, 0), size=(200, 150)) == batch.world(index).draw(view=(0, 0), size=(200, 150))
    assert batch.draw(0, view=(0, 0)) != batch.draw(1, view=(0, 0))
    assert batch.draw(1, tmp_path / 'a.png') is None and (tmp_path / 'a.png').read_bytes() == batch.draw(1)
    with pytest.raises(IndexError):
        batch.draw(2)


def test_what_is_in_front_hides_what_is_behind(wall):
    assert is_reddish(pixels(wall.draw(view=(0, 90)))[60:]).sum() > 200  # below the legend
    assert is_reddish(pixels(wall.draw(view=(0, -90)))[60:]).sum() == 0


def test_lengths_are_equal_along_all_axes(hang):
    """Two cables of one length, along x and z, seen from the front."""
    cable = dict(hang['cables'][0], attachments=[], name='across', color=[1, 0, 0, 1],
                 initial={'type': 'straight', 'from': [0, 0, 0], 'to': [1, 0, 0]})
    up = dict(cable, name='up', color=[0, 0, 1, 1], initial={'type': 'straight', 'from': [1.5, 0, 0], 'to': [1.5, 0, 1]})
    hang['cables'] = [cable, up]
    colors = pixels(World(Scene.from_dict(hang)).draw(view=(0, -90)))[60:]
    width = np.ptp(np.nonzero(is_reddish(colors).any(axis=0))[0])
    height = np.ptp(np.nonzero(is_reddish(colors[..., ::-1]).any(axis=1))[0])
    assert width > 150 and abs(width - height) <= 3


def test_everything_is_drawn(hang):
    hang['obstacles'] = [{'name': 'floor', 'type': 'plane'}, {'name': 'can', 'type': 'cylinder', 'radius': 0.1, 'length': 0.3},
                         {'name': 'ball', 'type': 'sphere', 'radius': 0.1}, {'name': 'pill', 'type': 'capsule', 'radius': 0.1, 'length': 0.3}]
    hang['bodies'] = [{'name': 'plug', 'mass': 0.1, 'shapes': [{'type': 'box', 'size': [0.1, 0.1, 0.1]}], 'pose': [0, 0, 1, 0, 0, 0]}]
    hang['particles'] = [{'name': 'p', 'mass': 0.1, 'position': [1, 1, 1], 'velocity': [0, 0, 0]}]
    hang['nets'] = [{'name': 'net', 'grid': {'rows': 3, 'columns': 3, 'spacing': 0.1}, 'mass': 0.1, 'stiffness': 50}]
    for view in (None, (-30, 10), (90, 0)):
        assert World(Scene.from_dict(hang)).draw(view=view).startswith(START)
    # Nothing at all.
    assert World(Scene.from_dict({'particles': hang['particles']})).draw().startswith(START)


@pytest.mark.parametrize('arguments, error, text', [
    ({'path': 'a.jpg'}, ValueError, "path: 'a.jpg'; allowed: a name that ends in .png"),
    ({'path': 3}, TypeError, 'path: 3; allowed: None, or the name of a file that ends in .png'),
    ({'view': (1, 2, 3)}, ValueError, 'view: (1, 2, 3); allowed: None, or (elevation, azimuth): two finite numbers [degree]'),
    ({'view': (float('nan'), 2)}, ValueError, 'view: (nan, 2); allowed: None, or (elevation'),
    ({'view': 'top'}, TypeError, "view: 'top'; allowed: None, or (elevation"),
    ({'size': (800, 20)}, ValueError, 'size: (800, 20); allowed: (width, height): two integers from 50 to 10000 [pixel]'),
    ({'size': 800}, TypeError, 'size: 800; allowed: (width'),
    ({'colour': 1}, TypeError, 'colour: no such argument'),
])
def test_arguments_that_do_not_fit_are_named(hang, arguments, error, text):
    with pytest.raises(error) as caught:
        World(Scene.from_dict(hang)).draw(**arguments)
    assert str(caught.value).startswith(text)


def test_without_matplotlib_it_says_so(hang, monkeypatch):
    monkeypatch.setitem(sys.modules, 'matplotlib', None)
    with pytest.raises(ImportError, match='World.draw: .*matplotlib.*sudo apt-get install python3-matplotlib'):
        World(Scene.from_dict(hang)).draw()


def test_it_does_not_touch_the_backend_of_who_calls(hang):
    import matplotlib
    before = matplotlib.get_backend()
    World(Scene.from_dict(hang)).draw()
    assert matplotlib.get_backend() == before
