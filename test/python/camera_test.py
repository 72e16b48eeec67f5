"""verlet_cable.camera sees what there is."""
import concurrent.futures
import copy
import pickle
import subprocess
import sys

import numpy as np
import pytest

from verlet_cable.sim import Batch, Scene, World

camera = pytest.importorskip('verlet_cable.camera')
Camera = camera.Camera


@pytest.fixture
def table(hang):
    """A red cable along x over a floor, half of it behind a box for who looks from -y."""
    hang['cables'][0].update(color=[1, 0, 0, 1], initial={'type': 'straight', 'from': [-0.5, 0, 0.3], 'to': [0.5, 0, 0.3]}, attachments=[])
    hang['obstacles'] = [{'name': 'floor', 'type': 'plane'},
                         {'name': 'box', 'type': 'box', 'size': [0.6, 0.1, 0.4], 'pose': [0.3, -0.3, 0.3, 0, 0, 0]}]
    hang['bodies'] = [{'name': 'ball', 'mass': 0.1, 'shapes': [{'type': 'sphere', 'radius': 0.1}], 'pose': [-0.3, 0.5, 0.1, 0, 0, 0]}]
    return hang


@pytest.fixture
def front():
    return Camera(160, 120, 0.9, noise={'axial': [0.001, 0, 0]}).look_at([0, -1.5, 0.3], [0, 0, 0.3])


def test_images_are_what_they_say(table, front):
    world = World(Scene.from_dict(table))
    images = front.render(world)
    assert front.labels(world) == ['hose', 'ball', 'floor', 'box']
    kinds = {'depth': ((120, 160), np.float32), 'rgb': ((120, 160, 3), np.uint8), 'mask': ((120, 160), np.uint16),
             'points': ((120, 160, 3), np.float32)}
    assert {name: (images[name].shape, images[name].dtype) for name in kinds} == kinds
    hose = images['mask'] == 1
    assert hose.sum() > 30 and images['rgb'][hose][:, 0].mean() > 2 * images['rgb'][hose][:, 1].mean()
    # The near side of a cable of 5 mm radius that is 1.5 m away; the noise of the mean is below 0.2 mm.
    assert 1.494 < images['depth'][hose].mean() < 1.501
    assert np.isnan(images['depth'][images['mask'] == 0]).all()
    seen = ~np.isnan(images['depth'])
    pixels = images['points'][seen] @ front.matrix.T
    rows, columns = np.nonzero(seen)
    np.testing.assert_allclose(pixels[:, :2] / pixels[:, 2:], np.column_stack([columns, rows]), atol=1e-3)
    assert np.array_equal(images['points'][..., 2], images['depth'], equal_nan=True)


def test_truth_is_where_nodes_are(table, front):
    world = World(Scene.from_dict(table))
    truth = front.render(world, ['truth'])['truth']['hose']
    nodes = world.positions('hose')
    np.testing.assert_allclose(truth['positions'], np.column_stack([nodes[:, 0], 0.3 - nodes[:, 2], nodes[:, 1] + 1.5]), atol=1e-12)
    np.testing.assert_allclose(truth['u'], front.matrix[0, 0] * nodes[:, 0] / 1.5 + 79.5, atol=1e-9)
    assert truth['visible'][:9].all() and not truth['visible'][11:].any()
    # Nothing hides it from above.
    assert front.look_at([0, 0, 1.5], [0, 0, 0], [0, 1, 0]).render(world, ['truth'])['truth']['hose']['visible'].all()


def test_what_is_nearer_than_near_hides(table, front):
    table['obstacles'].append({'name': 'finger', 'type': 'box', 'size': [0.2, 0.01, 0.2], 'pose': [-0.1, -1.45, 0.3, 0, 0, 0]})
    world = World(Scene.from_dict(table))
    images = front.render(world)
    mask = images['mask']
    assert (mask[:, :79] == 5).all() and not (mask[:, 80:] == 5).any()
    assert np.isnan(images['depth'][mask == 5]).all() and np.isnan(images['points'][mask == 5]).all()
    assert not images['truth']['hose']['visible'][:10].any()
    near = Camera(160, 120, 0.9, near=0.01).look_at([0, -1.5, 0.3], [0, 0, 0.3]).render(world)
    assert np.nanmax(near['depth'][mask == 5]) < 0.1
    assert np.array_equal(near['mask'], mask) and np.array_equal(near['rgb'], images['rgb'])


