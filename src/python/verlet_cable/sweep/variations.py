"""What is varied, and how: sample k is a function of the sweep's seed and of k alone."""
import math
from statistics import NormalDist

import numpy as np

from ..wrong_arguments import meant
from .errors import rejected
from .text_yaml import number, shown, with_numbers

_MOST_OPTIONS = 10_000  # of a choice: each may be tried before a sweep begins
DISTRIBUTIONS = ('uniform', 'log_uniform', 'normal', 'choice')


class Variation:
    """One distribution: `kind`, and its `parameters`: numbers, or what a choice chooses from."""

    def __init__(self, kind, parameters):
        self.kind = kind
        self.parameters = parameters

    @property
    def is_choice(self):
        return self.kind == 'choice'

    @property
    def is_numeric(self):
        """Whether what is drawn is a number: all that are no choices, and choices from numbers."""
        return not self.is_choice or all(number(option) is not None for option in self.parameters)

    def draw(self, generator):
        """One draw: a number, or the index of what was chosen. Takes one number from the generator, whose stream no release of NumPy
        changes; transformed here for the same reason."""
        if self.kind == 'normal':
            mean, deviation = self.parameters
            return mean + deviation * _standard_normal(generator.random())
        fraction = generator.random()
        if self.is_choice:
            return int(fraction * len(self.parameters))
        low, high = self.parameters
        if self.kind == 'uniform':
            return min(low + fraction * (high - low), high)
        return min(max(math.exp(math.log(low) + fraction * (math.log(high) - math.log(low))), low), high)

    def examples(self):
        """Values for the scene from the whole of what may be drawn: the ends, or all to choose from."""
        if self.is_choice:
            return self.parameters
        first, second = self.parameters
        middle = math.sqrt(first) * math.sqrt(second) if self.kind == 'log_uniform' else first + (second - first) / 2
        return [repr(value) for value in ([first] if self.kind == 'normal' else [first, second, middle])]

    def scene_value(self, drawn):
        """What is put into the scene for a draw."""
        return self.parameters[drawn] if self.is_choice else repr(drawn)

    def stored_value(self, drawn):
        """What the store keeps of a draw: the number, or the index of a choice that is none."""
        return number(self.parameters[drawn]) if self.is_choice and self.is_numeric else drawn


def read_variation(key, value, errors):
    """The variation at a key of SWEEP.yaml, or None."""
    if not isinstance(value, dict) or len(value) != 1 or next(iter(value)) not in DISTRIBUTIONS:
        near = meant(next(iter(value)), DISTRIBUTIONS) if isinstance(value, dict) and len(value) == 1 else ''
        errors.append(rejected(key, shown(value) + near, 'one of ' + ', '.join(f'{name}: [...]' for name in DISTRIBUTIONS)))
        return None
    kind, parameters = next(iter(value.items()))
    key = f'{key}.{kind}'
    if kind == 'choice':
        if not isinstance(parameters, list) or not parameters:
            errors.append(rejected(key, shown(parameters), 'a list of at least one value'))
            return None
        if len(parameters) > _MOST_OPTIONS:
            errors.append(rejected(key, f'{len(parameters)} values', f'at most {_MOST_OPTIONS}'))
            return None
        return Variation(kind, with_numbers(parameters))
    numbers = [number(entry) for entry in parameters] if isinstance(parameters, list) else []
    allowed, is_allowed = {
        'uniform': ('[low, high], finite, low < high', lambda low, high: low < high and math.isfinite(high - low)),
        'log_uniform': ('[low, high], finite, 0 < low < high', lambda low, high: 0 < low < high),
        'normal': ('[mean, standard deviation], finite, deviation > 0', lambda mean, deviation: deviation > 0),
    }[kind]
    if len(numbers) != 2 or any(entry is None or not math.isfinite(entry) for entry in numbers) or not is_allowed(*numbers):
        errors.append(rejected(key, shown(parameters), allowed))
        return None
    return Variation(kind, numbers)


def draw_sample(variations, seed, index):
    """{key: draw} of sample `index`: one number of its own generator for each key, in the order of the keys' names."""
    generator = np.random.Generator(np.random.Philox(np.random.SeedSequence([seed, index])))
    return {key: variations[key].draw(generator) for key in sorted(variations)}


def _standard_normal(fraction):
    """The inverse of the normal distribution's cumulative function; `fraction` in [0, 1)."""
    return NormalDist().inv_cdf(max(fraction, 2.0**-54))
