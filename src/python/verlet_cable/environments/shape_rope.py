"""Shaping a rope on a table with one hand."""
import functools

import numpy

from verlet_cable.environments import arguments
from verlet_cable.environments.drawing import View
from verlet_cable.environments.environment import Environment, VectorEnvironment
from verlet_cable.environments.interface import AutoresetMode
from verlet_cable.environments.task import REST_STEPS, STEP_TIME, Seen, Task, chain, constant, give_way, lengths, side_by_side
from verlet_cable.environments.worlds import Worlds
from verlet_cable.sim import Scene, World

LENGTH = 1.0       # [m]
SEGMENTS = 50
RADIUS = 0.003     # [m]
TIME_STEP = 0.005  # [s]
# nylon_rope_6mm of config/materials.yaml; but it does not break, whatever a hand does.
MATERIAL = {'linear_density': 0.020, 'radius': RADIUS, 'axial_stiffness': 2.1e4, 'bending_stiffness': 2.0e-4,
            'torsional_stiffness': 1.5e-4, 'axial_damping': 2.1, 'bending_damping': 2.0e-6, 'torsional_damping': 1.5e-6}

SPEED = numpy.array([0.4, 0.4, 2.0])   # [m/s], [m/s], [rad/s] of the hand at an action of 1
LOW = numpy.array([0.25, -0.5, -2.5])  # [m], [m], [rad] between which the hand stays,
HIGH = numpy.array([0.95, 0.5, 2.5])
REACH = 0.95 * LENGTH                  # [m] and how far from the anchor;
LIFT = 3.2 * RADIUS                    # [m] its height, above a rope that lies there
STRENGTH = 20.0                        # [N] that a hand holds against

EPISODE_STEPS = 250

BOW = 1.2  # [rad] the rope begins as an arc of a circle that turns by twice as much

GOAL_SEED = 20
GOAL_MOVES = 4        # a goal is where so many moves of the hand lead, each at a velocity drawn at random
GOAL_MOVE_STEPS = 30
GOAL_REST_STEPS = 10  # and then none


def bow():
    """Nodes of the rope at first, (n + 1, 3) [m]."""
    headings = BOW * (1 - (2 * numpy.arange(SEGMENTS) + 1) / SEGMENTS)
    return chain(headings, LENGTH, RADIUS)


def scene():
    """A rope on a table, one end pinned at the origin, the other one in a hand."""
    nodes = bow().tolist()
    return {
        'time_step': TIME_STEP,
        'materials': {'rope': MATERIAL},
        'cables': [{
            'name': 'rope', 'length': LENGTH, 'segments': SEGMENTS, 'material': 'rope',
            'initial': {'type': 'points', 'points': nodes},
            'attachments': [{'name': 'anchor', 'at': 'start', 'offset': nodes[0]},
                            {'name': 'hand', 'at': 'end', 'frame': 'hand', 'type': 'clamp',
                             'initial_pose': [*nodes[-1][:2], LIFT, 0, 0, -BOW]}],
        }],
        'obstacles': [{'name': 'table', 'type': 'plane', 'friction': 0.5}],
        'contact': {},
    }


