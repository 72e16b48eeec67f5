"""Data sets to learn from, in the format of COCO (https://cocodataset.org): images, masks, depth, keypoints and crossings of cables.

    from verlet_cable.camera import Camera, coco
    from verlet_cable.sim import Scene, World

    world = World(Scene.load('config/hanging_cable.yaml'))  # a file of the package
    camera = Camera(preset='realsense_d435')
    with coco.Dataset('cables', seed=1) as dataset:
        for _ in range(10):
            status = world.step(10)
            dataset.add(camera, world, target=[0.5, 0, 0.8])

Needs Pillow (Debian: python3-pil).
"""
from __future__ import annotations

import json
import os
import pathlib
from types import TracebackType
from typing import Any, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, Type, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from verlet_cable import _camera
from verlet_cable.camera.camera import LARGEST_SEED, Camera, _Checks, _Numbers, _point, _vector, _wrong
from verlet_cable.sim import Batch, World
from verlet_cable.wrong_arguments import explain_names

__all__ = ['Dataset', 'crossings']

NEW_DIRECTORY = 'a directory that is new or empty'
MOST_KEYPOINTS = 10000
DISTANCES = (1e-3, 1e6)       # [m]
ELEVATIONS = (-89.0, 89.0)    # [degree]
_CATEGORY = 1
_MILLIMETRES = 1000.0
_NOT_THERE, _HIDDEN, _SEEN = 0, 1, 2
_AMBIENTS = (0.3, 0.7)
_LIGHT_ELEVATIONS = (30.0, 90.0)    # [degree]
_SQUARES = (0.02, 0.5)              # [m]


