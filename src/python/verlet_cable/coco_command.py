"""cable_coco (SCENE.yaml | --sweep SWEEP.yaml) --output DIR: runs scenes and writes what a camera sees of them, to learn from."""
import argparse
import math
import signal
import sys
from typing import NamedTuple, Optional

import numpy as np

from verlet_cable.sim import Scene, SceneError, World
from verlet_cable.sweep.description import MOTION, Sweep, read_sweep
from verlet_cable.sweep.errors import SweepError, rejected, unknown_key
from verlet_cable.sweep.scenes import Scenes
from verlet_cable.sweep.text_yaml import number, parse, shown, with_numbers
from verlet_cable.sweep.variations import draw_sample

_BAD_INPUT, _STOPPED = 2, 3
_OF_CAMERA = ('preset', 'width', 'height', 'horizontal_fov', 'near', 'far', 'distortion', 'noise', 'seed')
# camera_node's files may have them, too.
_OF_NODE = ('state', 'optical_frame', 'camera_info_topic', 'rate', 'depth_encoding', 'shadows', 'labels', 'robot_description', 'tf_timeout')
_DEPTH_ENCODINGS = ('32FC1', '16UC1')  # of camera_node; the PNG files have millimetres with both
_NEAREST, _FURTHEST = 0.8, 1.6  # by default, over the distance from which all cables just fit into the image
_LEAST_SIZE = 0.05              # [m] of what is seen
_NEAR, _FAR = 0.01, 1000.0      # [m] of the camera, by default
_MOST_FAILURES = 20             # that are printed
_MOST_IMAGES = 10**8


class _Sample(NamedTuple):
    """A scene that runs, and what moves and loads it."""

    name: str
    scene: Scene
    motion: Optional[str]
    loads: Optional[str]


def main(arguments=None):
    """The exit status: 0 when all images are written, 2 for bad input, 3 when it had to stop; the images until then are whole."""
    options = _options(arguments)
    try:
        import verlet_cable.camera.coco  # noqa: F401, not there everywhere
    except ImportError as error:
        print(f'cable_coco: {error}', file=sys.stderr)
        return _BAD_INPUT
    try:
        camera, sweep, samples = _read(options)
        dataset = _new_dataset(options)
    except SweepError as error:
        for line in error.errors:
            print(f'cable_coco: {line}', file=sys.stderr)
        return _BAD_INPUT
    signal.signal(signal.SIGTERM, _interrupt)
    reason, failed = '', 0
    try:
        with dataset:
            try:
                failed = _write(options, camera, sweep, samples, dataset)
            except KeyboardInterrupt:
                reason = 'interrupted'
    except OSError as error:
        reason = f'--output: {options.output}: {_why(error)}'
    if failed and options.sweep is None:
        reason = 'it had to stop'
    if reason:
        print(f'cable_coco: {reason}; {len(dataset)} images are in {options.output}', file=sys.stderr)
        return _STOPPED
    print(f'{len(dataset)} images in {options.output}' + (f'; {failed} samples failed' if options.sweep else ''))
    return 0


def _options(arguments):
    parser = argparse.ArgumentParser(
        prog='cable_coco', description='Runs a scene, or the samples of a sweep, and writes what a camera sees of them as a data set in the '
        'format of COCO: images, masks, depth, keypoints and crossings. Place of the camera, light and looks vary, by the seed.',
        epilog='Exit status: 0 when all images are written, 2 for bad input, 3 when it had to stop: the images until then are there.')
    what = parser.add_mutually_exclusive_group(required=True)
    what.add_argument('scene', metavar='SCENE.yaml', nargs='?', help='the scene that runs')
    what.add_argument('--sweep', metavar='SWEEP.yaml', help='the samples of this sweep run instead, for its duration, at its rate')
    parser.add_argument('--output', metavar='DIR', required=True, help='a directory that is new or empty')
    parser.add_argument('--motion', metavar='CSV', help='as of cable_sim')
    parser.add_argument('--loads', metavar='CSV', help='as of cable_sim')
    parser.add_argument('--duration', metavar='S', type=_number, help='[s] to simulate (default: 10)')
    parser.add_argument('--rate', metavar='HZ', type=_number, help='[Hz] of simulated time at which there are images (default: 1)')
    parser.add_argument('--settle', action='store_true', help='put the cables into static equilibrium before t = 0')
    parser.add_argument('--camera', metavar='CAMERA.yaml', help='keys ' + ', '.join(_OF_CAMERA) + '; a file of camera_node')
    parser.add_argument('--views', metavar='N', type=int, default=1, help='images from so many sides at each time (default: 1)')
    parser.add_argument('--target', metavar=('X', 'Y', 'Z'), nargs=3, type=_number,
                        help='[m] what the camera is turned to (default: the middle of the cables)')
    parser.add_argument('--distance', metavar=('A', 'B'), nargs=2, type=_number,
                        help='[m] how far it is away: between these (default: such that all cables are about as large as the image)')
    parser.add_argument('--elevation', metavar=('A', 'B'), nargs=2, type=_number, default=(15.0, 75.0),
                        help='[degree] above the horizon: between these (default: 15 75)')
    parser.add_argument('--keypoints', metavar='N', type=int, default=21, help='so many points along each cable (default: 21)')
    parser.add_argument('--seed', metavar='N', type=int, default=0,
                        help='of places, light and looks, and, with the seed of the camera, of noise (default: 0)')
    parser.add_argument('--scene-looks', action='store_true', help="the scene's colors, and one light")
    return parser.parse_args(arguments)


