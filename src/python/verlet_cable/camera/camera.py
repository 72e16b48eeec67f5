"""The class Camera: arguments and arrays around what is compiled."""
from __future__ import annotations

import operator
from typing import Any, Callable, Dict, List, Mapping, NamedTuple, Optional, Sequence, Tuple, TypeVar, Union, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from verlet_cable import _camera
from verlet_cable.sim import Batch, World
from verlet_cable.wrong_arguments import explain_names, meant

IMAGES = ('depth', 'rgb', 'mask', 'points', 'truth')
_MOST_THREADS = 1024
_NOISE = {'axial': (0.0, 0.0, 0.0), 'dropout_angle': 90.0, 'baseline': 0.0, 'disparity_step': 0.0, 'edge_dropout': 0.0, 'edge_step': 0.02}
_CAMERA = {'width': 640, 'height': 480, 'horizontal_fov': 1.05, 'near': 0.1, 'far': 10.0, 'distortion': (0.0,) * 5}
_FURTHEST = 1e9  # [m] as of frames
_SEEDS = 1 << 64
LARGEST_SEED = _SEEDS - 1
_WORLD_STRIDE = 0x9e3779b97f4a7c15  # between the seeds of a batch's worlds: so far apart that other seeds do not meet them
_NANOSECONDS = 1e9
_Value = TypeVar('_Value')


class Preset(NamedTuple):
    """A depth camera with the figures that are published of it. camera, noise: arguments of Camera; source: of the figures."""

    camera: Dict[str, Any]
    noise: Dict[str, Any]
    source: str


def presets() -> Dict[str, Preset]:
    """All presets by name."""
    return {name: Preset(*preset) for name, preset in _camera.presets().items()}


class _Numbers(NamedTuple):
    """Of the images of a data set. seed: the data set's; first: the number of the first of them."""

    seed: int
    first: int


