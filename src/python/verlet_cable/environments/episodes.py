"""Episodes of a task in worlds that are stepped together."""
import numpy

from verlet_cable.environments import arguments
from verlet_cable.environments.worlds import Worlds


class Episodes:
    """How long they have lasted, and which are over."""

    def __init__(self, task, count, threads, max_episode_steps):
        self.task = task
        self.worlds = Worlds(task, count, threads)
        self.max_episode_steps = arguments.read_limit('max_episode_steps', max_episode_steps)
        self.steps = numpy.zeros(count, dtype=int)
        self.begun = numpy.zeros(count, dtype=bool)
        self.over = numpy.ones(count, dtype=bool)

    def begin(self, mask, generators, variants=None):
        """Begins an episode in the worlds of a mask (count,), of the variants (count,) of the task, or of such as the worlds'
        generators draw; returns what is seen of all worlds."""
        if variants is None:
            variants = self.worlds.variants.copy()
            for world in numpy.flatnonzero(mask):
                variants[world] = generators[world].integers(self.task.variants)
        self.worlds.begin(mask, variants)
        self.steps[mask] = 0
        self.begun |= mask
        self.over &= ~mask
        return self.worlds.look()

    def step_all(self, actions):
        """A step of all episodes; returns what is seen, and where an episode is terminated and truncated."""
        terminated = self.worlds.move(actions)
        self.steps += 1
        truncated = self.steps >= self.max_episode_steps
        self.over = terminated | truncated
        return self.worlds.look(), terminated, truncated

    def step(self, actions, generators):
        """A step of the episodes that are not over, and the first moment of new ones instead of those that are; returns what is
        seen, rewards, and where an episode is terminated and truncated."""
        anew = self.over.copy()
        terminated = self.worlds.move(actions) & ~anew
        self.steps += 1
        seen = self.begin(anew, generators) if anew.any() else self.worlds.look()
        truncated = self.steps >= self.max_episode_steps
        self.over = terminated | truncated
        return seen, numpy.where(anew, 0.0, seen.reward), terminated, truncated

    def draw(self, world):
        """(rows, columns, 3) uint8."""
        return self.task.draw(self.worlds.positions()[world], self.worlds.hand[world], self.worlds.variants[world])
