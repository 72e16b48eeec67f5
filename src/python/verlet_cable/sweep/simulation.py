"""Simulates some samples of a sweep, as many at once as have a motion and a time step in common."""
import numpy as np

from verlet_cable.sim import Batch, SceneError, World

from .description import MOTION
from .errors import rejected
from .scenes import Scenes
from .store import COMPLETE, FAULT, MISSING, STATUSES, WRONG_SCENE
from .variations import draw_sample

_FAULTY = STATUSES.index('fault')

_GUIDED = 'the number of nodes of a cable changed, which slides through a guide; allowed for such ones: fields that do not belong to nodes'


class Result:
    """Of some samples, in their order: status, worst, messages (lists); fields {(name, field): (samples, rows, ...)}, NaN where a sample
    failed; drawn {key: (samples)}. worst: index into STATUSES, MISSING where nothing was simulated."""

    def __init__(self, count, layout):
        self.status = [COMPLETE] * count
        self.worst = [MISSING] * count
        self.messages = [''] * count
        self.fields = {key: np.full((count, layout.rows) + shape, np.nan) for key, shape in layout.shapes.items()}
        self.drawn = {}

    def fail(self, position, status, message):
        self.status[position] = status
        self.messages[position] = ' '.join(message.split())
        for data in self.fields.values():
            data[position] = np.nan


def simulate(sweep, layout, samples):
    """The Result for these samples. No sample depends on which others are simulated with it."""
    draws = [draw_sample(sweep.variations, sweep.seed, sample) for sample in samples]
    result = Result(len(samples), layout)
    for key, variation in sweep.variations.items():
        result.drawn[key] = np.array([variation.stored_value(draw[key]) for draw in draws])
    groups = {}
    scenes = Scenes(sweep)
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


def _simulate_group(sweep, layout, motion, time_step, members, result):
    """Members: (position in the result, Scene). One that cannot be had with the others, or at all, is tried alone."""
    positions = [position for position, scene in members]
    try:
        batch = Batch([scene for position, scene in members], motion=motion, threads=1, loads=sweep.loads_path)
        _check_shapes(batch, layout)
    except (ValueError, KeyError, RuntimeError) as error:  # SceneError is a ValueError
        if len(members) == 1:
            result.fail(positions[0], WRONG_SCENE, '; '.join(getattr(error, 'errors', None) or [str(error)]))
            return
        for member in members:
            _simulate_group(sweep, layout, motion, time_step, [member], result)
        return
    nodes = _Nodes(batch)
    try:
        worst = _run(sweep, layout, batch, time_step, positions, result)
    except (ValueError, KeyError, RuntimeError) as error:
        _simulate_parted(sweep, layout, motion, time_step, members, result, _broken(sweep, batch, time_step, nodes), error)
        return
    for index, position in enumerate(positions):
        result.worst[position] = worst[index]
        if worst[index] == _FAULTY:
            result.fail(position, FAULT, f'the simulation failed within {sweep.duration:g} s')
    for index in _broken(sweep, batch, time_step, nodes):
        _fail_broken(sweep, motion, time_step, members[index], result)


def _simulate_parted(sweep, layout, motion, time_step, members, result, broken, error):
    """Where not all of the members have the same arrays at the end: the broken ones fail, the others are simulated without them."""
    for index in broken:
        _fail_broken(sweep, motion, time_step, members[index], result)
    others = [member for index, member in enumerate(members) if index not in broken]
    if broken and others:
        _simulate_group(sweep, layout, motion, time_step, others, result)
    elif not broken and len(members) == 1:
        result.fail(members[0][0], FAULT, _GUIDED if members[0][1].guide_names else str(error))
    elif not broken:
        for member in members:
            _simulate_group(sweep, layout, motion, time_step, [member], result)


def _broken(sweep, batch, time_step, nodes):
    """Indices of the worlds in which a cable has broken by the end."""
    left = sweep.steps(time_step)[0] - round(batch.time.max() / time_step)
    if left > 0:
        batch.step(left)
    if nodes.are_as_they_were(batch):
        return []
    return [index for index in range(len(batch)) if len(batch.world(index).cable_names) > len(nodes.cables)]


class _Nodes:
    """How many nodes the cables of a batch have: what breaks off is a cable of its own."""

    def __init__(self, batch):
        self.cables = batch.world(0).cable_names
        self._parts = [('positions', name) for name in self.cables]
        self._shape = batch.observations(self._parts).shape

    def are_as_they_were(self, batch):
        try:
            return batch.observations(self._parts).shape == self._shape
        except ValueError:  # the worlds are no longer alike
            return False


def _fail_broken(sweep, motion, time_step, member, result):
    """Simulates a sample again, alone, for what World says of it that Batch does not."""
    position, scene = member
    world = World(scene, motion, sweep.loads_path)
    steps, of_rows = sweep.steps(time_step)
    worst, breaks = 0, []
    for start, stop in zip(of_rows, of_rows[1:] + [steps]):
        worst = max(worst, STATUSES.index(world.step(stop - start)))
        breaks = [event for event in world.events() if event.type == 'BROKE']
        if breaks:
            break
    result.worst[position] = worst
    result.fail(position, FAULT, f'at {breaks[0].time:g} s: {breaks[0].message}' if breaks else 'a cable broke')


def _check_shapes(batch, layout):
    for (name, field), shape in layout.shapes.items():
        found = tuple(np.shape(getattr(batch, field)(name))[1:])
        if found != shape:
            raise ValueError(rejected(f'{name}/{field}', 'x'.join(map(str, found)), 'x'.join(map(str, shape)) + ', as in the scene'))


def _run(sweep, layout, batch, time_step, positions, result):
    """Steps the batch to its end, with its rows put into the result. Returns the worst status of each world."""
    steps, of_rows = sweep.steps(time_step)
    _read(batch, layout, positions, result, slice(0, 1), is_record=False)
    worst = np.zeros(len(positions), dtype=np.int8)
    strides = set(np.diff(of_rows))
    if len(strides) == 1:
        stride = int(strides.pop())
        batch.step(of_rows[-1], record_every=stride, fields=sorted({field for name, field in layout.shapes}))
        worst = np.maximum(worst, batch.status)
        _read(batch, layout, positions, result, slice(1, layout.rows), is_record=True)
    else:
        for row in range(1, layout.rows):
            batch.step(of_rows[row] - of_rows[row - 1])
            worst = np.maximum(worst, batch.status)
            _read(batch, layout, positions, result, slice(row, row + 1), is_record=False)
    if steps > of_rows[-1]:
        batch.step(steps - of_rows[-1])
        worst = np.maximum(worst, batch.status)
    return worst


def _read(batch, layout, positions, result, rows, is_record):
    for name, field in layout.shapes:
        data = np.asarray(getattr(batch, field)(name))
        result.fields[name, field][positions, rows] = data if is_record else data[:, np.newaxis]