def _number(text):
    found = number(text)
    if found is None or not math.isfinite(found):
        raise argparse.ArgumentTypeError(f'{text!r}; allowed: a finite number')
    return found


def _read(options):
    """Raises SweepError with all that is wrong."""
    from verlet_cable.camera import coco
    from verlet_cable.camera.camera import LARGEST_SEED
    errors = []
    _collected(errors, lambda: _check_output(options.output))
    camera = _collected(errors, lambda: _camera_of(options.camera))
    for name, value, least, most in (('--views', options.views, 1, 10000), ('--keypoints', options.keypoints, 2, coco.MOST_KEYPOINTS),
                                     ('--seed', options.seed, 0, LARGEST_SEED)):
        if not least <= value <= most:
            errors.append(rejected(name, str(value), f'an integer from {least} to {most}'))
    for name, pair, unit, (least, most) in (('--distance', options.distance, 'm', coco.DISTANCES),
                                            ('--elevation', options.elevation, 'degree', coco.ELEVATIONS)):
        if pair and not least <= pair[0] <= pair[1] <= most:
            allowed = f'two numbers [{unit}], the larger one last (from {least:g} to {most:g})'
            errors.append(rejected(name, f'{pair[0]:g} {pair[1]:g}', allowed))
    what = _collected(errors, lambda: _what_runs(options))
    if errors:
        raise SweepError(errors)
    sweep, scene = what
    return camera, sweep, _samples(options, sweep, scene)


def _collected(errors, read):
    """What it reads, or None and what was wrong."""
    try:
        return read()
    except (SweepError, ValueError) as error:
        errors += getattr(error, 'errors', None) or str(error).splitlines()
    except OSError as error:
        errors.append(f'{error.filename}: {error.strerror}; allowed: a file that can be read')
    return None


def _check_output(path):
    from verlet_cable.camera import coco
    try:
        is_usable = coco.is_new_or_empty(path)
    except OSError as error:
        raise SweepError([_output_error(path, error)]) from error
    if not is_usable:
        raise SweepError([rejected('--output', path or "''", coco.NEW_DIRECTORY)])


def _new_dataset(options):
    from verlet_cable.camera import coco
    try:
        return coco.Dataset(options.output, options.keypoints, options.seed)
    except OSError as error:
        raise SweepError([_output_error(options.output, error)]) from error
    except (ImportError, ValueError) as error:  # no Pillow; or another one has made the directory meanwhile
        raise SweepError([str(error)]) from error


def _output_error(path, error):
    from verlet_cable.camera import coco
    return rejected('--output', f'{path}: {_why(error)}', f'{coco.NEW_DIRECTORY}, where files can be written')


def _why(error):
    return error.strerror or str(error)


def _camera_of(path):
    from verlet_cable.camera import Camera
    if path is None:
        return Camera(near=_NEAR, far=_FAR)
    errors = []
    with open(path, encoding='utf-8') as file:
        keys = with_numbers(parse(file.read(), path, errors)) or {}
    if not errors and not isinstance(keys, dict):
        errors.append(rejected(path, shown(keys), 'keys ' + ', '.join(_OF_CAMERA)))
    if errors:
        raise SweepError(errors)
    errors += [unknown_key(key, shown(keys[key]), _OF_CAMERA) for key in keys if key not in _OF_CAMERA + _OF_NODE]
    if 'depth_encoding' in keys and keys['depth_encoding'] not in _DEPTH_ENCODINGS:
        errors.append(rejected('depth_encoding', shown(keys['depth_encoding']), ' | '.join(_DEPTH_ENCODINGS)))
    arguments = {key: value for key, value in keys.items() if key in _OF_CAMERA and not (key == 'preset' and not value)}
    camera = _collected(errors, lambda: Camera(**arguments))
    if errors:
        raise SweepError([f'{path}: {line}' for line in errors])
    return camera


