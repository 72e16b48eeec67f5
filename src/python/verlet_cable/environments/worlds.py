"""The worlds of an environment: a batch whose hands are moved by actions, and which begin anew one by one."""
import numpy

from verlet_cable.sim import Batch

FAULT = 6  # of Batch.status: the simulation of that world had to stop


class Worlds:
    """`count` worlds of a task, stepped together. A task says what is in them and what is to be done: see Task."""

    def __init__(self, task, count, threads=0):
        self.task = task
        self.starts = task.copy_starts()
        self.batch = Batch(self.starts[0], count, threads=threads)
        self.variants = numpy.zeros(count, dtype=int)
        self.hand = task.hand_of[self.variants]
        self.seen = None

    def begin(self, mask, variants):
        """The worlds of a mask (count,) begin anew, each with the variant of the task that `variants` (count,) says."""
        self.variants = numpy.where(mask, variants, self.variants)
        self.hand = numpy.where(mask[:, None], self.task.hand_of[self.variants], self.hand)
        starts = self.task.start_of[self.variants]
        for start in numpy.unique(starts[mask]):
            self.batch.set_world(mask & (starts == start), self.starts[start])

    def move(self, actions):
        """Moves the hands by actions (count, k) during a step of the task; returns the worlds that had to stop, (count,)."""
        steps = self.task.time_steps
        way = self.task.move(self.hand, actions, self.seen) - self.hand
        path = self.hand[:, None] + numpy.linspace(1 / steps, 1, steps)[:, None] * way[:, None]
        self.hand = path[:, -1]
        self.batch.set_frames('hand', self.task.poses(path))
        self.batch.step(steps)
        return self.batch.status == FAULT

    def look(self):
        """What is seen of the worlds and earned in them now, a Seen."""
        cable, numbers = self.task.cable, 3 * self.task.nodes
        read = self.batch.observations([('positions', cable), ('velocities', cable), ('wrench', 'hand'),
                                        *(('contact_force', name) for name in self.task.touched)])
        positions, velocities, wrenches = numpy.split(read, [numbers, 2 * numbers], axis=1)
        shape = (len(read), self.task.nodes, 3)
        forces = wrenches.reshape(len(read), 1 + len(self.task.touched), 6)[:, :, :3]
        self.seen = self.task.look(positions.reshape(shape), velocities.reshape(shape), forces[:, 0], forces[:, 1:], self.hand,
                                   self.variants)
        return self.seen

    def positions(self):
        """Nodes of the cables, (count, n + 1, 3) [m]."""
        return self.batch.positions(self.task.cable)
