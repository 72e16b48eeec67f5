"""verlet_cable.camera.coco writes what COCO's readers read, and what it says is what the images show."""
import errno
import json
import os
import pathlib
import signal
import subprocess
import sys

import numpy as np
import pytest

from verlet_cable import coco_command
from verlet_cable.sim import Batch, Scene, World

pytest.importorskip('verlet_cable.camera')
image = pytest.importorskip('PIL.Image')
from verlet_cable.camera import Camera, coco  # noqa: E402

PROGRAM = pathlib.Path(__file__).resolve().parents[2] / 'scripts/cable_coco'


@pytest.fixture
def crossed(hang):
    """Two cables that cross, `over` higher, above a floor, and a third far away."""
    cable = dict(hang['cables'][0], attachments=[])
    hang['cables'] = [dict(cable, name='under', initial={'type': 'straight', 'from': [-0.5, 0, 0.1], 'to': [0.5, 0, 0.1]}),
                      dict(cable, name='over', initial={'type': 'straight', 'from': [0.1, -0.5, 0.2], 'to': [0.1, 0.5, 0.2]}),
                      dict(cable, name='away', initial={'type': 'straight', 'from': [50, 0, 0], 'to': [51, 0, 0]})]
    hang['obstacles'] = [{'name': 'floor', 'type': 'plane'}]
    return Scene.from_dict(hang)


def decoded(segmentation):
    """As pycocotools does."""
    height, width = segmentation['size']
    runs = segmentation['counts']
    values = np.repeat(np.arange(len(runs)) % 2, runs)
    assert len(values) == height * width
    return values.reshape(width, height).T.astype(bool)


def check_format(path):
    """What the format asks for (https://cocodataset.org/#format-data)."""
    content = json.loads((path / 'annotations.json').read_text())
    assert {'info', 'images', 'annotations', 'categories', 'licenses'} <= set(content)
    images = {entry['id']: entry for entry in content['images']}
    categories = {entry['id']: entry for entry in content['categories']}
    assert len(images) == len(content['images']) and len({entry['id'] for entry in content['annotations']}) == len(content['annotations'])
    for entry in images.values():
        for key in ('file_name', 'mask_file', 'depth_file'):
            with image.open(path / entry[key]) as file:
                assert file.size == (entry['width'], entry['height'])
    for entry in content['annotations']:
        category, shown = categories[entry['category_id']], images[entry['image_id']]
        assert len(entry['keypoints']) == 3 * len(category['keypoints']) and entry['iscrowd'] in (0, 1)
        keypoints = np.reshape(entry['keypoints'], (-1, 3))
        assert set(keypoints[:, 2]) <= {0, 1, 2} and entry['num_keypoints'] == (keypoints[:, 2] > 0).sum()
        assert (keypoints[keypoints[:, 2] == 0] == 0).all()
        pixels = decoded(entry['segmentation'])
        assert pixels.shape == (shown['height'], shown['width']) and pixels.sum() == entry['area']
        x, y, width, height = entry['bbox']
        assert entry['area'] > 0 and pixels[y:y + height, x:x + width].sum() == entry['area']
        assert pixels[y].any() and pixels[y + height - 1].any() and pixels[:, x].any() and pixels[:, x + width - 1].any()
        assert all(1 <= a < b <= len(category['keypoints']) for a, b in category['skeleton'])
    return content