@explain_names
class Dataset:
    """Writes a data set into the new or empty directory `path`: images/*.png (rgb), masks/*.png (16 bit: numbers of things), depth/*.png
    (16 bit, millimetres, 0: none, or more than 65.535 m), and, when it is closed, annotations.json.

    keypoints: so many points of each cable, from its start to its end at equal distances along it, as it is then. seed: of what add() varies, and
    of noise: in image k both are functions of it and k, and noise also of the camera's seed, but not of the world's time.

    annotations.json has what COCO's format has: images, annotations (segmentation as run lengths, bbox, area, keypoints; of each cable
    that has pixels in the image, and of no other) and the category cable; and beside that, of images: time [s], matrix, distortion and pose
    of the camera, the light, labels and crossings (those in the image, of cables that have annotations); of annotations: cable (its name), positions [m] of its keypoints in the optical frame, and
    mask (its number in masks).
    """

    def __init__(self, path: Union[str, bytes, os.PathLike[str]], keypoints: int = 21, seed: int = 0) -> None:
        try:
            import PIL.Image  # noqa: F401
        except ImportError as error:
            raise ImportError(f'verlet_cable.camera.coco: {error}; it needs Pillow (Debian: sudo apt-get install python3-pil; pip install '
                              'pillow)') from error
        checks = _Checks()
        self._keypoints = checks.integer('keypoints', keypoints, 2, MOST_KEYPOINTS)
        self._seed = checks.integer('seed', seed, 0, LARGEST_SEED)
        checks.add([])
        self._path = _new_directory(path)
        for name in ('images', 'masks', 'depth'):
            (self._path / name).mkdir(parents=True, exist_ok=True)
        self._is_closed = False
        self._images: List[Dict[str, Any]] = []
        self._annotations: List[Dict[str, Any]] = []

    def __enter__(self) -> Dataset:
        return self

    def __exit__(self, kind: Optional[Type[BaseException]], error: Optional[BaseException], trace: Optional[TracebackType]) -> None:
        self.close()

    def __len__(self) -> int:
        return len(self._images)

    def add(
        self, camera: Camera, world: Union[World, Batch], target: Optional[ArrayLike] = None, distance: Tuple[float, float] = (0.6, 1.5),
        elevation: Tuple[float, float] = (15.0, 75.0), vary_looks: bool = True, light: Optional[Mapping[str, Any]] = None,
        background: Optional[Sequence[float]] = None, looks: Optional[Mapping[str, Mapping[str, Any]]] = None,
    ) -> None:
        """Adds what a camera sees of a world; of a Batch, an image of each of its worlds.

        target: (3,) [m] what the camera is turned to, from a place that is drawn at random, for each call: at a distance [m] and an
        elevation [degree] between two numbers, from any side. None: the camera stays where it is. vary_looks: light, background and
        all colors and patterns are drawn at random, too, but for those that light, background and looks say as of Camera.render.
        Raises ValueError, also once the data set is closed.
        """
        if not isinstance(camera, Camera):
            raise TypeError(_wrong('camera', camera, 'a Camera'))
        if not isinstance(vary_looks, (bool, np.bool_)):
            raise TypeError(_wrong('vary_looks', vary_looks, 'True or False'))
        if looks is not None and not isinstance(looks, Mapping):
            raise TypeError(_wrong('looks', looks, 'None, or a dict of looks by the names of things'))
        self._require_open()
        checks = _Checks()
        place = None if target is None else checks.value(lambda: _point('target', target))
        distances = checks.value(lambda: _range('distance', distance, DISTANCES, ' [m]'))
        elevations = checks.value(lambda: _range('elevation', elevation, ELEVATIONS, ' [degree]'))
        checks.add([])
        random = np.random.default_rng([self._seed, len(self._images)])
        if place is not None:
            camera.look_at(*_random_view(random, place, distances, elevations))
        labels = camera.labels(world)
        appearance: Dict[str, Any] = _random_appearance(random, labels) if vary_looks else {}
        appearance['looks'] = {**appearance.get('looks', {}), **(looks or {})}
        appearance.update({name: value for name, value in (('light', light), ('background', background)) if value is not None})
        seen = camera._render(world, ['depth', 'rgb', 'mask', 'truth'], appearance, _Numbers(self._seed, len(self)))
        of_all: Dict[str, Any] = {'matrix': camera.matrix, 'distortion': camera.distortion, 'pose': camera.pose,
                                  'light': appearance.get('light')}
        if isinstance(world, World):
            self._add(seen, labels, world.time, **of_all)
            return
        for index in range(len(world)):
            truth = {name: {field: array[index] for field, array in cable.items()} for name, cable in seen['truth'].items()}
            images = {name: seen[name][index] for name in ('depth', 'rgb', 'mask')}
            self._add({**images, 'truth': truth}, labels, float(world.time[index]), **of_all)

    def add_images(
        self, images: Mapping[str, Any], labels: Sequence[str], time: float, matrix: ArrayLike, distortion: Sequence[float] = (0.0,) * 5,
        pose: Optional[ArrayLike] = None,
    ) -> None:
        """Adds images that were rendered before, such as those of camera_node.

        images: a dict as Camera.render returns it for one world, with depth, rgb, mask and truth. labels: the names for the numbers in
        mask, from 1 on; those of cables come first, in the order of truth. time: [s]. matrix: (3, 3) [pixels]. distortion: as
        Camera's. pose: (7,) of the optical frame, None: not known. Raises ValueError, also once the data set is closed.
        """
        self._require_open()
        checked = _checked_images(images)
        names = list(labels) if isinstance(labels, (list, tuple)) else []
        if not all(isinstance(name, str) for name in names) or names[:len(checked['truth'])] != list(checked['truth']):
            raise ValueError(_wrong('labels', labels, 'a list of names, first those of the cables in truth: ' + ', '.join(checked['truth'])))
        self._add(checked, names, float(_numbers('time', time, ())), matrix=_numbers('matrix', matrix, (3, 3)),
                  distortion=_numbers('distortion', distortion, (5,)), light=None,
                  pose=None if pose is None else _numbers('pose', pose, (7,)))

    def _require_open(self) -> None:
        if self._is_closed:
            raise ValueError(f'add: {self._path} is closed, and its annotations.json is written; allowed: add() before close(), within '
                             '`with`, or a new Dataset in another directory')

    def close(self) -> None:
        """Writes annotations.json; nothing more can be added."""
        self._is_closed = True
        names = [f'{index}' for index in range(self._keypoints)]
        category = {'id': _CATEGORY, 'name': 'cable', 'supercategory': 'cable', 'keypoints': names,
                    'skeleton': [[index, index + 1] for index in range(1, self._keypoints)]}
        content = {'info': {'description': 'Cables, simulated by verlet_cable', 'version': '1.0'}, 'licenses': [],
                   'images': self._images, 'annotations': self._annotations, 'categories': [category]}
        with open(self._path / 'annotations.json', 'w', encoding='utf-8') as file:
            json.dump(content, file)

    def _add(
        self, seen: Dict[str, Any], labels: List[str], time: float, matrix: ArrayLike, distortion: ArrayLike,
        pose: Optional[NDArray[np.float64]], light: Optional[Mapping[str, Any]],
    ) -> None:
        from PIL import Image
        truth, (height, width) = seen['truth'], seen['mask'].shape
        identity = len(self._images) + 1
        name = f'{identity:08d}.png'
        for folder, pixels in (('images', seen['rgb']), ('masks', seen['mask']), ('depth', _in_millimetres(seen['depth']))):
            Image.fromarray(np.ascontiguousarray(pixels)).save(self._path / folder / name, compress_level=1)
        annotated = {}
        for number, (cable, nodes) in enumerate(truth.items(), 1):
            pixels = seen['mask'] == number
            if pixels.any():
                annotated[cable] = nodes
                self._annotations.append(self._annotation(identity, number, cable, nodes, pixels, matrix, distortion))
        self._images.append({
            'id': identity, 'width': width, 'height': height, 'file_name': f'images/{name}', 'mask_file': f'masks/{name}',
            'depth_file': f'depth/{name}', 'time': time, 'matrix': np.asarray(matrix).tolist(),
            'distortion': np.asarray(distortion).tolist(), 'pose': None if pose is None else pose.tolist(), 'light': _plain(light or {}),
            'labels': labels, 'crossings': [one for one in crossings(annotated) if _are_in_image(*one['pixel'], width, height)]})

    def _annotation(
        self, image: int, number: int, cable: str, nodes: Dict[str, Any], pixels: NDArray[np.bool_], matrix: ArrayLike, distortion: ArrayLike,
    ) -> Dict[str, Any]:
        points = _points_along(nodes['positions'], self._keypoints)
        u, v = _projected(points.positions, matrix, distortion)
        flags = _flags(u, v, points, nodes, pixels)
        places = np.where((flags > _NOT_THERE)[:, None], np.column_stack([u, v]), 0)
        keypoints = [number for (x, y), flag in zip(places.tolist(), flags.tolist()) for number in (round(x, 3), round(y, 3), flag)]
        return {'id': len(self._annotations) + 1, 'image_id': image, 'category_id': _CATEGORY, 'iscrowd': 0,
                'segmentation': {'size': list(pixels.shape), 'counts': _run_lengths(pixels)}, 'area': int(pixels.sum()),
                'bbox': _box(pixels), 'keypoints': keypoints, 'num_keypoints': int((flags > 0).sum()), 'cable': cable, 'mask': number,
                'positions': np.round(points.positions, 6).tolist()}


