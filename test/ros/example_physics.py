"""What each of launch/examples with bodies shows, as tests to mix into those that all examples share. `self.node` is a CableClient."""
import contextlib
import math
import time

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import WrenchStamped

from verlet_cable.msg import CableEvent

from cable_client import PATIENCE, STARTING, Messages, cable

GRAVITY = np.array([0, 0, -9.81])  # [m/s^2]
TICK = 0.02                        # [s] between what the node publishes


def vector(v):
    return np.array([v.x, v.y, v.z])


def rotate(q, v):
    axis = np.array([q.x, q.y, q.z])
    return v + 2 * np.cross(axis, np.cross(axis, v) + q.w * v)


def momentum(cable, linear_density):
    """[N s] Of a cable, half a segment's mass on each of its nodes."""
    masses = np.full(len(cable.positions), linear_density * cable.rest_length / (len(cable.positions) - 1))
    masses[[0, -1]] /= 2
    return masses @ [vector(v) for v in cable.velocities]


def body(state, name):
    return next(b for b in state.bodies if b.name == name)


def pitch(q):
    """[rad] Of an orientation that is turned about y alone."""
    return 2 * math.atan2(q.y, q.w)


def distance_from_polyline(point, nodes):
    starts, ways = nodes[:-1], np.diff(nodes, axis=0)
    along = np.clip(np.sum((point - starts) * ways, axis=1) / np.sum(ways * ways, axis=1), 0, 1)
    return np.linalg.norm(starts + along[:, None] * ways - point, axis=1).min()


@contextlib.contextmanager
def in_frames():
    """A buffer of what comes on tf, long enough for a busy machine."""
    buffer = tf2_ros.Buffer(rospy.Duration(600))
    listener = tf2_ros.TransformListener(buffer)
    try:
        yield buffer
    finally:
        listener.unregister()


def ticks_in_a_row(states, begin, count):
    """So many states, one tick apart: a busy machine may drop time between others."""
    deadline = time.monotonic() + STARTING
    while time.monotonic() < deadline:
        run = []
        for state in states.all():
            if run and abs((state.header.stamp - run[-1].header.stamp).to_sec() - TICK) > 1e-6:
                run = []
            if state.header.stamp >= begin:
                run.append(state)
            if len(run) == count:
                return run
        time.sleep(0.1)
    raise AssertionError(f'no {count} ticks in a row in {STARTING} s')


class DronesWithBar:
    BAR, ROPE, AIR = 1.2, 0.022, 0.1  # [kg], [kg/m], [N s/m]
    DRONES = 'left_drone', 'right_drone'

    def test_the_drones_bear_the_weight_and_what_moves_the_bar(self):
        with contextlib.ExitStack() as stack:
            frames = stack.enter_context(in_frames())
            states = stack.enter_context(self.node.states())
            loads = {d: stack.enter_context(Messages(f'/cable/wrench/{d}', WrenchStamped)) for d in self.DRONES}
            for drone in self.DRONES:
                frames.lookup_transform('world', drone, rospy.Time(0), rospy.Duration(PATIENCE))
            begin = loads[self.DRONES[1]].next().header.stamp + rospy.Duration(0.5)  # what comes now tf may not know
            run = ticks_in_a_row(states, begin, 100)
            forces = {d: {} for d in self.DRONES}
            for drone, messages in loads.items():
                messages.wait_for(lambda m: m.header.stamp >= run[-1].header.stamp, 'load at the last state')
                for load in messages.all():
                    forces[drone][load.header.stamp] = load
            # The impulse of all that acts on bar and ropes, tick by tick.
            impulse = np.zeros(3)
            for state in run[1:]:
                stamp = state.header.stamp
                impulse += TICK * (self.BAR + 2 * 0.9 * self.ROPE) * GRAVITY
                impulse -= TICK * self.AIR * vector(body(state, 'bar').twist.linear)
                for drone in self.DRONES:
                    turn = frames.lookup_transform('world', drone, stamp, rospy.Duration(PATIENCE)).transform.rotation
                    impulse -= TICK * rotate(turn, vector(forces[drone][stamp].wrench.force))
        first, last = (self.BAR * vector(body(state, 'bar').twist.linear) + sum(momentum(c, self.ROPE) for c in state.cables)
                       for state in (run[0], run[-1]))
        # Of a weight whose impulse meanwhile is 24 N s.
        self.assertLess(np.linalg.norm(last - first - impulse), 0.03)