def test_what_is_written_is_what_is_seen(crossed, tmp_path):
    world = World(crossed)
    camera = Camera(160, 120, 0.9).look_at([0, -0.2, 2], [0, 0, 0])
    with coco.Dataset(tmp_path / 'set', keypoints=5) as dataset:
        dataset.add(camera, world, vary_looks=False)
    content = check_format(tmp_path / 'set')
    seen = camera.render(world)
    with image.open(tmp_path / 'set/images/00000001.png') as file:
        assert np.array_equal(np.asarray(file), seen['rgb'])
    with image.open(tmp_path / 'set/masks/00000001.png') as file:
        assert np.array_equal(np.asarray(file), seen['mask'])
    with image.open(tmp_path / 'set/depth/00000001.png') as file:
        np.testing.assert_allclose(np.asarray(file) / 1000, np.nan_to_num(seen['depth']), atol=0.00051)
    # Of what is not in the image there is no annotation.
    under, over = content['annotations']
    assert content['images'][0]['labels'] == ['under', 'over', 'away', 'floor']
    assert np.array_equal(decoded(under['segmentation']), seen['mask'] == 1)
    assert [under['cable'], over['cable']] == ['under', 'over'] and [under['mask'], over['mask']] == [1, 2]
    keypoints = np.reshape(over['keypoints'], (5, 3))
    np.testing.assert_allclose(keypoints[:, 0], seen['truth']['over']['u'][::5], atol=1e-3)
    np.testing.assert_allclose(over['positions'], seen['truth']['over']['positions'][::5], atol=1e-6)


@pytest.mark.parametrize('segments', [3, 10, 30])
def test_keypoints_are_evenly_along_cables(hang, tmp_path, segments):
    """Also where there are fewer segments than keypoints, and with a lens; the cable goes out of the image, and half of it is under a lid."""
    cable = dict(hang['cables'][0], attachments=[], segments=segments, initial={'type': 'straight', 'from': [-0.5, 0, 0], 'to': [0.5, 0, 0]})
    hang['cables'] = [cable]
    hang['obstacles'] = [{'name': 'lid', 'type': 'box', 'size': [1, 0.2, 0.01], 'pose': [0.501, 0, 0.1, 0, 0, 0]}]
    lens = [-0.25, 0.06, 0.002, -0.001, 0.01]
    camera = Camera(200, 150, 0.9, distortion=lens).look_at([0, -0.1, 0.85], [0, 0, 0])
    with coco.Dataset(tmp_path / 'set', keypoints=21) as dataset:
        dataset.add(camera, World(Scene.from_dict(hang)))
    (annotation,) = check_format(tmp_path / 'set')['annotations']
    # A cable that has a node at each keypoint says where they are seen.
    cable['segments'] = 20
    truth = camera.render(World(Scene.from_dict(hang)), ['truth'])['truth']['hose']
    np.testing.assert_allclose(annotation['positions'], truth['positions'], atol=1e-6)
    u, v, flags = np.reshape(annotation['keypoints'], (21, 3)).T
    is_in = flags > 0
    assert np.array_equal(is_in, (truth['u'] >= -0.5) & (truth['u'] < 199.5)) and not is_in.all()
    np.testing.assert_allclose(u[is_in], truth['u'][is_in], atol=0.00051)
    np.testing.assert_allclose(v[is_in], truth['v'][is_in], atol=0.00051)
    # Half a segment from the edge of the lid on, they are seen where they are.
    x = np.linspace(-0.5, 0.5, 21)
    sure = is_in & (np.abs(x) > 0.51 / segments)
    assert np.array_equal(flags[sure] == 2, truth['visible'][sure]) and {1, 2} <= set(flags[sure])


def test_keypoints_of_a_segment_that_goes_through_the_image_are_seen(hang, tmp_path):
    """None of its nodes is in the image."""
    hang['cables'] = [dict(hang['cables'][0], attachments=[], segments=3, initial={'type': 'straight', 'from': [-0.5, 0, 0], 'to': [0.5, 0, 0]})]
    with coco.Dataset(tmp_path / 'set', keypoints=21) as dataset:
        dataset.add(Camera(100, 80, 0.25).look_at([0, -0.1, 1.0], [0, 0, 0]), World(Scene.from_dict(hang)))
    (annotation,) = check_format(tmp_path / 'set')['annotations']
    assert [k for k, flag in enumerate(annotation['keypoints'][2::3]) if flag == 2] == [8, 9, 10, 11, 12]
    assert annotation['num_keypoints'] == 5


