"""verlet_cable.camera.coco writes what COCO's readers read, and what it says is what the images show."""
import json

import numpy as np
import pytest

from verlet_cable.sim import Batch, Scene, World

pytest.importorskip('verlet_cable.camera')
image = pytest.importorskip('PIL.Image')
from verlet_cable.camera import Camera, coco  # noqa: E402


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


def test_wrong_arguments_are_named(crossed, tmp_path):
    (tmp_path / 'full').mkdir()
    (tmp_path / 'full/file').touch()
    with pytest.raises(ValueError, match='path: .*allowed: a directory that is new or empty'):
        coco.Dataset(tmp_path / 'full')
    with pytest.raises(ValueError, match='keypoints: 1; allowed: an integer'):
        coco.Dataset(tmp_path / 'set', keypoints=1)
    dataset = coco.Dataset(tmp_path / 'set')
    for arguments, text in (({'target': [0, 0]}, 'target: '), ({'target': [0, 0, 0], 'distance': (2, 1)}, 'distance: (2, 1); allowed: two'),
                            ({'target': [0, 0, 0], 'elevation': (0, 90)}, 'elevation: (0, 90); allowed: two numbers')):
        with pytest.raises(ValueError) as caught:
            dataset.add(Camera(8, 8), World(crossed), **arguments)
        assert str(caught.value).startswith(text)


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