@explain_names
class Camera:
    """A depth camera at a pose, which sees worlds.

    width, height: [pixels]. horizontal_fov: [rad] from the left edge of the image to the right one. near, far: [m] depths that are
    measured: what is nearer has no depth, but hides what is behind it; beyond far nothing is seen. distortion: k1, k2, t1, t2, k3 of the model plumb_bob, as in sensor_msgs/CameraInfo.

    noise: what the sensor does to depth, a dict with some of the keys
        axial: (a, b, c): the standard deviation of what is measured at the depth z is a + b z + c z^2 [m], nowhere below 0 from
            near to far; it includes that of disparity_step, and is that alone where it is less
        dropout_angle: [degree] no depth where the line of sight is further from the surface's normal
        baseline: [m] place of the second imager, or the projector, along x of the optical frame: no depth where that sees nothing
        disparity_step: [pixels] to which disparities are rounded
        edge_dropout: 0 to 1: how often there is no depth beside what is deeper by more than edge_step [m]

    preset: name of a camera from presets(), for what the other arguments leave out. seed: of the noise, an integer from 0 to 2^64 - 1.
    threads: 0: as many as there are cores; the images do not depend on it.

    The camera begins at the origin of the fixed frame and looks along its z axis, as all optical frames do; x is to the right in the
    image, y down. Raises ValueError with all that is wrong, a line each.
    """

    def __init__(
        self, width: Optional[int] = None, height: Optional[int] = None, horizontal_fov: Optional[float] = None,
        near: Optional[float] = None, far: Optional[float] = None, noise: Optional[Mapping[str, Any]] = None, seed: int = 0,
        distortion: Optional[Sequence[float]] = None, preset: Optional[str] = None, threads: int = 0,
    ) -> None:
        self._arguments = {'width': width, 'height': height, 'horizontal_fov': horizontal_fov, 'near': near, 'far': far, 'noise': noise,
                           'seed': seed, 'distortion': distortion, 'preset': preset, 'threads': threads}
        checks = _Checks()
        numbers, noises = _preset(preset, checks)
        for key, value in (('width', width), ('height', height)):
            if value is not None:
                numbers[key] = checks.integer(key, value, 1, _camera.most_pixels, numbers[key], ' [pixels]')
        for key, value in (('horizontal_fov', horizontal_fov), ('near', near), ('far', far), ('distortion', distortion)):
            if value is not None:
                numbers[key] = checks.numbers(key, value, numbers[key])
        for key, value in checks.noise(noise).items():
            noises[key] = checks.numbers(f'noise.{key}', value, noises[key])
        self._seed = checks.integer('seed', seed, 0, LARGEST_SEED)
        self._threads = checks.integer('threads', threads, 0, _MOST_THREADS)
        checks.add(_camera.errors(**numbers, **noises))
        self._camera = _camera.CompiledCamera(**numbers, **noises)
        self._width, self._height, self._distortion = numbers['width'], numbers['height'], tuple(numbers['distortion'])
        self._pose: Tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)

    def __reduce__(self) -> Tuple[Any, ...]:
        return _again, (self._arguments, self._pose)

    def __repr__(self) -> str:
        return f'<Camera of {self._width} x {self._height} pixels at ({", ".join(f"{x:g}" for x in self._pose[:3])})>'

    @property
    def width(self) -> int:
        """[pixels]"""
        return self._width

    @property
    def height(self) -> int:
        """[pixels]"""
        return self._height

    @property
    def matrix(self) -> NDArray[np.float64]:
        """(3, 3) The intrinsic matrix [pixels], K of sensor_msgs/CameraInfo."""
        fx, fy, cx, cy = self._camera.intrinsics
        return _read_only([[fx, 0, cx], [0, fy, cy], [0, 0, 1]])

    @property
    def distortion(self) -> Tuple[float, ...]:
        """k1, k2, t1, t2, k3 of plumb_bob, D of sensor_msgs/CameraInfo."""
        return self._distortion

    @property
    def pose(self) -> NDArray[np.float64]:
        """(7,) x, y, z, qx, qy, qz, qw of the optical frame in the fixed frame; may be set, as a whole."""
        return _read_only(self._pose)

    @pose.setter
    def pose(self, pose: ArrayLike) -> None:
        numbers = _vector('pose', pose, 7)
        with np.errstate(over='ignore'):
            length = float(np.linalg.norm(numbers[3:]))
        if not 0.5 <= length <= 2 or (np.abs(numbers[:3]) > _FURTHEST).any():
            raise ValueError(_wrong('pose', pose, f'x, y, z [m] (from {-_FURTHEST:g} to {_FURTHEST:g}), qx, qy, qz, qw with a quaternion of '
                                                  'length 1 (from 0.5 to 2 is brought to 1)'))
        self._pose = (*map(float, numbers[:3]), *map(float, numbers[3:] / length))

    def look_at(self, eye: ArrayLike, target: ArrayLike, up: Optional[ArrayLike] = None) -> Camera:
        """Puts the camera at `eye` so that it has `target` in the middle of its image, and the direction `up` upwards in it; None: z,
        or, from straight above or below, y. Returns the camera. Raises ValueError where that cannot be."""
        places = [_point('eye', eye), _point('target', target)]
        if up is not None:
            direction = _vector('up', up, 3)
            places.append(direction / max(1.0, np.abs(direction).max() / _FURTHEST))
        self._pose = tuple(_camera.look_at(*(tuple(map(float, place)) for place in places)))
        return self

    def labels(self, world: Union[World, Batch]) -> List[str]:
        """The names of what is in a world (of a batch: its first), in the order of their numbers in masks, from 1 on: cables, nets,
        particles, bodies and obstacles."""
        drawings, _ = _drawings(world, {})
        return _camera.labels(drawings)[0]

    def render(
        self, world: Union[World, Batch], images: Sequence[str] = IMAGES, light: Optional[Mapping[str, Any]] = None,
        background: Optional[Sequence[float]] = None, looks: Optional[Mapping[str, Mapping[str, Any]]] = None,
        stripes: bool = True, distinct_colors: bool = False, least_radius: float = 0.0,
    ) -> Dict[str, Any]:
        """A dict with what is asked for in `images`:

        depth:  (height, width) float32 [m] along the line of sight's z axis, NaN where there is none, or it is below near
        rgb:    (height, width, 3) uint8, from the lens on, so also of what is nearer than near
        mask:   (height, width) uint16: 0 where nothing is seen, 1 for the first of labels(world), ...; from the lens on, as rgb
        points: (height, width, 3) float32 [m] of depth, in the optical frame, NaN where there is none
        truth:  {cable: {positions: (n + 1, 3) [m] of its nodes in the optical frame, u, v: (n + 1,) [pixels], NaN for what is not in
                front of the camera, visible: (n + 1,) bool}}. A node is visible if it is in the image, from near to far, and what is
                met first on the way to it is its cable, no further from it than two radii.

        Noise depends on seed and the world's time only: what is rendered twice is the same. Of a Batch all arrays have an axis of the
        worlds in front; each world has noise of its own.

        light: dict with some of direction (3,) towards the sun, ambient (0 to 1: brightness of what the sun does not reach), shadows
        (bool). background: (red, green, blue), from 0 to 1. looks: {name: dict with some of color, second_color, pattern ('plain',
        'stripes' along cables, by which roll and twist are seen, 'checks' on all else), stripes (how many), stripe_width [rad],
        check_size [m], shininess (0 to 1)}. stripes: whether cables have one that nothing is said of in looks. distinct_colors: where cables or nets have the same color, all of them get others that
        tell them apart. least_radius: [m] thinner cables are drawn so thick. Raises ValueError.
        """
        given = {'light': light, 'background': background, 'looks': looks, 'stripes': stripes, 'distinct_colors': distinct_colors,
                 'least_radius': least_radius}
        return self._render(world, images, given)

    def _render(
        self, world: Union[World, Batch], images: Sequence[str], given: Mapping[str, Any], numbers: Optional[_Numbers] = None,
    ) -> Dict[str, Any]:
        """As render. numbers: those of the images, of which noise is a function in place of the time."""
        wanted = _checked_images(images)
        drawings, times = _drawings(world, {key: dict(value) if isinstance(value, Mapping) else value
                                            for key, value in given.items() if value is not None})
        if numbers is None:
            noise = [((self._seed + index * _WORLD_STRIDE) % _SEEDS, round(time * _NANOSECONDS)) for index, time in enumerate(times)]
        else:
            seed = int(np.random.SeedSequence([numbers.seed, self._seed]).generate_state(1, np.uint64)[0])
            noise = [(seed, numbers.first + index) for index in range(len(times))]
        result: Dict[str, Any] = self._camera.render(drawings, self._pose, noise, wanted, self._threads)
        if 'truth' in result:
            result['truth'] = _joined([_truth(cables) for cables in result['truth']], isinstance(world, Batch))
        if isinstance(world, World):
            result.update({name: array[0] for name, array in result.items() if name != 'truth'})
        return {name: result[name] for name in wanted}


