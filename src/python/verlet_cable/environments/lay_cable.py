"""Laying a cable into clips on a table."""
import functools

import numpy

from verlet_cable.environments import arguments
from verlet_cable.environments.drawing import View
from verlet_cable.environments.environment import Environment, VectorEnvironment
from verlet_cable.environments.task import STEP_TIME, Seen, Task, chain, lengths, side_by_side
from verlet_cable.sim import Batch, Scene

LENGTH = 1.0       # [m]
SEGMENTS = 50
RADIUS = 0.00225   # [m]
TIME_STEP = 0.005  # [s]
# usb_cable of config/materials.yaml; but it does not break, whatever a hand does.
MATERIAL = {'linear_density': 0.026, 'radius': RADIUS, 'axial_stiffness': 8.4e4, 'bending_stiffness': 3.7e-4,
            'torsional_stiffness': 2.7e-4, 'axial_damping': 8.4, 'bending_damping': 3.7e-6, 'torsional_damping': 2.7e-6}

# A clip is two posts that stand on the table; the cable goes between them.
CLIPS = 3
GAP = 0.010                                # [m] between the posts
POST = 0.004                               # [m] their radius,
HEIGHT = 0.020                             # [m] and how high they are
PLACES = numpy.array([0.20, 0.37, 0.54])   # [m] of the clips along x
ASIDE = 0.04                               # [m] how far from the x axis they are at most,
TURNED = 0.3                               # [rad] and how much they are turned

SPEED = 0.4                                # [m/s] of the hand along each axis at an action of 1
LOW = numpy.array([-0.6, -0.4, RADIUS])    # [m] between which the hand stays,
HIGH = numpy.array([0.95, 0.4, 0.2])
REACH = 0.97 * LENGTH                      # [m] and how far it goes, along the clips that hold the cable
STRENGTH = 20.0                            # [N] a hand that is pulled by more
YIELDING = 0.1                             # [m/s] gives way

FOLD = 0.06                                # [m] radius; the cable begins folded, its ends side by side
END = 0.08                                 # [m] the hand is so far ahead of the plug at first
REST_STEPS = 100                           # time steps in which the cable comes to rest before an episode

LAYOUT_SEED = 21
LAYOUTS = 32
DEMONSTRATED_SPEED = 0.3                   # [m/s]


def folded():
    """Nodes of the cable at first, (n + 1, 3) [m]: from the origin along -x, around, and back."""
    straight = (LENGTH - numpy.pi * FOLD - END) / 2
    passed = (numpy.arange(SEGMENTS) + 0.5) * LENGTH / SEGMENTS
    return chain(numpy.pi - numpy.clip((passed - straight) / FOLD, 0, numpy.pi), LENGTH, RADIUS)


def posts(name, clip):
    """The obstacles that make a clip: x, y [m], and the unit vector along which it leads the cable."""
    x, y, along_x, along_y = clip.tolist()
    across = GAP / 2 + POST
    return [{'name': f'{name}_{side}', 'type': 'capsule', 'radius': POST, 'length': HEIGHT, 'friction': 0.1,
             'pose': [x - shift * along_y, y + shift * along_x, HEIGHT / 2 - POST, 0, 0, 0]}
            for side, shift in (('left', across), ('right', -across))]


def scene(clips):
    """A cable on a table, one end tied down at the origin, the other one in a hand; and clips (clips, 4)."""
    nodes = folded().tolist()
    return {
        'time_step': TIME_STEP,
        'materials': {'cable': MATERIAL},
        'cables': [{
            'name': 'cable', 'length': LENGTH, 'segments': SEGMENTS, 'material': 'cable',
            'initial': {'type': 'points', 'points': nodes},
            'attachments': [{'name': 'tie', 'at': 'start', 'offset': nodes[0]},
                            {'name': 'hand', 'at': 'end', 'frame': 'hand', 'initial_pose': nodes[-1] + [0, 0, 0]}],
        }],
        'obstacles': [{'name': 'table', 'type': 'plane', 'friction': 0.5}]
        + [post for i, clip in enumerate(clips) for post in posts(f'clip_{i}', clip)],
        'contact': {},
    }


def draw_layouts():
    """Where the clips are, (layouts, clips, 4): x, y [m], and the unit vector along which they lead the cable."""
    layouts = numpy.empty((LAYOUTS, CLIPS, 4))
    for k in range(LAYOUTS):
        aside, turned = numpy.random.default_rng([LAYOUT_SEED, k]).uniform(-1, 1, (2, CLIPS))
        layouts[k] = numpy.stack([PLACES, ASIDE * aside, numpy.cos(TURNED * turned), numpy.sin(TURNED * turned)], axis=1)
    return layouts


def begin_worlds(layouts):
    """A world for each layout, at rest."""
    worlds = Batch([Scene.from_dict(scene(clips)) for clips in layouts])
    worlds.step(REST_STEPS)
    return [worlds.world(i) for i in range(len(layouts))]


def held_by_clips(positions, clips):
    """Whether the center line of a cable passes between a clip's posts, below their tops: nodes
    (count, n + 1, 3) and clips (count, clips, 4) -> (count, clips)."""
    away = positions[:, None, :, :2] - clips[:, :, None, :2]
    along_x, along_y = clips[:, :, None, 2], clips[:, :, None, 3]
    along = away[..., 0] * along_x + away[..., 1] * along_y
    across = away[..., 1] * along_x - away[..., 0] * along_y
    height = numpy.broadcast_to(positions[:, None, :, 2], along.shape)
    before, after = along[..., :-1], along[..., 1:]
    crosses = (before < 0) != (after < 0)
    part = before / numpy.where(crosses, before - after, 1.0)
    across = across[..., :-1] + part * (across[..., 1:] - across[..., :-1])
    height = height[..., :-1] + part * (height[..., 1:] - height[..., :-1])
    return (crosses & (abs(across) < GAP / 2) & (height < HEIGHT)).any(axis=-1)