class _Points(NamedTuple):
    """Of a cable. segment, fraction: on which one they are, and how far on the way to its end."""

    segment: NDArray[np.int64]
    fraction: NDArray[np.float64]
    positions: NDArray[np.float64]


def _points_along(nodes: NDArray[np.float64], count: int) -> _Points:
    """At equal distances along the line through nodes, (n + 1, 3), from its start to its end."""
    lengths = np.linalg.norm(np.diff(nodes, axis=0), axis=1)
    starts = np.concatenate([[0.0], np.cumsum(lengths)])
    places = np.linspace(0, starts[-1], count)
    segment = np.clip(np.searchsorted(starts, places, 'right') - 1, 0, len(lengths) - 1)
    passed = places - starts[segment]
    fraction = np.clip(np.divide(passed, lengths[segment], out=np.zeros(count), where=lengths[segment] > 0), 0, 1)
    part = fraction[:, None]
    return _Points(segment, fraction, (1 - part) * nodes[segment] + part * nodes[segment + 1])


def _projected(points: NDArray[np.float64], matrix: ArrayLike, distortion: ArrayLike) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
    """u, v [pixels] of points in the optical frame; NaN for what is not in front of the camera."""
    (fx, _, cx), (_, fy, cy), _ = np.asarray(matrix).tolist()
    pixels = _camera.project((fx, fy, cx, cy), np.asarray(distortion).tolist(), points.tolist())
    return pixels[:, 0], pixels[:, 1]


