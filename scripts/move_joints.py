#!/usr/bin/python3
"""move_joints.py: moves the joints of config/scenes/dress_pack.urdf, from rest, on joint_states at 100 Hz."""
import math
import os
import sys

import rospy
from sensor_msgs.msg import JointState

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import node_thread  # noqa: E402

RATE = 100.0  # [Hz]
RAMP = 2.0    # [s] in which the motion grows to its full size

# joint: mean [rad], amplitude [rad], period [s]
JOINTS = {
    'pan': (0.0, 0.9, 7.0),
    'lift': (0.1, 0.4, 5.0),
    'elbow': (0.0, 0.5, 4.0),
    'roll': (0.0, 0.8, 3.0),
}


def joint_positions(t):
    """Angles [rad] by joint at a time [s]; all 0 at 0, without a jump of velocity."""
    part = min(t / RAMP, 1.0)
    growth = part * part * (3 - 2 * part)
    return {joint: growth * (mean + amplitude * math.sin(2 * math.pi * t / period))
            for joint, (mean, amplitude, period) in JOINTS.items()}


def main():
    node_thread.run('move_joints', move_joints)


def move_joints():
    publisher = rospy.Publisher('joint_states', JointState, queue_size=10)
    rate = rospy.Rate(RATE)
    started = rospy.Time.now()
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        positions = joint_positions((now - started).to_sec())
        message = JointState(name=list(positions), position=list(positions.values()))
        message.header.stamp = now
        publisher.publish(message)
        rate.sleep()


if __name__ == '__main__':
    main()