def test_crossings_say_who_is_over(crossed, tmp_path):
    camera = Camera(160, 120, 0.9).look_at([0, -0.2, 2], [0, 0, 0])
    truth = camera.render(World(crossed), ['truth'])['truth']
    (found,) = coco.crossings(truth)
    assert (found['over'][0], found['under'][0]) == ('over', 'under')
    # Seen from the eye, the crossing is where the line to the upper cable goes on to the lower one.
    eye = np.array([0, -0.2, 2])
    upper = np.array([0.1, -0.5 + found['over'][1] / 20, 0.2])
    lower = eye + (upper - eye) * (eye[2] - 0.1) / (eye[2] - 0.2)
    np.testing.assert_allclose(lower, [-0.5 + found['under'][1] / 20, 0, 0.1], atol=1e-9)
    # From below it is the other way round.
    (found,) = coco.crossings(camera.look_at([0, -0.2, -1.5], [0, 0, 0]).render(World(crossed), ['truth'])['truth'])
    assert found['over'][0] == 'under'


def test_crossings_of_an_image_are_within_it_and_of_cables_that_it_shows(crossed, tmp_path):
    """Cameras that look down on y = 0: the crossing at x = 0.1 is in the middle, beyond an edge, and beyond that of an image of `under` only."""
    with coco.Dataset(tmp_path / 'set') as dataset:
        for x in (0.1, 0.35, -0.35):
            dataset.add(Camera(100, 100, 0.5).look_at([x, 0, 1], [x, 0, 0]), World(crossed))
    content = check_format(tmp_path / 'set')
    shown = [[a['cable'] for a in content['annotations'] if a['image_id'] == k] for k in (1, 2, 3)]
    assert shown == [['under', 'over'], ['under'], ['under']]
    assert [len(entry['crossings']) for entry in content['images']] == [1, 0, 0]
    # Of an image that is turned by 45 degrees they go through a corner, and cross below its edge.
    camera = Camera(100, 100, 0.5).look_at([0.28, 0.18, 1], [0.28, 0.18, 0], up=[1, 1, 0])
    with coco.Dataset(tmp_path / 'turned') as dataset:
        dataset.add(camera, World(crossed))
    content = check_format(tmp_path / 'turned')
    assert [a['cable'] for a in content['annotations']] == ['under', 'over'] and content['images'][0]['crossings'] == []
    (found,) = coco.crossings(camera.render(World(crossed), ['truth'])['truth'])
    assert found['pixel'][1] > 99.5


def test_what_is_too_far_for_a_png_has_no_depth(crossed, tmp_path):
    camera = Camera(64, 48, 0.9, far=200)
    for name, distance in (('near', 60), ('far', 70)):
        with coco.Dataset(tmp_path / name) as dataset:
            dataset.add(camera.look_at([0, 0, distance], [0, 0, 0]), World(crossed))
    assert depths(tmp_path / 'near').min() > 59000 and depths(tmp_path / 'far').max() == 0
    assert (camera.render(World(crossed), ['depth'])['depth'] > 65.535).all()


def test_a_seed_gives_the_same_data(crossed, tmp_path):
    for name, seed in (('a', 1), ('b', 1), ('c', 2)):
        with coco.Dataset(tmp_path / name, seed=seed) as dataset:
            camera = Camera(64, 48)
            dataset.add(camera, World(crossed), target=[0, 0, 0.1])
            dataset.add(camera, Batch(crossed, 2), target=[0, 0, 0.1])
            assert len(dataset) == 3
        check_format(tmp_path / name)
    files = [sorted(path.relative_to(tmp_path / 'a') for path in (tmp_path / 'a').rglob('*.*'))]
    assert len(files[0]) == 10
    for file in files[0]:
        assert (tmp_path / 'a' / file).read_bytes() == (tmp_path / 'b' / file).read_bytes()
    pictures = {(tmp_path / name / 'images' / f'{index:08d}.png').read_bytes() for name in 'ac' for index in (1, 2)}
    assert len(pictures) == 4