def _are_in_image(u: Any, v: Any, width: int, height: int) -> Any:
    with np.errstate(invalid='ignore'):
        return (u >= -0.5) & (u < width - 0.5) & (v >= -0.5) & (v < height - 0.5)


def _in_millimetres(depth: NDArray[Any]) -> NDArray[np.uint16]:
    """Of depths [m]; 0 for what has none, or does not fit: as camera_node's 16UC1."""
    rounded = np.round(depth.astype(np.float64) * _MILLIMETRES)
    with np.errstate(invalid='ignore'):
        fits = (rounded >= 1) & (rounded <= np.iinfo(np.uint16).max)
    return np.where(fits, rounded, 0).astype(np.uint16)


def _flags(
    u: NDArray[np.float64], v: NDArray[np.float64], points: _Points, nodes: Mapping[str, Any], pixels: NDArray[np.bool_],
) -> NDArray[np.int64]:
    """Which points of a cable at u, v are seen, hidden, or not in the image. What is known is whether nodes are: a point is seen as the
    nearer one of the two nodes beside it is; where that is not in the image, as the other one; and where neither is, if its pixel is of
    the cable."""
    height, width = pixels.shape
    is_in, has_node = _are_in_image(u, v, width, height), _are_in_image(nodes['u'], nodes['v'], width, height)
    is_late = points.fraction > 0.5
    nearer, other = points.segment + is_late, points.segment + ~is_late
    of_pixel = np.zeros(len(u), dtype=bool)
    of_pixel[is_in] = pixels[np.rint(v[is_in]).astype(int), np.rint(u[is_in]).astype(int)]
    seen = np.select([has_node[nearer], has_node[other]], [nodes['visible'][nearer], nodes['visible'][other]], of_pixel)
    flags: NDArray[np.int64] = np.where(is_in, np.where(seen, _SEEN, _HIDDEN), _NOT_THERE)
    return flags


def crossings(truth: Mapping[str, Mapping[str, Any]]) -> List[Dict[str, Any]]:
    """Where cables of a `truth` of Camera.render cross as the camera sees them, each other or themselves, also beyond the edges of its
    image and behind what hides them: dicts with pixel [u, v], and over and
    under, which is behind: [cable, node], the node with its fraction on the way to the next one."""
    truth = _checked_truth(truth)
    names = list(truth)
    starts, ends, owners, nodes = [], [], [], []
    for index, cable in enumerate(truth.values()):
        line = np.column_stack([cable['u'], cable['v'], cable['positions'][:, 2]])
        starts.append(line[:-1])
        ends.append(line[1:])
        owners.append(np.full(len(line) - 1, index))
        nodes.append(np.arange(len(line) - 1))
    if not starts:
        return []
    start, end, owner, node = np.concatenate(starts), np.concatenate(ends), np.concatenate(owners), np.concatenate(nodes)
    is_there = np.isfinite(start).all(axis=1) & np.isfinite(end).all(axis=1)
    start, end, owner, node = start[is_there], end[is_there], owner[is_there], node[is_there]
    way = (end - start)[:, :2]
    first, last = np.nonzero(np.triu(_boxes_meet(start, end), 1))
    apart = (owner[first] != owner[last]) | (np.abs(node[first] - node[last]) > 1)
    first, last = first[apart], last[apart]
    between = start[last, :2] - start[first, :2]
    turn = _cross(way[first], way[last])
    with np.errstate(divide='ignore', invalid='ignore'):
        here, there = _cross(between, way[last]) / turn, _cross(between, way[first]) / turn
        meets = (here >= 0) & (here < 1) & (there >= 0) & (there < 1)
    found = []
    for one, other, a, b in zip(first[meets], last[meets], here[meets], there[meets]):
        # Along a line in space it is the inverse of depth that is linear in the image.
        depths = [1 / ((1 - part) / start[k, 2] + part / end[k, 2]) for k, part in ((one, a), (other, b))]
        places = [[names[owner[k]], float(node[k] + part * depth / end[k, 2])] for k, part, depth in zip((one, other), (a, b), depths)]
        over, under = places if depths[0] <= depths[1] else places[::-1]
        found.append({'pixel': (start[one, :2] + a * way[one]).round(3).tolist(), 'over': over, 'under': under})
    return found