class Plug:
    CLIP = np.array([-0.035, 0, 0.1])    # [m]
    BACK = np.array([-0.025, 0, 0])      # [m] of the plug, where the cable ends

    def test_the_clip_keeps_the_plug_when_the_cable_is_drawn(self):
        with self.node.events() as events, self.node.states() as states, \
                Messages('/cable/wrench/far_hand', WrenchStamped) as loads:
            caught = events.wait_for(lambda e: e.type == CableEvent.CAUGHT, 'clip that takes the cable', STARTING)
            self.assertEqual(caught.attachment, 'clip')
            let_go = events.wait_for(lambda e: e.type == CableEvent.UNPINNED and e.header.stamp > caught.header.stamp,
                                     'hand that lets go', STARTING)
            drawn = let_go.header.stamp + rospy.Duration(5.0)
            pull = loads.wait_for(lambda w: w.header.stamp > drawn, 'load when the cable is drawn', STARTING)
            self.assertGreater(pull.wrench.force.x, 0.3)
            state = states.wait_for(lambda s: s.header.stamp >= pull.header.stamp, 'state')
            self.assertFalse([e for e in events.all() if e.type == CableEvent.RELEASED and e.header.stamp <= state.header.stamp])
        plug = body(state, 'plug').pose
        back = vector(plug.position) + rotate(plug.orientation, self.BACK)
        # It came back to the clip, and no further: it is in the socket still.
        self.assertLess(np.linalg.norm(back - self.CLIP), 0.003)
        self.assertEqual(cable(state, 'cable').guides, ['clip'])


class Harness:
    CLIPS = [np.array([x, 0, 0.005]) for x in (-0.36, -0.18, 0, 0.18, 0.36)]  # [m] on the board

    def test_the_clips_hold_it_on_the_steep_board(self):
        with self.node.events() as events, self.node.states() as states, in_frames() as frames:
            let_go = events.wait_for(lambda e: e.type == CableEvent.UNPINNED and e.attachment == 'right_hand', 'hand that lets go',
                                     2 * STARTING)
            state = states.wait_for(lambda s: s.header.stamp > let_go.header.stamp + rospy.Duration(8.0), 'board on edge',
                                    STARTING)
            board = frames.lookup_transform('world', 'board', state.header.stamp, rospy.Duration(PATIENCE)).transform
            lost = [e.attachment for e in events.all() if e.type == CableEvent.RELEASED]
        self.assertGreater(rotate(board.rotation, np.array([0, 1, 0]))[2], 0.8)
        self.assertEqual(lost, [])
        trunk = cable(state, 'trunk')
        self.assertEqual(sorted(trunk.guides), [f'clip_{i + 1}' for i in range(len(self.CLIPS))])
        nodes = np.array([vector(p) for p in trunk.positions])
        for clip in self.CLIPS:
            place = vector(board.translation) + rotate(board.rotation, clip)
            self.assertLess(distance_from_polyline(place, nodes), 0.002)
        # Its weight is held by them alone: nothing else does.
        self.assertEqual([a for c in state.cables for a in c.attachments if 'hand' in a], [])


class Finger:
    RADIUS, STRAIGHT, LENGTH, STIFFNESS = 0.008, 0.06, 0.052, 20.0  # [m], [m], [m], [N]
    BANDS = {'first_band': ('palm', 'proximal'), 'second_band': ('proximal', 'distal')}

    def check_bands(self, state, palm):
        turns = {'palm': pitch(palm.rotation), **{b.name: pitch(b.pose.orientation) for b in state.bodies}}
        for band, (before, after) in self.BANDS.items():
            length = self.STRAIGHT + self.RADIUS * (turns[after] - turns[before])
            tension = self.STIFFNESS * (length / self.LENGTH - 1)
            self.assertAlmostEqual(np.mean(cable(state, band).tension), tension, delta=0.08 * tension)
        return turns['distal'] - turns['palm']

    def test_bands_are_stretched_by_what_their_joints_turn(self):
        with self.node.states() as states, in_frames() as frames:
            palm = frames.lookup_transform('world', 'palm', rospy.Time(0), rospy.Duration(PATIENCE))

            def angle_at(is_reached, what):
                # Its palm is looked up at once: tf forgets after 10 s. Of what was before the first transform it knows nothing.
                state = states.wait_for(lambda s: s.header.stamp > palm.header.stamp and is_reached(s), what, 2 * STARTING)
                pose = frames.lookup_transform('world', 'palm', state.header.stamp, rospy.Duration(PATIENCE)).transform
                return state.header.stamp, self.check_bands(state, pose)
            bent, angle = angle_at(lambda s: cable(s, 'tendon').rest_length < 0.0971, 'bent finger')
            self.assertGreater(angle, 1.0)
            _, angle = angle_at(lambda s: s.header.stamp > bent and cable(s, 'tendon').rest_length > 0.1199, 'straight finger')
            self.assertLess(angle, 1.0)


PHYSICS = {
    'drones_with_bar': DronesWithBar,
    'finger': Finger,
    'harness': Harness,
    'plug': Plug,
}
