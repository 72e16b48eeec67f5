"""Simulates some samples of a sweep, as many at once as have a motion and a time step in common."""
import copy

import numpy as np

from verlet_cable.sim import Batch, Scene, SceneError

from .description import MOTION
from .errors import rejected
from .paths import holder_of, parse_path
from .store import COMPLETE, FAULT, WRONG_SCENE
from .variations import draw_sample

_FAULTY = 4  # of Batch.status: the world could not be stepped


class Result:
    """Of some samples, in their order: status, messages (lists); fields {(name, field): (samples, rows, ...)}, 0 where a sample failed;
    drawn {key: (samples)}."""

    def __init__(self, count, layout):
        self.status = [COMPLETE] * count
        self.messages = [''] * count
        self.fields = {key: np.zeros((count, layout.rows) + shape) for key, shape in layout.shapes.items()}
        self.drawn = {}

    def fail(self, position, status, message):
        self.status[position] = status
        self.messages[position] = ' '.join(message.split())
        for data in self.fields.values():
            data[position] = 0


def simulate(sweep, layout, samples):
    """The Result for these samples. No sample depends on which others are simulated with it."""
    draws = [draw_sample(sweep.variations, sweep.seed, sample) for sample in samples]
    result = Result(len(samples), layout)
    for key, variation in sweep.variations.items():
        result.drawn[key] = np.array([variation.stored_value(draw[key]) for draw in draws])
    groups = {}
    scenes = _Scenes(sweep)
    for position, draw in enumerate(draws):
        try:
            scene = scenes.of(draw)
        except SceneError as error:
            result.fail(position, WRONG_SCENE, '; '.join(error.errors))
            continue
        rate_error = sweep.rate_error(scene.time_step)
        if rate_error:
            result.fail(position, WRONG_SCENE, rate_error)
            continue
        motion = sweep.motions[draw.get(MOTION, 0)] if sweep.motions else None
        groups.setdefault((motion, scene.time_step), []).append((position, scene))
    for (motion, time_step), members in groups.items():
        _simulate_group(sweep, layout, motion and sweep.motion_path(motion), time_step, members, result)
    return result


class _Scenes:
    """The scenes of draws: one tree, into which their values are put in turn."""

    def __init__(self, sweep):
        self._folder = sweep.scene_folder
        self._tree = copy.deepcopy(sweep.tree)
        self._places = []
        for key, variation in sweep.variations.items():
            if key != MOTION:
                parts = parse_path(key)
                self._places.append((holder_of(self._tree, parts), parts[-1], key, variation))

    def of(self, draw):
        for holder, part, key, variation in self._places:
            holder[part] = variation.scene_value(draw[key])
        return Scene.from_dict(self._tree, directory=self._folder)


def _simulate_group(sweep, layout, motion, time_step, members, result):
    """Members: (position in the result, Scene). One that cannot be had with the others, or at all, is tried alone."""
    positions = [position for position, scene in members]
    try:
        batch = Batch([scene for position, scene in members], motion=motion, threads=1)
        _check_shapes(batch, layout)
    except (ValueError, KeyError, RuntimeError) as error:  # SceneError is a ValueError
        if len(members) == 1:
            result.fail(positions[0], WRONG_SCENE, '; '.join(getattr(error, 'errors', None) or [str(error)]))
            return
        for member in members:
            _simulate_group(sweep, layout, motion, time_step, [member], result)
        return
    try:
        faulty = _run(sweep, layout, batch, time_step, positions, result)
    except (ValueError, KeyError, RuntimeError) as error:
        if len(members) == 1:
            result.fail(positions[0], FAULT, str(error))
            return
        for member in members:
            _simulate_group(sweep, layout, motion, time_step, [member], result)
        return
    for index in np.flatnonzero(faulty):
        result.fail(positions[index], FAULT, f'the simulation failed within {sweep.duration:g} s')


def _check_shapes(batch, layout):
    for (name, field), shape in layout.shapes.items():
        found = tuple(np.shape(getattr(batch, field)(name))[1:])
        if found != shape:
            raise ValueError(rejected(f'{name}/{field}', 'x'.join(map(str, found)), 'x'.join(map(str, shape)) + ', as in the scene'))


def _run(sweep, layout, batch, time_step, positions, result):
    """Steps the batch to its end, with its rows put into the result. Returns which worlds failed."""
    steps, of_rows = sweep.steps(time_step)
    _read(batch, layout, positions, result, slice(0, 1), is_record=False)
    faulty = np.zeros(len(positions), dtype=bool)
    strides = set(np.diff(of_rows))
    if len(strides) == 1:
        stride = int(strides.pop())
        batch.step(of_rows[-1], record_every=stride, fields=sorted({field for name, field in layout.shapes}))
        faulty |= batch.status == _FAULTY
        _read(batch, layout, positions, result, slice(1, layout.rows), is_record=True)
    else:
        for row in range(1, layout.rows):
            batch.step(of_rows[row] - of_rows[row - 1])
            faulty |= batch.status == _FAULTY
            _read(batch, layout, positions, result, slice(row, row + 1), is_record=False)
    if steps > of_rows[-1]:
        batch.step(steps - of_rows[-1])
        faulty |= batch.status == _FAULTY
    return faulty


def _read(batch, layout, positions, result, rows, is_record):
    for name, field in layout.shapes:
        data = np.asarray(getattr(batch, field)(name))
        result.fields[name, field][positions, rows] = data if is_record else data[:, np.newaxis]