def depths(path):
    """(images, height, width) [mm]"""
    images = json.loads((path / 'annotations.json').read_text())['images']
    return np.array([np.asarray(image.open(path / entry['depth_file'])) for entry in images], dtype=float)


def test_each_image_has_noise_of_its_own(crossed, tmp_path):
    world = World(crossed)

    def noise(name, seed, camera_seed, threads, *seen):
        camera = Camera(64, 48, 0.9, noise={'axial': [0.02, 0, 0]}, seed=camera_seed, threads=threads).look_at([0, -0.2, 2], [0, 0, 0])
        with coco.Dataset(tmp_path / name, seed=seed) as dataset:
            for one in seen:
                dataset.add(camera, one, vary_looks=False)
        return depths(tmp_path / name) - 1000 * Camera(64, 48, 0.9).look_at([0, -0.2, 2], [0, 0, 0]).render(world, ['depth'])['depth']

    first = noise('a', 1, 2, 1, world, world, World(crossed), Batch(crossed, 3))
    # All at one time. Of 3072 independent pixels, correlations are below 0.1, more than five times their deviation.
    others = [noise('b', 3, 2, 1, world), noise('c', 1, 4, 1, world)]
    correlations = np.corrcoef(np.concatenate([first, *others]).reshape(8, -1))
    assert (np.abs(correlations[~np.eye(8, dtype=bool)]) < 0.1).all()
    np.testing.assert_allclose(first.std(axis=(1, 2)), 20, rtol=0.1)
    # A function of seeds and number: not of how images are added, nor of the threads.
    assert np.array_equal(noise('d', 1, 2, 2, Batch(crossed, 2), world, Batch(crossed, 3)), first)
    assert noise('e', 1, 2, 1, world).tobytes() == first[:1].tobytes()


def test_wrong_arguments_are_named(crossed, tmp_path):
    (tmp_path / 'full').mkdir()
    (tmp_path / 'full/file').touch()
    with pytest.raises(ValueError, match='path: .*allowed: a directory that is new or empty'):
        coco.Dataset(tmp_path / 'full')
    with pytest.raises(ValueError) as caught:
        coco.Dataset(tmp_path / 'set', keypoints=1, seed=2**64)
    assert str(caught.value) == ('keypoints: 1; allowed: an integer (from 2 to 10000)\n'
                                 'seed: 18446744073709551616; allowed: an integer (from 0 to 18446744073709551615)')
    for call, text in ((lambda: coco.Dataset(tmp_path / 'set', foo=1), 'foo: no such argument; allowed: path, keypoints, seed'),
                       (lambda: coco.Dataset(), 'path: missing; allowed: a value')):
        with pytest.raises(TypeError) as caught:
            call()
        assert str(caught.value) == text
    assert not (tmp_path / 'set').exists()
    for path in (5, None, ['set']):
        with pytest.raises(TypeError, match=r'path: .*; allowed: the path of a directory that is new or empty, as text, bytes or os.PathLike'):
            coco.Dataset(path)
    for path in ('', 'a\0b', '\ud800', str(tmp_path / 'full/file')):
        with pytest.raises(ValueError, match='path: .*; allowed: a directory that is new or empty'):
            coco.Dataset(path)
    dataset = coco.Dataset(str(tmp_path / 'set').encode())
    for arguments, error, text in (({'camera': 5}, TypeError, 'camera: 5; allowed: a Camera'), ({'world': None}, TypeError, 'world: None; allowed: a World or'),
                                   ({'looks': 5}, TypeError, 'looks: 5; allowed: None, or a dict'), ({'vary_looks': 'no'}, TypeError, "vary_looks: 'no'; ")):
        with pytest.raises(error) as caught:
            dataset.add(**{'camera': Camera(8, 8), 'world': World(crossed), **arguments})
        assert str(caught.value).startswith(text)
    for truth, error in ((5, TypeError), ({'a': 1}, ValueError), ({'a': {'u': [1], 'v': [1, 2], 'positions': [[1, 2, 3]]}}, ValueError),
                         ({'a': {'u': [1], 'v': [1], 'positions': [[1, 2, 3]]}}, ValueError), ({'a': {'u': None, 'v': 3, 'positions': 'x'}}, ValueError)):
        with pytest.raises(error, match='^truth.*; allowed: a truth as of Camera.render'):
            coco.crossings(truth)
    assert coco.crossings({}) == []
    for arguments, text in (({'target': [0, 0]}, 'target: '), ({'target': [1e200, 0, 0]}, 'target: [1e+200, 0, 0]; allowed: 3 finite numbers [m] (from -1e+09'), ({'target': [0, 0, 0], 'distance': (2, 1)}, 'distance: (2, 1); allowed: two'),
                            ({'target': [0, 0, 0], 'elevation': (0, 90)}, 'elevation: (0, 90); allowed: two numbers')):
        with pytest.raises(ValueError) as caught:
            dataset.add(Camera(8, 8), World(crossed), **arguments)
        assert str(caught.value).startswith(text)
    # Also where the camera stays, and all at once.
    distances, elevations = 'two numbers [m], the larger one last (from 0.001 to 1e+06)', 'two numbers [degree], the larger one last (from -89 to 89)'
    for target in ({}, {'target': [0, 0, 0]}):
        for distance, elevation in ((0, (0, 100)), ((2, 1), 'up'), ((0, 1), (30, 20))):
            with pytest.raises(ValueError) as caught:
                dataset.add(Camera(8, 8), World(crossed), distance=distance, elevation=elevation, **target)
            assert str(caught.value) == f'distance: {distance!r}; allowed: {distances}\nelevation: {elevation!r}; allowed: {elevations}'
    assert len(dataset) == 0


