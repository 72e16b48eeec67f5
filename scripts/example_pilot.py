#!/usr/bin/python3
"""example_pilot.py: flies a body of the cables' node, which feels its tether, from one place to the next. `~body`; its `~mass` [kg] and
`~inertia` [kg m^2]; `~places`, a list of [x, y, z] [m]; `~pause` [s] at each.

It knows the body's pose and velocity from `cable/state`, and answers each state with a thrust along the body's z axis and a torque on
`cable/apply/<body>`, as a flight controller does. Where it falls silent, the node's `apply_timeout` ends the thrust."""
import os
import sys

import numpy as np
import rospy
from geometry_msgs.msg import WrenchStamped

from verlet_cable.msg import CableArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import node_thread  # noqa: E402

GRAVITY = np.array([0.0, 0.0, 9.81])
# As of springs and dampers on the place [1/s^2, 1/s] and on the attitude [1/s^2, 1/s]: the latter is faster, and slow beside the state's
# rate.
PLACE_GAINS = 2.5, 3.0
ATTITUDE_GAINS = 80.0, 16.0
LARGEST_ACCELERATION = 4.0  # [m/s^2] asked for beside what carries the weight
STEEPEST = 0.5  # [rad]


def rotation_matrix(q):
    x, y, z, w = q.x, q.y, q.z, q.w
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])


def array(vector):
    return np.array([vector.x, vector.y, vector.z])


class Pilot:
    """Thrust and torque for a place to be at, from where the body is."""

    def __init__(self, mass, inertia):
        self.mass, self.inertia = mass, np.asarray(inertia, float)

    def wrench(self, place, velocity, axes, spin, target):
        """(3,) force [N] and (3,) torque [N m] in the fixed frame's axes. place, velocity, spin, target: (3,) [m, m/s, rad/s, m];
        axes (3, 3): the columns are the body's."""
        stiffness, damping = PLACE_GAINS
        wanted = stiffness * (target - place) - damping * velocity
        wanted *= min(1.0, LARGEST_ACCELERATION / max(np.linalg.norm(wanted), 1e-9))
        lift = wanted + GRAVITY
        lift[:2] *= min(1.0, lift[2] * np.tan(STEEPEST) / max(np.linalg.norm(lift[:2]), 1e-9))
        up, along = axes[:, 2], lift / np.linalg.norm(lift)
        thrust = self.mass * max(lift @ up, 0.0) * up
        # Turns the thrust to where it is wanted, and the nose to x.
        error = np.cross(up, along) + 0.2 * np.cross(axes[:, 0], [1.0, 0.0, 0.0])[2] * np.array([0.0, 0.0, 1.0])
        stiffness, damping = ATTITUDE_GAINS
        torque = axes @ (self.inertia * (axes.T @ (stiffness * error - damping * spin)))
        return thrust, torque


def fly():
    name = rospy.get_param('~body')
    pilot = Pilot(rospy.get_param('~mass'), rospy.get_param('~inertia'))
    places, pause = [np.array(place, float) for place in rospy.get_param('~places')], rospy.get_param('~pause')
    thrust = rospy.Publisher('cable/apply/' + name, WrenchStamped, queue_size=10)

    def answer(state):
        body = next((body for body in state.bodies if body.name == name), None)
        if body is None:
            return
        target = places[int(state.header.stamp.to_sec() / pause) % len(places)]
        force, torque = pilot.wrench(array(body.pose.position), array(body.twist.linear), rotation_matrix(body.pose.orientation),
                                     array(body.twist.angular), target)
        message = WrenchStamped(header=state.header)
        message.header.frame_id = ''
        message.wrench.force.x, message.wrench.force.y, message.wrench.force.z = force
        message.wrench.torque.x, message.wrench.torque.y, message.wrench.torque.z = torque
        thrust.publish(message)

    rospy.Subscriber('cable/state', CableArray, answer, queue_size=1)
    rospy.spin()


if __name__ == '__main__':
    node_thread.run('example_pilot', fly)
