"""The classes of Gymnasium's interface: its own if version 1.1 or newer is installed, else replacements with what these environments
need, so that the same code runs with and without it."""
import enum

import numpy

from verlet_cable.environments.box import Box as PlainBox

try:
    import gymnasium
    from gymnasium import Env
    from gymnasium.spaces import Box
    from gymnasium.vector import AutoresetMode, VectorEnv
except ImportError:
    gymnasium = None
    Box = PlainBox

    class AutoresetMode(enum.Enum):
        """When a vector environment resets the worlds whose episodes have ended."""
        NEXT_STEP = 'NextStep'
        SAME_STEP = 'SameStep'
        DISABLED = 'Disabled'

    class _Interface:
        metadata = {'render_modes': []}
        render_mode = None
        spec = None
        _np_random = None
        _np_random_seed = None

        def reset(self, *, seed=None, options=None):
            if seed is not None:
                self._seed(seed)

        def _seed(self, seed=None):
            sequence = numpy.random.SeedSequence(seed)
            self._np_random, self._np_random_seed = numpy.random.default_rng(sequence), sequence.entropy

        @property
        def unwrapped(self):
            return self

        @property
        def np_random(self):
            if self._np_random is None:
                self._seed()
            return self._np_random

        @np_random.setter
        def np_random(self, generator):
            self._np_random, self._np_random_seed = generator, -1

        @property
        def np_random_seed(self):
            if self._np_random_seed is None:
                self._seed()
            return self._np_random_seed

    class Env(_Interface):
        """Replaces gymnasium.Env."""

        def __enter__(self):
            return self

        def __exit__(self, *error):
            self.close()
            return False

        def has_wrapper_attr(self, name):
            return hasattr(self, name)

        def get_wrapper_attr(self, name):
            return getattr(self, name)

        def set_wrapper_attr(self, name, value, *, force=True):
            if force or hasattr(self, name):
                setattr(self, name, value)
                return True
            return False

        def __str__(self):
            return f'<{type(self).__name__} instance>'

    class VectorEnv(_Interface):
        """Replaces gymnasium.vector.VectorEnv."""
        closed = False

        def close(self, **options):
            if not self.closed:
                self.close_extras(**options)
                self.closed = True

        def __str__(self):
            return f'{type(self).__name__}(num_envs={self.num_envs})'


def batch_box(box, count):
    """The space of `count` arrays of a space, stacked along the first axis."""
    return Box(numpy.broadcast_to(box.low, (count, *box.shape)), numpy.broadcast_to(box.high, (count, *box.shape)), dtype=box.dtype)
