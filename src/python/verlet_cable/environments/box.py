"""The space of arrays between two bounds: replaces `gymnasium.spaces.Box` if Gymnasium is not installed."""
import numpy


class Box:
    """The arrays of one shape and dtype with `low` <= array <= `high`. The bounds are arrays of that shape and may be infinite."""

    def __init__(self, low, high, shape=None, dtype=numpy.float64, seed=None):
        self.dtype = numpy.dtype(dtype)
        self.shape = tuple(shape) if shape is not None else numpy.broadcast(low, high).shape
        self.low = numpy.broadcast_to(numpy.asarray(low, dtype=self.dtype), self.shape)
        self.high = numpy.broadcast_to(numpy.asarray(high, dtype=self.dtype), self.shape)
        self.seed(seed)

    def seed(self, seed=None):
        """Seeds the random numbers of sample(); None: with random data of the operating system."""
        self._np_random = numpy.random.default_rng(seed)
        return seed

    def sample(self):
        """A random array: uniform between two finite bounds, exponential from a single finite one, else normally distributed."""
        below, above = numpy.isfinite(self.low), numpy.isfinite(self.high)
        both = below & above
        drawn = self._np_random.normal(size=self.shape)
        even = self._np_random.uniform(numpy.where(both, self.low, 0), numpy.where(both, self.high, 1))
        exponential = self._np_random.exponential(size=self.shape)
        drawn = numpy.where(both, even, drawn)
        drawn = numpy.where(below & ~above, self.low + exponential, drawn)
        return numpy.where(above & ~below, self.high - exponential, drawn).astype(self.dtype)

    def contains(self, x):
        """Whether a value is an array in the space; NaN never is."""
        return (isinstance(x, numpy.ndarray) and numpy.can_cast(x.dtype, self.dtype) and x.shape == self.shape
                and bool(numpy.all(x >= self.low) and numpy.all(x <= self.high)))

    __contains__ = contains

    def __eq__(self, other):
        return (isinstance(other, Box) and self.shape == other.shape and self.dtype == other.dtype
                and numpy.array_equal(self.low, other.low) and numpy.array_equal(self.high, other.high))

    def __repr__(self):
        return f'Box({self.low.min(initial=numpy.inf)}, {self.high.max(initial=-numpy.inf)}, {self.shape}, {self.dtype})'