def is_new_or_empty(path: Union[str, bytes, os.PathLike[str]]) -> bool:
    """Whether there is no such directory, or an empty one."""
    name = os.fsdecode(path)
    try:
        is_name = name != '' and b'\0' not in os.fsencode(name)
    except UnicodeEncodeError:
        is_name = False
    return is_name and (not os.path.lexists(name) or (os.path.isdir(name) and not os.listdir(name)))


def _new_directory(path: Union[str, bytes, os.PathLike[str]]) -> pathlib.Path:
    if not isinstance(path, (str, bytes, os.PathLike)):
        raise TypeError(_wrong('path', path, f'the path of {NEW_DIRECTORY}, as text, bytes or os.PathLike'))
    if not is_new_or_empty(path):
        raise ValueError(_wrong('path', path, NEW_DIRECTORY))
    return pathlib.Path(os.fsdecode(path))


def _numbers(name: str, value: ArrayLike, shape: Tuple[int, ...]) -> NDArray[np.float64]:
    """Finite ones."""
    try:
        numbers = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        numbers = np.full(shape, np.nan)
    if numbers.shape != shape or not np.isfinite(numbers).all():
        raise ValueError(_wrong(name, value, 'a finite number' if not shape else f'finite numbers of the shape {shape}'))
    return numbers


def _checked_images(images: Mapping[str, Any]) -> Dict[str, Any]:
    words = 'a dict with depth (height, width) [m], rgb (height, width, 3) uint8, mask (height, width) uint16 and truth, as of Camera.render'
    if not isinstance(images, Mapping) or not {'depth', 'rgb', 'mask', 'truth'} <= set(images):
        raise ValueError(_wrong('images', list(images) if isinstance(images, Mapping) else images, words))
    depth, rgb, mask = (np.asarray(images[name]) for name in ('depth', 'rgb', 'mask'))
    kinds = (depth.dtype.kind, rgb.dtype.name, mask.dtype.name)
    if mask.ndim != 2 or mask.size == 0 or depth.shape != mask.shape or rgb.shape != (*mask.shape, 3) or kinds != ('f', 'uint8', 'uint16'):
        given = ', '.join(f'{name} {array.shape} {array.dtype}' for name, array in (('depth', depth), ('rgb', rgb), ('mask', mask)))
        raise ValueError(f'images: {given}; allowed: {words}')
    truth = images['truth']
    checked = _checked_truth(truth)
    for name, cable in checked.items():
        visible = np.asarray(truth[name].get('visible'))
        if visible.shape != cable['u'].shape or visible.dtype != np.bool_:
            raise ValueError(_wrong(f'truth[{name!r}].visible', truth[name].get('visible'), 'visible: (n + 1,) bool'))
        cable['visible'] = visible
    return {'depth': depth, 'rgb': rgb, 'mask': mask, 'truth': checked}


