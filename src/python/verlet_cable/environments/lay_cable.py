"""Laying a cable into clips on a table."""
import functools

import numpy

from verlet_cable.environments import arguments
from verlet_cable.environments.drawing import View
from verlet_cable.environments.environment import Environment, VectorEnvironment
from verlet_cable.environments.interface import AutoresetMode
from verlet_cable.environments.posts import move_beside
from verlet_cable.environments.task import (REST_STEPS, STEP_TIME, Seen, Task, chain, constant, dots, give_way, lengths,
                                            side_by_side)
from verlet_cable.sim import Batch, Scene

LENGTH = 0.6       # [m]
SEGMENTS = 50
RADIUS = 0.002     # [m]
TIME_STEP = 0.005  # [s]
# A tube for compressed air of polyurethane, 4 mm outside and 2.5 mm inside: 7.7 mm^2, 1200 kg/m^3, 21 MPa (90 Shore A, see
# config/materials.yaml, and there for damping), Poisson's ratio 0.48.
MATERIAL = {'linear_density': 0.0092, 'radius': RADIUS, 'axial_stiffness': 161.0, 'bending_stiffness': 2.2e-4,
            'torsional_stiffness': 1.5e-4, 'axial_damping': 0.016, 'bending_damping': 2.2e-6, 'torsional_damping': 1.5e-6}

# A clip is two posts that stand on the table; the cable goes between them. Segments are so short, and hands stay so far from
# posts, that a post does not get between a hand and the node next to it.
CLIPS = 3
GAP = 0.008                                # [m] between the posts
POST = 0.005                               # [m] their radius,
HEIGHT = 0.020                             # [m] and how high they are
PLACES = numpy.array([0.12, 0.22, 0.32])   # [m] of the clips along x
ASIDE = 0.025                              # [m] how far from the x axis they are at most,
TURNED = 0.3                               # [rad] and how much they are turned

SPEED = 0.25                               # [m/s] of the hand along each axis at an action of 1
LOW = numpy.array([-0.35, -0.25, 5.2 * RADIUS])  # [m] between which the hand stays: above a cable that lies across itself,
HIGH = numpy.array([0.57, 0.25, 0.1])
REACH = 0.97 * LENGTH                      # [m] how far it goes, along the clips that hold the cable,
CLEARANCE = POST + RADIUS                  # [m] and how near to the axis of a post,
TOP = HEIGHT + RADIUS                      # [m] unless it is so high
STRENGTH = 5.0                             # [N] that a hand holds against

FOLD = 0.05                                # [m] radius; the cable begins folded, its ends side by side
END = 0.03                                 # [m] the hand is so far ahead of the other end at first

EPISODE_STEPS = 400

LEAD = 0.035                               # [m] so far before a clip, and behind it, a hand passes that leads the cable through
SHAPING = 0.15                             # [m] over which the dense reward falls by e

LAYOUT_SEED = 21
LAYOUTS = 32
DEMONSTRATED_SPEED = 0.2                   # [m/s]


def folded():
    """Nodes of the cable at first, (n + 1, 3) [m]: from the origin along -x, around, and back."""
    straight = (LENGTH - numpy.pi * FOLD - END) / 2
    passed = (numpy.arange(SEGMENTS) + 0.5) * LENGTH / SEGMENTS
    return chain(numpy.pi - numpy.clip((passed - straight) / FOLD, 0, numpy.pi), LENGTH, RADIUS)


def make_posts(name, clip):
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
                            {'name': 'hand', 'at': 'end', 'frame': 'hand', 'initial_pose': [*nodes[-1][:2], LOW[2], 0, 0, 0]}],
        }],
        'obstacles': [{'name': 'table', 'type': 'plane', 'friction': 0.5}]
        + [post for i, clip in enumerate(clips) for post in make_posts(f'clip_{i}', clip)],
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


def count_held(held, hand, clips):
    """How many clips hold the cable, (count,): held (count, clips), hands (count, 3), clips (count, clips, 4)."""
    return held.sum(axis=1).astype(float)


def dense_reward(held, hand, clips):
    """How many clips hold the cable, and as far as the hand is on its way through the first one that does not up to 0.9 more,
    (count,)."""
    count = count_held(held, hand, clips)
    first = clips[numpy.arange(len(clips)), held.argmin(axis=1)]
    way = way_through(hand, first)
    return count + numpy.where(held.all(axis=1), 0.0, 0.9 * numpy.exp(-way / SHAPING))


def way_through(hand, clip):
    """[m] How far hands (count, 3) have to go until they have led a cable through clips (count, 4): to the place before the clip,
    and from there, or where they are between its posts already, to that behind it."""
    along, across = clip[:, 2:], numpy.stack([-clip[:, 3], clip[:, 2]], axis=1)
    away = hand[:, :2] - clip[:, :2]
    forward, aside, up = dots(away, along), abs(dots(away, across)), hand[:, 2] - LOW[2]
    through = numpy.maximum(LEAD - forward, 0) + aside + up
    around = numpy.sqrt((forward + LEAD) ** 2 + aside ** 2 + up ** 2) + 2 * LEAD
    leads = (aside < GAP / 2) & (forward > -LEAD) & (hand[:, 2] < HEIGHT)
    return numpy.where(leads, numpy.minimum(through, around), around)


REWARDS = {'clips': count_held, 'dense': dense_reward}


