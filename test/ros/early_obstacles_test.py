#!/usr/bin/env python3
"""Obstacles of the topic that come before the cables can start follow their own frames."""
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Quaternion, Vector3
from visualization_msgs.msg import Marker, MarkerArray

from cable_client import Frames, Messages


def cube(number, frame, size):
    message = Marker(ns='seen', id=number, type=Marker.CUBE, action=Marker.ADD)
    message.header.frame_id = frame
    message.pose.orientation = Quaternion(0, 0, 0, 1)
    message.scale = Vector3(size, size, size)
    return message


class EarlyObstaclesTest(unittest.TestCase):
    def test_each_follows_its_own_frame(self):
        rospy.init_node('early_obstacles_test')
        publisher = rospy.Publisher('/cable/obstacles', MarkerArray, queue_size=10)
        while publisher.get_num_connections() == 0:
            rospy.sleep(0.05)
        # The order of their names is not that of their arrival.
        publisher.publish([cube(2, 'near', 0.1)])
        publisher.publish([cube(1, 'far', 0.2)])
        rospy.sleep(0.3)
        with Frames(hand=lambda t: (0, 0, 1), near=lambda t: (1, 0, 0), far=lambda t: (9, 0, 0)), \
                Messages('/cable/markers', MarkerArray) as messages:
            def shown(markers):
                return {(round(m.pose.position.x), round(m.scale.x, 3)) for m in markers.markers
                        if m.ns == 'obstacles' and m.action == Marker.ADD}
            both = shown(messages.wait_for(lambda m: len(shown(m)) == 2, 'both obstacles'))
        self.assertEqual(both, {(1, 0.1), (9, 0.2)})


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'early_obstacles', EarlyObstaclesTest, sys.argv)
