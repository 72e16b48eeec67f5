#!/usr/bin/python3
"""move_joints.py: moves the joints of the arms in config/scenes/dress_pack.urdf and config/examples/table_camera.urdf, from rest, on
joint_states at 100 Hz. At first they stand where cables start, until these have seen them."""
import os
import sys

import rospy
from sensor_msgs.msg import JointState

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import node_thread  # noqa: E402
from example_motions import joint_positions  # noqa: E402

RATE = 100.0  # [Hz]
STANDING = 2.0  # [s]


def main():
    node_thread.run('move_joints', move_joints)


def move_joints():
    publisher = rospy.Publisher('joint_states', JointState, queue_size=10)
    rate = rospy.Rate(RATE)
    started = rospy.Time.now()
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        positions = joint_positions(max((now - started).to_sec() - STANDING, 0.0))
        message = JointState(name=list(positions), position=list(positions.values()))
        message.header.stamp = now
        publisher.publish(message)
        rate.sleep()


if __name__ == '__main__':
    main()