def test_nothing_is_added_to_what_is_closed(crossed, tmp_path):
    camera, world = Camera(8, 8), World(crossed)
    with coco.Dataset(tmp_path / 'set') as dataset:
        dataset.add(camera, world)
    before = (tmp_path / 'set/annotations.json').read_bytes()
    with pytest.raises(ValueError, match=r'add: .*set is closed.*; allowed: add\(\) before close\(\).* or a new Dataset'):
        dataset.add(camera, world)
    assert len(list((tmp_path / 'set/images').iterdir())) == len(dataset) == 1
    dataset.close()
    assert (tmp_path / 'set/annotations.json').read_bytes() == before


def test_images_from_elsewhere_are_written_alike(crossed, tmp_path):
    world, camera = World(crossed), Camera(64, 48, 0.9).look_at([0, -0.2, 2], [0, 0, 0])
    seen, labels = camera.render(world), camera.labels(world)
    with coco.Dataset(tmp_path / 'a') as first, coco.Dataset(tmp_path / 'b') as second:
        first.add(camera, world, vary_looks=False)
        second.add_images(seen, labels, world.time, camera.matrix, camera.distortion, camera.pose)
    for folder in ('images', 'masks', 'depth'):
        assert (tmp_path / 'a' / folder / '00000001.png').read_bytes() == (tmp_path / 'b' / folder / '00000001.png').read_bytes()
    assert check_format(tmp_path / 'a') == check_format(tmp_path / 'b')
    dataset = coco.Dataset(tmp_path / 'c')
    right = {'images': seen, 'labels': labels, 'time': 0.0, 'matrix': camera.matrix}
    for wrong, text in (({'images': 3}, 'images: 3; allowed: a dict with depth'), ({'images': {**seen, 'mask': seen['depth']}}, 'images: depth (48, 64) float32'),
                        ({'images': {**seen, 'truth': {'under': {}}}}, "truth['under']: {}; allowed: "), ({'labels': ['over']}, "labels: ['over']; allowed: "),
                        ({'time': 'now'}, "time: 'now'; allowed: a finite number"), ({'matrix': [1, 2]}, 'matrix: [1, 2]; allowed: finite numbers of the shape (3, 3)'),
                        ({'distortion': [1e400] * 5}, 'distortion: [inf'), ({'pose': [0, 0, 0]}, 'pose: [0, 0, 0]; allowed: ')):
        with pytest.raises(ValueError) as caught:
            dataset.add_images(**{**right, **wrong})
        assert str(caught.value).startswith(text)
    assert len(dataset) == 0