class LayCableTask(Task):
    cable = 'cable'
    nodes = SEGMENTS + 1
    touched = tuple(post['name'] for i in range(CLIPS) for post in make_posts(f'clip_{i}', numpy.array([0.0, 0, 1, 0])))
    option = 'layout'
    time_steps = round(STEP_TIME / TIME_STEP)

    def __init__(self, reward):
        self.reward = REWARDS[reward]
        self.layouts = constant(draw_layouts())
        self.posts = constant(numpy.array([[post['pose'][:2] for i, clip in enumerate(clips) for post in make_posts(f'clip_{i}', clip)]
                                           for clips in self.layouts]))
        hand = numpy.append(folded()[-1, :2], LOW[2])
        super().__init__(begin_worlds(self.layouts), numpy.arange(LAYOUTS), numpy.tile(hand, (LAYOUTS, 1)), actions=3,
                         observations=6 * self.nodes + 6 + 8 * CLIPS)
        self.demonstrations = constant(demonstrate(self.layouts, hand))

    def move(self, hand, actions, seen):
        way = give_way(actions * SPEED, seen.force, STRENGTH) * STEP_TIME
        fixed, free = self._free_length(seen.info['held'], seen.info['layout'])
        # A clip that begins to hold the cable does not move the hand.
        allowed = numpy.maximum(free, lengths(hand - fixed))

        def limit(places):
            away = numpy.clip(places, LOW, HIGH) - fixed
            return fixed + away * (allowed / numpy.maximum(lengths(away), allowed))[:, None]

        return move_beside(hand, limit(hand + way) - hand, self.posts[seen.info['layout']], CLEARANCE, TOP, limit)

    def _free_length(self, held, layout):
        """Where a cable is held by the last clip, or tied, (count, 3), at the lowest height of a hand, and how far from there its
        hand may be, (count,) [m]."""
        fixed = numpy.tile([0, 0, LOW[2]], (len(held), 1))
        free = numpy.full(len(held), REACH)
        for i in range(CLIPS):
            clip = fixed.copy()
            clip[:, :2] = self.layouts[layout, i, :2]
            free = free - numpy.where(held[:, i], lengths(clip - fixed), 0.0)
            fixed = numpy.where(held[:, i, None], clip, fixed)
        return fixed, free

    def poses(self, hand):
        poses = numpy.zeros((*hand.shape[:-1], 7))
        poses[..., :3] = hand
        poses[..., 6] = 1
        return poses

    def look(self, positions, velocities, force, contacts, hand, variants):
        clips = self.layouts[variants]
        held = held_by_clips(positions, clips)
        on_clips = contacts[:, 0::2] + contacts[:, 1::2]
        observation = side_by_side(positions, velocities, hand, force, clips, held.astype(float), on_clips)
        return Seen(observation, force, self.reward(held, hand, clips), {'held': held, 'layout': variants.copy()})

    def draw(self, positions, hand, variant):
        view = View((-0.35, -0.2), (0.6, 0.2), width=640)
        for x, y, *direction in self.layouts[variant]:
            across = numpy.array([-direction[1], direction[0]]) * (GAP / 2 + POST)
            for sign in (1, -1):
                view.disc((x, y) + sign * across, POST, (150, 60, 40))
        view.polyline(positions[:, :2], 2 * RADIUS, (30, 30, 30))
        view.disc(hand[:2], 0.008, (40, 80, 160))
        return view.pixels


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
    """Where the hand passes, (k, 3) [m]: down before the first clip, and through all."""
    low, high = LOW[2], 0.03
    first, along = clips[0, :2], clips[0, 2:]
    points = [[*(first - LEAD * along), high]]
    for clip in clips:
        points += [[*(clip[:2] - LEAD * clip[2:]), low], [*(clip[:2] + LEAD * clip[2:]), low]]
    return numpy.array(points)


@functools.lru_cache(maxsize=len(REWARDS))
def make_task(reward):
    return LayCableTask(reward)


class LayCable(Environment):
    """Lay a cable into three clips on a table. One end of the cable is tied down, and a hand holds the other end.

    Action (3,), each from -1 to 1: velocity of the hand along x, y and z, in units of 0.25 m/s. The hand stays between -0.35 m and
    0.57 m in x, within 0.25 m in y, between 10.4 mm and 0.1 m in z, and within reach of the cable. It stops at posts, slides along
    them, or goes over them. If the force on it at the end of a step is above 5 N, it yields in the next step; within a step, the
    force is not limited.
    Observation (336,) float64: nodes (51, 3) [m] from the tied end on, their velocities (51, 3) [m/s], the hand (3,) [m], the force
    on it (3,) [N], the clips (3, 4): x, y [m] and the unit vector of the cable's direction in them; whether they hold it (3,),
    0 or 1; and the forces of the cable on the posts of each clip (3, 3) [N].
    Reward: the number of clips that hold the cable, 0 to 3: its center line passes between their posts, below their tops. With
    reward='dense' up to 0.9 more, the nearer the hand is to having led the cable through the first clip that does not hold it.
    Info: `held` (3,) bool; `layout`, the index of the arrangement of clips. Options of reset: `layout`, below 32; default: random.
    Episodes are truncated after `max_episode_steps` steps of 0.02 s (never if it is None), and terminated if the simulation
    had to stop.
    """

    def __init__(self, render_mode=None, max_episode_steps=EPISODE_STEPS, reward='clips'):
        super().__init__(make_task(arguments.read_choice('reward', reward, REWARDS)), max_episode_steps, render_mode)


class LayCableVector(VectorEnvironment):
    """`num_envs` worlds of LayCable, on `threads` threads; 0: one per core. `autoreset_mode`: see VectorEnvironment."""

    def __init__(self, num_envs=1, render_mode=None, max_episode_steps=EPISODE_STEPS, threads=0, autoreset_mode=AutoresetMode.NEXT_STEP,
                 reward='clips'):
        super().__init__(make_task(arguments.read_choice('reward', reward, REWARDS)), num_envs, max_episode_steps, render_mode, threads,
                         autoreset_mode)
