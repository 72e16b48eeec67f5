"""What an environment needs to know of what is to be done in it."""
import threading
from typing import Dict, NamedTuple

import numpy

from verlet_cable.environments.interface import Box

STEP_TIME = 0.02   # [s] of an environment's step
REST_STEPS = 100  # time steps in which a cable comes to rest before an episode
YIELDING = 0.1     # [m/s] at which hands give way that are not strong enough


class Seen(NamedTuple):
    """What is seen of worlds, an array each that begins with an axis of the worlds."""
    observation: numpy.ndarray        # (count, k)
    force: numpy.ndarray              # (count, 3) [N] of the cables on the hands
    reward: numpy.ndarray             # (count,)
    info: Dict[str, numpy.ndarray]    # (count, ...) each


class Task:
    """A scene with a cable and a frame `hand` that moves one of its ends, in variants that an episode draws from.

    Where a hand is, its coordinates, is for the task to say: `poses` makes poses of them.
    `demonstrations` (variants, steps, actions): actions that do it, from the beginning of an episode.
    Tasks are constant: environments share them.
    """
    cable = None       # its name
    nodes = None       # how many it has
    touched = ()       # names of obstacles whose contact forces are seen
    option = None      # the key of reset's options by which a variant is asked for
    time_steps = None  # of the scene, in a step

    def __init__(self, starts, start_of, hand_of, actions, observations):
        self.start_of = constant(start_of)  # (variants,) which of the starts each variant begins with
        self.hand_of = constant(hand_of)    # (variants, coordinates) where the hand is then
        self._starts = starts               # Worlds
        self._lock = threading.Lock()       # of the starts: one thread at a time may copy them
        self._actions = actions
        self._observations = observations

    def __deepcopy__(self, memo):
        return self

    def __getstate__(self):
        return {name: value for name, value in vars(self).items() if name != '_lock'}

    def __setstate__(self, state):
        vars(self).update(state)
        self._lock = threading.Lock()

    def copy_starts(self):
        """Worlds to begin with."""
        with self._lock:
            return [world.copy() for world in self._starts]

    def make_action_space(self):
        return Box(-1.0, 1.0, (self._actions,), dtype=numpy.float64)

    def make_observation_space(self):
        return Box(-numpy.inf, numpy.inf, (self._observations,), dtype=numpy.float64)

    @property
    def variants(self):
        return len(self.start_of)

    def move(self, hand, actions, seen):
        """Where hands (count, coordinates) are after a step, by actions (count, k) and by what was seen before."""
        raise NotImplementedError

    def poses(self, hand):
        """(..., coordinates) -> (..., 7): x, y, z [m], qx, qy, qz, qw."""
        raise NotImplementedError

    def look(self, positions, velocities, force, contacts, hand, variants):
        """What is seen of worlds: nodes (count, n + 1, 3) [m], their velocities [m/s], forces on the hands (count, 3) [N] and on
        what is `touched` (count, k, 3) [N], hands (count, coordinates), variants (count,)."""
        raise NotImplementedError

    def draw(self, positions, hand, variant):
        """A picture of one world, (rows, columns, 3) uint8."""
        raise NotImplementedError


def constant(array):
    """The array, which nobody may change from now on."""
    array.setflags(write=False)
    return array


def side_by_side(*arrays):
    """Arrays (count, ...) as one, (count, k)."""
    return numpy.concatenate([array.reshape(len(array), -1) for array in arrays], axis=1)


def dots(a, b):
    """Scalar products of vectors (..., 2 or 3) -> (...), by the same operations for any number of worlds."""
    products = a * b
    total = products[..., 0]
    for i in range(1, products.shape[-1]):
        total = total + products[..., i]
    return total


def lengths(vectors):
    """(..., 2 or 3) -> (...)."""
    return numpy.sqrt(dots(vectors, vectors))


def give_way(velocity, force, strength):
    """The velocity [m/s] of hands that are pulled by a force [N], (count, 3) each: those that are pulled by more than
    their strength [N] do not go against it, but give way."""
    pull = lengths(force)
    along = force / numpy.maximum(pull, 1e-9)[:, None]
    against = numpy.minimum(dots(velocity, along), 0.0)
    return numpy.where((pull > strength)[:, None], velocity + (YIELDING - against)[:, None] * along, velocity)


def chain(headings, length, height):
    """Nodes (n + 1, 3) of a chain from the z axis on, at one height [m]; its links point along headings (n,) [rad]."""
    links = length / len(headings) * numpy.stack([numpy.cos(headings), numpy.sin(headings)], axis=1)
    nodes = numpy.full((len(headings) + 1, 3), height)
    nodes[:, :2] = numpy.concatenate([numpy.zeros((1, 2)), numpy.cumsum(links, axis=0)])
    return nodes