class LayCableTask(Task):
    cable = 'cable'
    nodes = SEGMENTS + 1
    option = 'layout'
    time_steps = round(STEP_TIME / TIME_STEP)

    def __init__(self):
        self.layouts = draw_layouts()
        hand = folded()[-1]
        super().__init__(begin_worlds(self.layouts), numpy.arange(LAYOUTS), numpy.tile(hand, (LAYOUTS, 1)), actions=3,
                         observations=6 * self.nodes + 6 + 5 * CLIPS)
        self.demonstrations = demonstrate(self.layouts, hand)

    def move(self, hand, actions, seen):
        way = give_way(actions * SPEED, seen.force) * STEP_TIME
        fixed, free = self._free_length(seen.info['held'], seen.info['layout'])
        away = numpy.clip(hand + way, LOW, HIGH) - fixed
        distance = lengths(away)
        # A clip that begins to hold the cable does not move the hand.
        allowed = numpy.maximum(free, lengths(hand - fixed))
        return fixed + away * (numpy.minimum(distance, allowed) / numpy.maximum(distance, RADIUS))[:, None]

    def _free_length(self, held, layout):
        """Where the last clip that holds a cable is, or where it is tied, (count, 3), and how far from there its hand may be, (count,) [m]."""
        fixed = numpy.zeros((len(held), 3))
        free = numpy.full(len(held), REACH)
        for i in range(CLIPS):
            clip = numpy.zeros_like(fixed)
            clip[:, :2] = self.layouts[layout, i, :2]
            free = free - numpy.where(held[:, i], lengths(clip - fixed), 0.0)
            fixed = numpy.where(held[:, i, None], clip, fixed)
        return fixed, free

    def poses(self, hand):
        poses = numpy.zeros((*hand.shape[:-1], 7))
        poses[..., :3] = hand
        poses[..., 6] = 1
        return poses

    def look(self, positions, velocities, force, hand, variants):
        clips = self.layouts[variants]
        held = held_by_clips(positions, clips)
        observation = side_by_side(positions, velocities, hand, force, clips, held.astype(float))
        return Seen(observation, force, held.sum(axis=1).astype(float), {'held': held, 'layout': variants.copy()})

    def draw(self, positions, hand, variant):
        view = View((-0.5, -0.3), (1.0, 0.3), width=640)
        for x, y, *direction in self.layouts[variant]:
            across = numpy.array([-direction[1], direction[0]]) * (GAP / 2 + POST)
            for sign in (1, -1):
                view.disc((x, y) + sign * across, POST, (150, 60, 40))
        view.polyline(positions[:, :2], 2 * RADIUS, (30, 30, 30))
        view.disc(hand[:2], 0.015, (40, 80, 160))
        return view.pixels


def give_way(velocity, force):
    """The velocity [m/s] of hands that are pulled by a force [N], (count, 3) each: those that are pulled by more than they are
    strong do not go against it, but give way."""
    pull = lengths(force)
    along = force / numpy.maximum(pull, 1e-9)[:, None]
    against = numpy.minimum((velocity * along).sum(axis=1), 0.0)
    return numpy.where((pull > STRENGTH)[:, None], velocity + (YIELDING - against)[:, None] * along, velocity)


def demonstrate(layouts, hand):
    """Actions that lead the cable's end through the clips, (layouts, steps, 3)."""
    all_actions = []
    for clips in layouts:
        actions = []
        here = hand
        for goal in waypoints(clips):
            way = goal - here
            steps = int(numpy.ceil(abs(way).max() / (DEMONSTRATED_SPEED * STEP_TIME)))
            actions += [way / (steps * SPEED * STEP_TIME)] * steps
            here = goal
        all_actions.append(actions)
    shown = numpy.zeros((len(layouts), max(map(len, all_actions)), 3))
    for k, actions in enumerate(all_actions):
        shown[k, :len(actions)] = actions
    return shown


def waypoints(clips):
    """Where the hand passes: down before the first clip, through all, and a little up behind the last."""
    before, behind, low, high = 0.05, 0.06, 0.006, 0.05
    first, along = clips[0, :2], clips[0, 2:]
    points = [[*(first - before * along), high]]
    for clip in clips:
        points += [[*(clip[:2] - before * clip[2:]), low], [*(clip[:2] + behind * clip[2:]), low]]
    return numpy.array(points)


@functools.lru_cache(maxsize=1)
def make_task():
    return LayCableTask()


class LayCable(Environment):
    """Lay a cable, plugged in at one end, into three clips on a table by leading its other end.

    Action (3,), each from -1 to 1: velocity of the hand along x, y, z [0.4 m/s].
    """

    def __init__(self, render_mode=None, max_episode_steps=400):
        super().__init__(make_task(), max_episode_steps, render_mode)


class LayCableVector(VectorEnvironment):
    """`num_envs` worlds of LayCable, on `threads` threads; 0: as many as there are cores."""

    def __init__(self, num_envs=1, render_mode=None, max_episode_steps=400, threads=0):
        super().__init__(make_task(), num_envs, max_episode_steps, render_mode, threads)