def run(*arguments):
    """(exit status, what it prints, errors)"""
    done = subprocess.run([sys.executable, str(PROGRAM), *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def files(crossed, tmp_path):
    """A scene whose cable a hand moves, its motion, a camera and a sweep."""
    (tmp_path / 'scene.yaml').write_text("""
time_step: 0.005
materials: {m: {linear_density: 0.1, radius: 0.01}}
cables: [{name: rope, length: 1.0, segments: 20, material: m, attachments: [{name: hand, at: start, frame: hand}]},
         {name: other, length: 0.5, segments: 10, material: m, attachments: [{name: peg, at: start, offset: [0.1, 0, 0]}]}]
""")
    (tmp_path / 'motion.csv').write_text('t,frame,x,y,z,qx,qy,qz,qw\n0,hand,0,0,0,0,0,0,1\n1,hand,0.5,0,0,0,0,0,1\n')
    (tmp_path / 'camera.yaml').write_text('preset: kinect_v1\nwidth: 96\nheight: 72\nnear: 1e-1\nrate: 15\nnoise: {dropout_angle: 80}\n')
    (tmp_path / 'sweep.yaml').write_text("""
scene: scene.yaml
motion: motion.csv
duration: 0.5
record: {rate: 4, fields: [positions]}
samples: 5
vary:
  cables[0].length: {choice: [0.8, 1.0, -1.0]}
""")
    return tmp_path


def test_a_scene_that_runs_becomes_a_data_set(files):
    options = ['--motion', files / 'motion.csv', '--duration', 1, '--rate', 2, '--views', 2, '--camera', files / 'camera.yaml', '--keypoints', 5]
    status, output, errors = run(files / 'scene.yaml', '--output', files / 'set', *options)
    assert (status, output, errors) == (0, f'6 images in {files}/set\n', '')
    content = check_format(files / 'set')
    assert [entry['time'] for entry in content['images']] == [0, 0, 0.5, 0.5, 1, 1]
    assert {(entry['width'], entry['height']) for entry in content['images']} == {(96, 72)}
    assert len({tuple(entry['pose']) for entry in content['images']}) == 6
    assert {entry['cable'] for entry in content['annotations']} == {'rope', 'other'}
    # All of it is as cable_sim has it.
    world = World(Scene.load(files / 'scene.yaml'), files / 'motion.csv')
    world.step(200)
    last = content['images'][-1]
    pose = np.array(last['pose'])
    shown = Camera(**dict(preset='kinect_v1', width=96, height=72))
    shown.pose = pose
    nodes = shown.render(world, ['truth'])['truth']['rope']['positions'][::5]
    annotation, = (a for a in content['annotations'] if a['image_id'] == last['id'] and a['cable'] == 'rope')
    np.testing.assert_allclose(annotation['positions'], nodes, atol=1e-6)
    # The same program writes the same files; another seed others.
    assert run(files / 'scene.yaml', '--output', files / 'again', *options)[0] == 0
    assert run(files / 'scene.yaml', '--output', files / 'other', '--seed', 3, *options)[0] == 0
    names = sorted(path.relative_to(files / 'set') for path in (files / 'set').rglob('*.*'))
    assert len(names) == 19
    assert all((files / 'set' / name).read_bytes() == (files / 'again' / name).read_bytes() for name in names)
    assert all((files / 'set' / name).read_bytes() != (files / 'other' / name).read_bytes() for name in names)


def test_a_sweep_becomes_a_data_set(files):
    status, output, errors = run('--sweep', files / 'sweep.yaml', '--output', files / 'set', '--camera', files / 'camera.yaml', '--scene-looks')
    images, failed = 3 * (5 - errors.count('sample ')), errors.count('sample ')
    assert (status, output) == (0, f'{images} images in {files}/set; {failed} samples failed\n')
    assert 0 < failed < 5 and 'cables[0].length: -1; allowed: ' in errors
    content = check_format(files / 'set')
    assert [entry['time'] for entry in content['images']] == [0, 0.25, 0.5] * (5 - failed)


def test_what_the_program_cannot_use_is_named(files):
    (files / 'bad.yaml').write_text('width: 0\nheigth: 3\ndepth_encoding: 8UC1\nnoise: {axial: 3}\n')
    (files / 'encoding.yaml').write_text('depth_encoding: 16UC1\nseed: 18446744073709551616\n')
    (files / 'full').mkdir()
    (files / 'full/file').touch()
    scene = files / 'scene.yaml'
    for arguments, lines in (
            ([scene, '--output', files / 'a'], ['frames: nothing has placed hand']),
            ([scene, '--output', files / 'a', '--camera', files / 'bad.yaml', '--views', 0, '--rate', -1, '--duration', -2],
             ['bad.yaml: heigth: unknown key', 'bad.yaml: width: 0; allowed: ', "bad.yaml: depth_encoding: '8UC1'; allowed: 32FC1 | 16UC1",
              'bad.yaml: noise.axial: 3; allowed: ', '--views: 0; allowed: ', '--rate: -1; allowed: ', '--duration: -2; allowed: ', 'frames: nothing has']),
            ([scene, '--output', files / 'a', '--motion', files / 'motion.csv', '--rate', 1000], ['--rate: 1000; allowed: at most 1 / time_step']),
            ([scene, '--output', files / 'a', '--motion', files / 'none.csv'], ['none.csv']),
            ([scene, '--output', files / 'full', '--motion', files / 'motion.csv', '--views', 0],
             [f'--output: {files}/full; allowed: a directory that is new or empty', '--views: 0; ']),
            ([scene, '--output', files / 'full/file/set', '--motion', files / 'motion.csv'],
             [f'--output: {files}/full/file/set: Not a directory; allowed: a directory that is new or empty, where files can be written']),
            ([scene, '--output', files / 'a', '--motion', files / 'motion.csv', '--seed', 2**64, '--camera', files / 'encoding.yaml'],
             ['--seed: 18446744073709551616; allowed: an integer from 0 to 18446744073709551615',
              'encoding.yaml: seed: 18446744073709551616; allowed: an integer (from 0 to 18446744073709551615)']),
            (['--sweep', files / 'sweep.yaml', '--output', files / 'a', '--rate', 3], ['--rate: given with --sweep; allowed: rate in']),
            ([files / 'none.yaml', '--output', files / 'a'], ['scene: cannot read']),
            (['--output', files / 'a'], ['SCENE.yaml']),
            ([scene, '--output', files / 'a', '--distance', 'nan', 1], ["'nan'; allowed: a finite number"]),
            ([scene, '--output', files / 'a', '--motion', files / 'motion.csv', '--distance', 2, 1], ['--distance: 2 1; allowed: two numbers'])):
        status, output, errors = run(*arguments)
        assert (status, output) == (2, '')
        for line in lines:
            assert line in errors
        assert 'Traceback' not in errors
        assert not (files / 'a').exists()


@pytest.mark.parametrize('method', ['add', 'close'])
def test_what_cannot_be_written_is_named(files, monkeypatch, capsys, method):
    def fail(*_, **__):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), str(files / 'set/annotations.json'))

    monkeypatch.setattr(coco.Dataset, method, fail)
    monkeypatch.setattr(signal, 'signal', lambda *_: None)
    status = coco_command.main([str(files / 'scene.yaml'), '--motion', str(files / 'motion.csv'), '--output', str(files / 'set'), '--duration', '0'])
    count = 0 if method == 'add' else 1
    assert (status, capsys.readouterr().err) == (3, f'cable_coco: --output: {files}/set: No space left on device; {count} images are in {files}/set\n')