def test_tables_are_seen_from_above(table):
    """As on a map."""
    world = World(Scene.from_dict(table))
    truth = Camera(160, 120).look_at([0, 0, 1.5], [0, 0, 0]).render(world, ['truth'])['truth']['hose']
    assert (np.diff(truth['u']) > 0).all() and np.allclose(truth['v'], 59.5)
    with pytest.raises(ValueError, match=r'up: \[0, 0, 1\], along the line of sight.*such as \[0, 1, 0\] for what is seen from above'):
        Camera().look_at([0, 0, 1.5], [0, 0, 0], [0, 0, 1])


def test_same_state_and_seed_are_the_same_bytes(table):
    world = World(Scene.from_dict(table))

    def depth(seed=0, threads=1):
        made = Camera(160, 120, 0.9, noise={'axial': [0.01, 0, 0], 'dropout_angle': 80}, seed=seed, threads=threads)
        return made.look_at([0, -1.5, 0.3], [0, 0, 0.3]).render(world, ['depth'])['depth'].tobytes()

    first = depth()
    assert depth() == depth(threads=2) == first != depth(seed=1)
    world.step()
    assert depth() != first


def test_batches_are_their_worlds(table, front):
    batch = Batch(Scene.from_dict(table), 3)
    batch.step(5)
    images = front.render(batch)
    assert images['rgb'].shape == (3, 120, 160, 3) and images['truth']['hose']['positions'].shape == (3, 21, 3)
    first = front.render(batch.world(0))
    for name in ('depth', 'rgb', 'mask', 'points'):
        assert images[name][0].tobytes() == first[name].tobytes()
    assert np.array_equal(images['mask'][0], images['mask'][1])
    assert images['depth'][0].tobytes() != images['depth'][1].tobytes()  # noise of its own
    batch.set_world(1, World(Scene.from_dict(table)))
    changed = batch.world(1)
    changed.cut('hose', arc_length=0.5)
    batch.set_world(1, changed)
    with pytest.raises(ValueError, match='images: truth of worlds 0 and 1, which have other cables or nodes'):
        front.render(batch)
    assert front.render(batch, ['mask'])['mask'].shape == (3, 120, 160)


def test_looks_are_taken(table, front):
    world = World(Scene.from_dict(table))
    images = front.render(world, ['rgb', 'mask'], background=[0, 0, 1], light={'ambient': 1, 'shadows': False},
                          looks={'box': {'color': [0, 1, 0], 'shininess': 0}, 'floor': {'pattern': 'plain', 'color': [1, 1, 1]}})
    assert list(images) == ['rgb', 'mask']
    assert (images['rgb'][images['mask'] == 0] == [0, 0, 255]).all()
    box = images['rgb'][images['mask'] == 4]
    assert (box[:, 1] > 180).all() and (box[:, [0, 2]] == 0).all()


def test_nets_and_particles_are_seen(hang):
    hang['cables'] = []
    del hang['materials']
    hang['nets'] = [{'name': 'net', 'grid': {'rows': 5, 'columns': 5, 'spacing': 0.1}, 'mass': 0.1, 'stiffness': 50}]
    hang['particles'] = [{'name': 'ball', 'mass': 0.1, 'radius': 0.1, 'position': [0.2, 0.2, 0.5], 'velocity': [0, 0, 0]}]
    world = World(Scene.from_dict(hang))
    low, high = world.positions('net').min(axis=0), world.positions('net').max(axis=0)
    middle = (low + high) / 2
    camera = Camera(200, 200, 1.6).look_at(middle + [0.2, -0.8, 0.4], middle)
    assert set(np.unique(camera.render(world, ['mask'])['mask'])) == {0, 1, 2}
    # As camera_node numbers them: by cable_id of the topic points, then bodies.
    hang['bodies'] = [{'name': 'plug', 'mass': 0.1, 'shapes': [{'type': 'sphere', 'radius': 0.1}], 'pose': [5, 0, 0, 0, 0, 0]}]
    hang['obstacles'] = [{'name': 'floor', 'type': 'plane', 'pose': [0, 0, -5, 0, 0, 0]}]
    assert camera.labels(World(Scene.from_dict(hang))) == ['net', 'ball', 'plug', 'floor']


def test_presets_name_their_sources():
    presets = camera.presets()
    assert {'kinect_v1', 'realsense_d415', 'realsense_d435'} <= set(presets)
    for name, preset in presets.items():
        made = Camera(preset=name)
        assert (made.width, made.height) == (preset.camera['width'], preset.camera['height']) and len(preset.source) > 20
    assert Camera(preset='kinect_v1', width=320).width == 320


def test_pose_is_kept(front):
    pose = front.pose
    assert Camera().pose.tolist() == [0, 0, 0, 0, 0, 0, 1]
    other = Camera()
    other.pose = pose
    np.testing.assert_allclose(other.pose, pose)
    for copied in (other.pose, other.matrix):
        with pytest.raises(ValueError, match='read-only'):
            copied[0] = 3
    with pytest.raises(ValueError, match='pose: '):
        other.pose = [0, 0, 0, 0, 0, 0, 0]