def _checked_truth(truth: Mapping[str, Mapping[str, Any]]) -> Dict[str, Dict[str, NDArray[Any]]]:
    """Its arrays. Raises TypeError, or ValueError."""
    words = 'a truth as of Camera.render: {cable: {positions: (n + 1, 3), u: (n + 1,), v: (n + 1,)}}, of one segment or more'
    if not isinstance(truth, Mapping):
        raise TypeError(_wrong('truth', truth, words))
    checked = {}
    for name, cable in truth.items():
        if not isinstance(cable, Mapping) or not {'positions', 'u', 'v'} <= set(cable):
            raise ValueError(_wrong(f'truth[{name!r}]', cable, words))
        try:
            arrays = {key: np.asarray(cable[key], dtype=np.float64) for key in ('positions', 'u', 'v')}
        except (TypeError, ValueError):
            raise ValueError(_wrong(f'truth[{name!r}]', cable, words)) from None
        count = arrays['u'].size
        shapes = [array.shape for array in arrays.values()]
        if shapes != [(count, 3), (count,), (count,)] or count < 2:
            raise ValueError(f'truth[{name!r}]: positions, u, v of the shapes {", ".join(map(str, shapes))}; allowed: {words}')
        checked[name] = arrays
    return checked


def _cross(one: NDArray[np.float64], other: NDArray[np.float64]) -> NDArray[np.float64]:
    product: NDArray[np.float64] = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    return product


def _boxes_meet(start: NDArray[np.float64], end: NDArray[np.float64]) -> NDArray[np.bool_]:
    meet = np.ones((len(start), len(start)), dtype=bool)
    for axis in (0, 1):
        low, high = np.minimum(start[:, axis], end[:, axis]), np.maximum(start[:, axis], end[:, axis])
        meet &= (low[:, None] <= high[None, :]) & (low[None, :] <= high[:, None])
    return meet


def _run_lengths(pixels: NDArray[np.bool_]) -> List[int]:
    """Column by column, of pixels that are not of it and that are, in turn: as COCO has them."""
    flat = np.asfortranarray(pixels).ravel(order='F')
    changes = np.flatnonzero(np.diff(np.concatenate([[False], flat]).astype(np.int8))) if len(flat) else np.array([], dtype=int)
    lengths: List[int] = np.diff(np.concatenate([[0], changes, [len(flat)]])).tolist()
    return lengths


def _box(pixels: NDArray[np.bool_]) -> List[int]:
    """x, y, width, height."""
    rows, columns = np.flatnonzero(pixels.any(axis=1)), np.flatnonzero(pixels.any(axis=0))
    return [int(columns[0]), int(rows[0]), int(columns[-1] - columns[0] + 1), int(rows[-1] - rows[0] + 1)]


def _plain(light: Mapping[str, Any]) -> Dict[str, Any]:
    return {name: np.asarray(value).tolist() for name, value in light.items()}


def _range(name: str, value: Tuple[float, float], limits: Tuple[float, float], unit: str) -> Tuple[float, float]:
    least, most = limits
    allowed = f'two numbers{unit}, the larger one last (from {least:g} to {most:g})'
    low, high = _vector(name, value, 2, allowed)
    if not least <= low <= high <= most:
        raise ValueError(_wrong(name, value, allowed))
    return float(low), float(high)


def _random_view(
    random: np.random.Generator, target: NDArray[np.float64], distance: Tuple[float, float], elevation: Tuple[float, float],
) -> Tuple[NDArray[np.float64], NDArray[np.float64]]:
    away = random.uniform(*distance)
    height, around = np.radians(random.uniform(*elevation)), random.uniform(-np.pi, np.pi)
    towards = np.array([np.cos(height) * np.cos(around), np.cos(height) * np.sin(around), np.sin(height)])
    return target + away * towards, target


def _random_appearance(random: np.random.Generator, labels: Sequence[str]) -> Dict[str, Any]:
    height, around = np.radians(random.uniform(*_LIGHT_ELEVATIONS)), random.uniform(-np.pi, np.pi)
    light = {'direction': [np.cos(height) * np.cos(around), np.cos(height) * np.sin(around), np.sin(height)],
             'ambient': random.uniform(*_AMBIENTS), 'shadows': True}
    looks = {name: {'color': random.uniform(0.03, 1, 3), 'second_color': random.uniform(0.03, 1, 3), 'shininess': random.uniform(0, 0.6),
                    'stripes': int(random.integers(0, 4)), 'stripe_width': random.uniform(0.2, 1.2),
                    'check_size': float(np.exp(random.uniform(*np.log(_SQUARES))))} for name in labels}
    return {'light': light, 'background': random.uniform(0, 1, 3), 'looks': looks}
