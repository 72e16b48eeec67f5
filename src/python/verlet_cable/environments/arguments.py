"""Reads arguments. Raises ValueError with the name of the argument, the value given and what is allowed."""
import math
import numbers

import numpy

SHOWN = 5  # wrong numbers of one array
MOST = 1000000  # of anything that is counted, as sim.Batch has it of worlds
MOST_THREADS = 1024  # likewise


def read_count(name, value):
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or not 1 <= value <= MOST:
        raise ValueError(f'{name}: {value!r}; allowed: whole numbers from 1 to {MOST}')
    return int(value)


def read_limit(name, value):
    """None, which is infinity, or a count."""
    if value is None:
        return math.inf
    try:
        return read_count(name, value)
    except ValueError as error:
        raise ValueError(f'{error}, or None') from None


def read_threads(value):
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or not 0 <= value <= MOST_THREADS:
        raise ValueError(f'threads: {value!r}; allowed: 0, as many as there are cores, to {MOST_THREADS}')
    return int(value)


def read_seed(name, value):
    """None, or a whole number from 0."""
    if value is None:
        return None
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < 0:
        raise ValueError(f'{name}: {value!r}; allowed: None or whole numbers from 0')
    return int(value)


def read_seeds(value, count):
    """One seed per world: as given, or all None, or counted up from a number."""
    if value is None or isinstance(value, numbers.Integral):
        first = read_seed('seed', value)
        return [first if first is None else first + i for i in range(count)]
    allowed = f'None, a whole number from 0, or {count} of them, one a world'
    if isinstance(value, (str, bytes)) or not numpy.iterable(value):
        raise ValueError(f'seed: {value!r}; allowed: {allowed}')
    seeds = list(value)
    if len(seeds) != count:
        raise ValueError(f'seed: {len(seeds)} numbers; allowed: {allowed}')
    return [read_seed(f'seed[{i}]', seed) for i, seed in enumerate(seeds)]


def read_render_mode(value, modes):
    if value is not None and value not in modes:
        raise ValueError(f'render_mode: {value!r}; allowed: None, {", ".join(map(repr, modes))}')
    return value


def read_choice(name, value, allowed):
    if value not in list(allowed):
        raise ValueError(f'{name}: {value!r}; allowed: {", ".join(map(repr, allowed))}')
    return value


def read_mode(name, value, modes):
    """A member of an enumeration, or its value."""
    for mode in modes:
        if value == mode or value == mode.value:
            return mode
    raise ValueError(f'{name}: {value!r}; allowed: {", ".join(str(mode) for mode in modes)}')


def read_action(name, value, space):
    """An array in a space, as float64."""
    allowed = f'real numbers, of shape {space.shape}'
    try:
        array = numpy.asarray(value)
    except (TypeError, ValueError):
        raise ValueError(f'{name}: {value!r}; allowed: {allowed}') from None
    if array.dtype.kind not in 'biuf':
        raise ValueError(f'{name}: {value!r}; allowed: {allowed}')
    array = array.astype(float)
    if array.shape != space.shape:
        raise ValueError(f'{name}: shape {array.shape}; allowed: {space.shape}')
    wrong = numpy.argwhere(~((array >= space.low) & (array <= space.high)))
    if len(wrong) > 0:
        texts = [f'{name}[{", ".join(map(str, index))}]: {array[tuple(index)]}' for index in wrong[:SHOWN]]
        more = f', and {len(wrong) - SHOWN} more' if len(wrong) > SHOWN else ''
        raise ValueError(f'{", ".join(texts)}{more}; allowed: {space.low.min()} to {space.high.max()}')
    return array


def read_options(value, allowed):
    """A dict that has only allowed keys."""
    if value is None:
        return {}
    if not isinstance(value, dict):
        raise ValueError(f'options: {value!r}; allowed: None or a dict')
    unknown = [key for key in value if key not in allowed]
    if unknown:
        raise ValueError(f'options: {", ".join(map(repr, unknown))}; allowed: {", ".join(map(repr, allowed))}')
    return value


def read_index(name, value, count):
    """A whole number from 0 to below `count`."""
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or not 0 <= value < count:
        raise ValueError(f'{name}: {value!r}; allowed: whole numbers from 0 to {count - 1}')
    return int(value)


def read_indices(name, value, worlds, count):
    """One index for all worlds, or one per world, (worlds,)."""
    if isinstance(value, numbers.Integral):
        return numpy.full(worlds, read_index(name, value, count))
    values = list(value) if numpy.iterable(value) else [value]
    if len(values) != worlds:
        raise ValueError(f'{name}: {value!r}; allowed: a number, or {worlds} numbers, one a world')
    return numpy.array([read_index(f'{name}[{i}]', each, count) for i, each in enumerate(values)])


def read_mask(name, value, worlds):
    """Selects some of the worlds, (worlds,) bool."""
    mask = numpy.asarray(value)
    if mask.dtype != bool or mask.shape != (worlds,) or not mask.any():
        raise ValueError(f'{name}: {value!r}; allowed: bool of shape ({worlds},), at least one of them True')
    return mask.copy()