def _what_runs(options):
    """A sweep and None, or a sweep of one sample without variations, and its scene."""
    if options.sweep is not None:
        given = [name for name in ('motion', 'loads', 'duration', 'rate') if getattr(options, name) is not None]
        if given:
            raise SweepError([rejected(f'--{name}', 'given with --sweep', f'{name} in {options.sweep}') for name in given])
        return read_sweep(options.sweep)[0], None
    sweep = Sweep()
    sweep.duration = 10.0 if options.duration is None else options.duration
    sweep.rate = 1.0 if options.rate is None else options.rate
    errors = [] if sweep.duration >= 0 else [rejected('--duration', f'{sweep.duration:g}', '0 or more [s]')]
    if not sweep.rate > 0:
        errors.append(rejected('--rate', f'{sweep.rate:g}', 'any number above 0 [Hz]'))
    scene = _collected(errors, lambda: Scene.load(options.scene))
    if scene is not None:
        _collected(errors, lambda: World(scene, options.motion, options.loads).step())
    if not errors:
        if sweep.rate * scene.time_step > 1:
            errors.append(rejected('--rate', f'{sweep.rate:g}', f'at most 1 / time_step = {1 / scene.time_step:g} Hz'))
        elif sweep.duration * sweep.rate > _MOST_IMAGES:
            errors.append(rejected('--duration', f'{sweep.duration:g}', f'at most {_MOST_IMAGES} images'))
    if errors:
        raise SweepError(errors)
    sweep.samples = 1
    return sweep, scene


def _samples(options, sweep, scene):
    """_Samples, and a text for each that cannot be."""
    if scene is not None:
        yield _Sample(options.scene, scene, options.motion, options.loads)
        return
    scenes = Scenes(sweep)
    for index in range(sweep.samples):
        draw = draw_sample(sweep.variations, sweep.seed, index)
        try:
            scene = scenes.of(draw)
        except SceneError as error:
            yield f'sample {index}: {"; ".join(error.errors)}'
            continue
        rate_error = sweep.rate_error(scene.time_step)
        if rate_error:
            yield f'sample {index}: {rate_error}'
            continue
        motion = sweep.motions[draw.get(MOTION, 0)] if sweep.motions else None
        yield _Sample(f'sample {index}', scene, motion and sweep.motion_path(motion), sweep.loads_path)


def _write(options, camera, sweep, samples, dataset):
    """How many samples failed."""
    failures = []
    for sample in samples:
        problem = sample if isinstance(sample, str) else _write_sample(options, camera, sweep, sample, dataset)
        if not problem:
            continue
        failures.append(problem)
        if len(failures) <= _MOST_FAILURES:
            print(f'cable_coco: {problem}', file=sys.stderr)
    return len(failures)


def _write_sample(options, camera, sweep, sample, dataset):
    """Why it ended before its time; empty if it did not."""
    try:
        world = World(sample.scene, sample.motion, sample.loads)
        if options.settle:
            world.settle()
        done = 0
        for step in sweep.steps(sample.scene.time_step)[1]:
            if world.step(step - done) == 'fault':
                return f'{sample.name}: the simulation failed before {step * sample.scene.time_step:g} s'
            done = step
            for _ in range(options.views):
                target, distance = _view(options, camera, world)
                dataset.add(camera, world, target, distance, options.elevation, vary_looks=not options.scene_looks)
    except (ValueError, KeyError) as error:
        return f'{sample.name}: {error.args[0]}'
    return ''


def _view(options, camera, world):
    """What the camera is turned to, and between which distances."""
    names = [*world.cable_names, *world.net_names]
    nodes = np.concatenate([world.positions(name) for name in names]) if names else np.zeros((1, 3))
    low, high = nodes.min(axis=0), nodes.max(axis=0)
    target = np.array(options.target) if options.target else (low + high) / 2
    if options.distance:
        return target, tuple(options.distance)
    radius = max(float(np.linalg.norm(nodes - target, axis=1).max()), _LEAST_SIZE)
    matrix = camera.matrix
    half_angle = math.atan(min(camera.width / matrix[0, 0], camera.height / matrix[1, 1]) / 2)
    fitting = radius / math.sin(half_angle)
    return target, (_NEAREST * fitting, _FURTHEST * fitting)


def _interrupt(number, frame):
    raise KeyboardInterrupt