def test_copies_see_the_same(table, front):
    world = World(Scene.from_dict(table))
    for other in (pickle.loads(pickle.dumps(front)), copy.deepcopy(front)):
        assert other.render(world, ['depth'])['depth'].tobytes() == front.render(world, ['depth'])['depth'].tobytes()


def test_threads_may_share_a_camera(table, front):
    world = World(Scene.from_dict(table))
    first = front.render(world, ['depth'])['depth'].tobytes()
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        worlds = [world.copy() for _ in range(20)]
        assert {images['depth'].tobytes() for images in pool.map(lambda one: front.render(one, ['depth']), worlds)} == {first}


@pytest.mark.parametrize('arguments, lines', [
    ({'width': 0, 'height': 0, 'horizontal_fov': np.pi, 'near': 2, 'far': 1},
     ['width: 0; allowed: an integer', 'height: 0; allowed: ', 'far: 1; allowed: any number above near, 2', 'horizontal_fov: 3.14']),
    ({'width': 10**12}, ['width: 1000000000000; allowed: an integer [pixels] (from 1 to 16384)']),
    ({'width': -5}, ['width: -5; allowed: an integer [pixels] (from 1 to 16384)']),
    ({'width': 3.5}, ['width: 3.5; allowed: an integer']),
    ({'width': 0, 'noise': {'axial': 3}}, ['width: 0; allowed: ', 'noise.axial: 3; allowed: three numbers']),
    ({'width': 1.5, 'near': -1, 'noise': {'edge_step': 0, 'axail': 1}, 'preset': 'x', 'seed': -1, 'threads': None},
     ["preset: 'x'; ", 'width: 1.5; ', 'noise.axail: no such key', 'seed: -1; ', 'threads: None; ', 'near: -1; ', 'noise.edge_step: 0; ']),
    ({'noise': {'axial': [-1, 0, 0]}}, ['noise.axial: [-1, 0, 0]; allowed: a, b, c with a + b z + c z^2 of 0 or more']),
    ({'horizontal_fov': '1'}, ["horizontal_fov: '1'; allowed: a number"]),
    ({'distortion': [1, 2]}, ['distortion: [1, 2]; allowed: five numbers k1']),
    ({'noise': {'axial': [1, 2], 'dropout_angle': 'steep'}}, ['noise.axial: [1, 2]; allowed: three', "noise.dropout_angle: 'steep'"]),
    ({'noise': {'axail': 1}}, ['noise.axail: no such key (did you mean axial?); allowed: axial, dropout_angle']),
    ({'noise': {'dropout_angle': 100}}, ['noise.dropout_angle: 100; allowed: any number above 0, at most 90 [degree]']),
    ({'noise': 3}, ['noise: 3; allowed: a dict']),
    ({'preset': 'kinect'}, ["preset: 'kinect'; allowed: kinect_v1, realsense_d415, realsense_d435"]),
    ({'preset': ['kinect_v1']}, ["preset: ['kinect_v1']; allowed: kinect_v1, realsense_d415, realsense_d435"]),
    ({'seed': -1}, ['seed: -1; allowed: an integer (from 0']),
    ({'threads': 5000}, ['threads: 5000; allowed: an integer (from 0 to 1024)']),
])
def test_wrong_arguments_are_named(arguments, lines):
    with pytest.raises(ValueError) as caught:
        Camera(**arguments)
    found = str(caught.value).split('\n')
    assert len(found) == len(lines) and all(line.startswith(start) for line, start in zip(found, lines)), found


@pytest.mark.parametrize('call, text', [
    (lambda: Camera(foo=3), 'foo: no such argument; allowed: width, height, horizontal_fov, near, far, noise, seed, distortion, preset, threads'),
    (lambda: Camera(widht=3), 'widht: no such argument (did you mean width?); allowed: width, height,'),
    (lambda: Camera(3, width=3), 'width: given twice; allowed: once'),
    (lambda: Camera(*range(11)), '11 arguments without a name; allowed: at most 10: width, height,'),
    (lambda: Camera().look_at([0, 0, 0], form=[1, 0, 0]), 'form: no such argument; allowed: eye, target, up'),
    (lambda: Camera().look_at([0, 0, 0]), 'target: missing; allowed: a value'),
])
def test_arguments_that_there_are_not_are_named(call, text):
    with pytest.raises(TypeError) as caught:
        call()
    assert str(caught.value).startswith(text)


