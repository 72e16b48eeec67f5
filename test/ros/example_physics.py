"""What each of launch/examples with bodies shows, as tests to mix into those that all examples share. `self.node` is a CableClient."""
import contextlib
import time

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import WrenchStamped

from cable_client import PATIENCE, STARTING, Messages

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
        frames = tf2_ros.Buffer()
        listener = tf2_ros.TransformListener(frames)
        with contextlib.ExitStack() as stack:
            states = stack.enter_context(self.node.states())
            loads = {d: stack.enter_context(Messages(f'/cable/wrench/{d}', WrenchStamped)) for d in self.DRONES}
            begin = loads[self.DRONES[1]].next().header.stamp
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
        listener.unregister()
        # Of a weight whose impulse meanwhile is 24 N s.
        self.assertLess(np.linalg.norm(last - first - impulse), 0.03)


PHYSICS = {
    'drones_with_bar': DronesWithBar,
}