class ShapeRopeTask(Task):
    """The goals are shapes of the rope after random motions of the hand, from the same start as that of every episode."""
    cable = 'rope'
    nodes = SEGMENTS + 1
    touched = ('table',)
    option = 'goal'
    time_steps = round(STEP_TIME / TIME_STEP)

    def __init__(self, goals):
        numbers = 3 * self.nodes
        world = World(Scene.from_dict(scene()))
        world.step(REST_STEPS)
        super().__init__([world], numpy.zeros(goals, dtype=int), numpy.tile([*bow()[-1, :2], -BOW], (goals, 1)), actions=3,
                         observations=3 * numbers + 9)
        self.demonstrations = constant(self._draw_actions(goals))
        self.goals = numpy.zeros((goals, self.nodes, 3))
        self.goals = constant(self._simulate_goals())

    def _draw_actions(self, goals):
        """(goals, steps, 3): goal k is the same however many there are."""
        moves = [numpy.random.default_rng([GOAL_SEED, k]).uniform(-1, 1, (GOAL_MOVES, 3)) for k in range(goals)]
        rest = numpy.zeros((goals, GOAL_REST_STEPS, 3))
        return numpy.concatenate([numpy.repeat(moves, GOAL_MOVE_STEPS, axis=1), rest], axis=1)

    def _simulate_goals(self):
        """(goals, n + 1, 3) [m]."""
        worlds = Worlds(self, self.variants)
        worlds.look()
        for actions in self.demonstrations.swapaxes(0, 1):
            worlds.move(actions)
            worlds.look()
        return worlds.positions()

    def move(self, hand, actions, seen):
        velocity = actions * SPEED
        velocity[:, :2] = give_way(velocity[:, :2], seen.force[:, :2], STRENGTH)
        moved = numpy.clip(hand + velocity * STEP_TIME, LOW, HIGH)
        distance = lengths(moved[:, :2])
        moved[:, :2] *= (REACH / numpy.maximum(distance, REACH))[:, None]
        return moved

    def poses(self, hand):
        poses = numpy.zeros((*hand.shape[:-1], 7))
        poses[..., :2] = hand[..., :2]
        poses[..., 2] = LIFT
        poses[..., 5] = numpy.sin(hand[..., 2] / 2)
        poses[..., 6] = numpy.cos(hand[..., 2] / 2)
        return poses

    def look(self, positions, velocities, force, contacts, hand, variants):
        goal = self.goals[variants]
        distance = lengths(positions - goal).mean(axis=1)
        return Seen(side_by_side(positions, velocities, hand, force, goal, contacts), force, -distance,
                    {'distance': distance, 'goal': variants.copy()})

    def draw(self, positions, hand, variant):
        view = View((-0.1, -0.6), (1.1, 0.6))
        view.polyline(self.goals[variant][:, :2], 2 * RADIUS, (150, 190, 150))
        view.polyline(positions[:, :2], 2 * RADIUS, (190, 90, 30))
        view.disc(positions[0, :2], 0.012, (60, 60, 60))
        view.disc(hand[:2], 0.018, (40, 80, 160))
        return view.pixels


@functools.lru_cache(maxsize=4)
def make_task(goals):
    return ShapeRopeTask(goals)


class ShapeRope(Environment):
    """Shape a rope on a table. One end of the rope is pinned, and a hand holds the other end.

    Action (3,), each from -1 to 1: velocity of the hand along x and y, in units of 0.4 m/s, and its angular velocity about z, in
    units of 2 rad/s. The hand stays between 0.25 m and 0.95 m in x, within 0.5 m in y and 2.5 rad, and within 0.95 m of the pin. If
    the force on it at the end of a step is above 20 N, it yields in the next step; within a step, the force is not limited.
    Observation (468,) float64: nodes (51, 3) [m] from the pin on, their velocities (51, 3) [m/s], the hand's x, y [m] and angle
    [rad], the force on the hand (3,) [N], the nodes of the goal (51, 3) [m], and the force of the rope on the table (3,) [N].
    Reward: minus the mean distance of the nodes from those of the goal [m].
    Info: `distance` [m]; `goal`, its index. Options of reset: `goal`, an index below `goals`; default: random.
    Episodes are truncated after `max_episode_steps` steps of 0.02 s (never if it is None), and terminated if the simulation
    had to stop.
    """

    def __init__(self, render_mode=None, max_episode_steps=EPISODE_STEPS, goals=64):
        super().__init__(make_task(arguments.read_count('goals', goals)), max_episode_steps, render_mode)


class ShapeRopeVector(VectorEnvironment):
    """`num_envs` worlds of ShapeRope, on `threads` threads; 0: one per core. `autoreset_mode`: see VectorEnvironment."""

    def __init__(self, num_envs=1, render_mode=None, max_episode_steps=EPISODE_STEPS, goals=64, threads=0,
                 autoreset_mode=AutoresetMode.NEXT_STEP):
        super().__init__(make_task(arguments.read_count('goals', goals)), num_envs, max_episode_steps, render_mode, threads,
                         autoreset_mode)