@pytest.mark.parametrize('arguments, text', [
    ({'images': 'depth'}, "images: 'depth'; allowed: a list with some of depth, rgb, mask, points, truth"),
    ({'images': ['deep']}, "images: ['deep']; allowed: a list with some of"),
    ({'looks': {'hos': {'color': [1, 0, 0]}}}, 'looks: "hos"; allowed: the names of what is there: hose'),
    ({'looks': {'hose': {'colour': [1, 0, 0]}}}, "looks['hose']: 'colour'; allowed: the keys color, "),
    ({'looks': {'hose': {'color': [1, 0, 2]}}}, "looks['hose'].color: [1, 0, 2]; allowed: red, green, blue: three numbers from 0 to 1"),
    ({'light': {'ambient': float('nan')}}, 'light.ambient: nan; allowed: '),
    ({'light': {'direction': [0, 0, 0]}}, 'light.direction: [0, 0, 0]; allowed: '),
    ({'background': 'white'}, "background: 'white'; allowed: red, green, blue"),
    ({'least_radius': -1}, 'least_radius: -1; allowed: 0 or more [m]'),
])
def test_wrong_requests_are_named(hang, arguments, text):
    with pytest.raises(ValueError) as caught:
        Camera(8, 8).render(World(Scene.from_dict(hang)), **arguments)
    assert str(caught.value).startswith(text), caught.value


def test_only_worlds_are_seen():
    with pytest.raises(TypeError, match='world: 3; allowed: a World or a Batch'):
        Camera(8, 8).render(3)
    for eye, target, up in (([0, 0, 0], [0, 0, 0], [0, 0, 1]), ([0, 0, 0], [0, 0, 1], [0, 0, 1]), ([0, 0], [1, 0, 0], [0, 0, 1])):
        with pytest.raises(ValueError):
            Camera(8, 8).look_at(eye, target, up)


def test_without_its_compiled_part_it_says_what_is_missing():
    program = "import sys; sys.modules['verlet_cable._camera'] = None\nimport verlet_cable.sim\nimport verlet_cable.camera"
    failed = subprocess.run([sys.executable, '-c', f'import sys; sys.path[:0] = {sys.path!r}\n' + program], stderr=subprocess.PIPE, text=True)
    assert failed.returncode == 1 and 'sudo apt-get install libembree-dev' in failed.stderr.split('\n')[-2]


@pytest.mark.parametrize('numbers', [1e300, 1e200, 2e9, -1e10, float('nan'), float('inf')])
def test_a_place_is_not_further_than_frames_are(front, numbers):
    before = front.pose
    with pytest.raises(ValueError, match=r'^pose: .*; allowed: x, y, z \[m\] \(from -1e\+09 to 1e\+09\), qx, qy, qz, qw with a quaternion|^pose: .*finite'):
        front.pose = [numbers, 0, 0, 0, 0, 0, 1]
    for name in ('eye', 'target'):
        with pytest.raises(ValueError, match=rf'^{name}: .*; allowed: 3 finite numbers \[m\] \(from -1e\+09 to 1e\+09\)'):
            front.look_at(**{'eye': [0, 0, 0], 'target': [1, 0, 0], name: [0, numbers, 0]})
    assert np.array_equal(front.pose, before)


def test_a_direction_may_have_any_length(front):
    far = Camera().look_at([0, -1, 0], [0, 0, 0], [0, 0, 1e200]).pose
    np.testing.assert_allclose(far, Camera().look_at([0, -1, 0], [0, 0, 0]).pose, atol=1e-15)


@pytest.mark.parametrize('arguments, line', [
    ({'images': 5}, 'images: 5; allowed: a list with some of depth'), ({'images': None}, 'images: None; allowed: a list'),
    ({'images': [['depth']]}, "images: [['depth']]; allowed: a list"), ({'images': []}, 'images: []; allowed: a list'),
    ({'stripes': np.zeros(3)}, 'stripes: array([0., 0., 0.]); allowed: True or False'), ({'distinct_colors': 'no'}, "distinct_colors: 'no'; "),
    ({'light': {'shadows': 2}}, 'light.shadows: 2; allowed: True or False'), ({'light': {3: 1}}, 'light: 3; allowed: the keys direction'),
    ({'looks': {'hose': {'stripes': 2.5}}}, "looks['hose'].stripes: 2.5; allowed: an integer, 0 or more"), ({'looks': {3: {}}}, 'looks: "3"; allowed: '),
    ({'looks': {'hose': {'pattern': 3}}}, "looks['hose'].pattern: 3; allowed: plain"), ({'looks': {'\ud800': {}}}, 'looks: ')])
def test_what_cannot_be_rendered_is_named(table, front, arguments, line):
    with pytest.raises(ValueError) as caught:
        front.render(World(Scene.from_dict(table)), **arguments)
    assert str(caught.value).startswith(line) and '; allowed: ' in str(caught.value)