def _again(arguments: Dict[str, Any], pose: Tuple[float, ...]) -> Camera:
    """A copy."""
    camera = Camera(**arguments)
    camera._pose = pose
    return camera


def _read_only(numbers: ArrayLike) -> NDArray[np.float64]:
    """A copy: what is written into it would change nothing."""
    array = np.array(numbers, dtype=np.float64)
    array.setflags(write=False)
    return array


def _wrong(name: str, value: Any, allowed: str) -> str:
    return f'{name}: {value!r}; allowed: {allowed}'


def _is_integer(value: Any) -> bool:
    try:
        operator.index(value)
    except TypeError:
        return False
    return not isinstance(value, bool)


class _Checks:
    """Collects what is wrong with arguments; in place of what is wrong others are checked with what is right."""

    def __init__(self) -> None:
        self._lines: List[str] = []

    def refuse(self, name: str, value: Any, allowed: str) -> None:
        self._lines.append(_wrong(name, value, allowed))

    def integer(self, name: str, value: Any, least: int, most: int, right: int = 0, unit: str = '') -> int:
        if _is_integer(value) and least <= operator.index(value) <= most:
            return operator.index(value)
        self.refuse(name, value, f'an integer{unit} (from {least} to {most})')
        return right

    def value(self, read: Callable[[], _Value]) -> _Value:
        """What `read` returns; where it raises ValueError, nothing that is to be used."""
        try:
            return read()
        except ValueError as error:
            self._lines += str(error).split('\n')
            return cast(_Value, None)

    def numbers(self, name: str, value: Any, right: Any) -> Any:
        """A float, or a tuple of them; which are allowed the compiled module says."""
        counts = {'distortion': ('five numbers k1, k2, t1, t2, k3', 5), 'noise.axial': ('three numbers a, b, c', 3)}
        words, count = counts.get(name, ('a number', 0))
        try:
            numbers = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError):
            numbers = np.empty(0)
        if numbers.shape == ((count,) if count else ()) and not isinstance(value, (str, bytes, bool)):
            return tuple(numbers.tolist()) if count else float(numbers)
        self.refuse(name, value, words)
        return right

    def noise(self, noise: Optional[Mapping[str, Any]]) -> Dict[str, Any]:
        if noise is not None and not isinstance(noise, Mapping):
            self.refuse('noise', noise, 'a dict with some of the keys ' + ', '.join(_NOISE))
            return {}
        given = dict(noise or {})
        self._lines += [f'noise.{key}: no such key{meant(str(key), _NOISE)}; allowed: {", ".join(_NOISE)}' for key in given
                        if key not in _NOISE]
        return {key: value for key, value in given.items() if key in _NOISE}

    def add(self, lines: Sequence[str]) -> None:
        """Raises ValueError with all lines, if there are any."""
        if self._lines or lines:
            raise ValueError('\n'.join([*self._lines, *lines]))


def _vector(name: str, value: ArrayLike, size: int, allowed: str = '') -> NDArray[np.float64]:
    allowed = allowed or f'{size} finite numbers'
    try:
        numbers = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise ValueError(_wrong(name, value, allowed)) from None
    if numbers.shape != (size,) or not np.isfinite(numbers).all():
        raise ValueError(_wrong(name, value, allowed))
    return numbers


def _point(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """[m]"""
    allowed = f'3 finite numbers [m] (from {-_FURTHEST:g} to {_FURTHEST:g})'
    try:
        numbers = _vector(name, value, 3)
    except ValueError:
        numbers = np.full(3, np.inf)
    if (np.abs(numbers) > _FURTHEST).any():
        raise ValueError(_wrong(name, value, allowed))
    return numbers


def _preset(name: Optional[str], checks: _Checks) -> Tuple[Dict[str, Any], Dict[str, Any]]:
    """Arguments and noise to begin with."""
    if name is None:
        return dict(_CAMERA), dict(_NOISE)
    known = presets()
    if not isinstance(name, str) or name not in known:
        checks.refuse('preset', name, ', '.join(sorted(known)))
        return dict(_CAMERA), dict(_NOISE)
    return dict(known[name].camera), dict(known[name].noise)


def _checked_images(images: Sequence[str]) -> List[str]:
    try:
        names = [] if isinstance(images, (str, bytes)) else list(images)
    except TypeError:
        names = []
    if not names or not all(isinstance(name, str) and name in IMAGES for name in names):
        raise ValueError(_wrong('images', images, 'a list with some of ' + ', '.join(IMAGES)))
    return list(dict.fromkeys(names))


def _drawings(world: Union[World, Batch], appearance: Dict[str, Any]) -> Tuple[Any, List[float]]:
    if not isinstance(world, (World, Batch)):
        raise TypeError(_wrong('world', world, 'a World or a Batch'))
    compiled: Any = world
    drawings: Tuple[Any, List[float]] = compiled._drawings(appearance)
    return drawings


def _truth(cables: Sequence[Tuple[Any, ...]]) -> Dict[str, Dict[str, Any]]:
    return {name: dict(zip(('positions', 'u', 'v', 'visible'), arrays)) for name, *arrays in cables}


def _joined(truth: List[Dict[str, Dict[str, Any]]], of_batch: bool) -> Dict[str, Dict[str, Any]]:
    """With an axis of the worlds in front."""
    if not of_batch:
        return truth[0]
    sizes = [{name: len(cable['u']) for name, cable in one.items()} for one in truth]
    for index, size in enumerate(sizes):
        if size != sizes[0]:
            raise ValueError(f'images: truth of worlds 0 and {index}, which have other cables or nodes by now; allowed: batches whose '
                             'worlds have the same, or images without truth')
    return {name: {field: np.stack([one[name][field] for one in truth]) for field in cable} for name, cable in truth[0].items()}
