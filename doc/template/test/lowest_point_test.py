#!/usr/bin/env python3
"""The node lowest_point against a simulated rope: at rest, when the hand moves, and when the rope is paid out."""
import time
import unittest

import rospy
import rostest
import tf2_ros
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import Float64
from std_srvs.srv import Trigger

from verlet_cable.srv import SetLength

PATIENCE = 20.0  # [s] for what takes a fraction of a second where nothing else runs
AT_REST = 0.598  # [m] lowest point of a catenary of 1.2 m between points 0.8 m apart, 1 m high


class LowestPointTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('lowest_point_test')
        cls.broadcaster = tf2_ros.TransformBroadcaster()
        cls.hand_height = None  # [m] None: tf says nothing
        cls.timer = rospy.Timer(rospy.Duration(0.01), cls.send_hand)
        cls.heights = []
        cls.subscriber = rospy.Subscriber('lowest_point/height', Float64, lambda message: cls.heights.append(message.data))
        rospy.wait_for_service('cable/reset', PATIENCE)

    @classmethod
    def send_hand(cls, _):
        if cls.hand_height is None:
            return
        message = TransformStamped()
        message.header.stamp = rospy.Time.now()
        message.header.frame_id = 'world'
        message.child_frame_id = 'hand'
        message.transform.translation.x = 0.8
        message.transform.translation.z = cls.hand_height
        message.transform.rotation.w = 1
        cls.broadcaster.sendTransform(message)

    def wait_for_height(self, expected):
        """Waits until what comes is within a millimetre; a swinging rope takes its time."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            if self.heights and abs(self.heights[-1] - expected) < 0.001:
                return
            time.sleep(0.05)
        self.fail(f'not at {expected} m in {PATIENCE} s, but at {self.heights[-1:]}')

    def test_1_at_rest(self):
        self.wait_for_height(AT_REST)

    def test_2_the_hand_goes_up(self):
        type(self).hand_height = 1.2
        self.wait_for_height(0.699)
        type(self).hand_height = 1.0
        self.wait_for_height(AT_REST)

    def test_3_more_rope(self):
        answer = rospy.ServiceProxy('cable/set_length', SetLength)(cable='rope', at_end=False, length=1.4, speed=0.5)
        self.assertTrue(answer.success, answer.message)
        self.wait_for_height(0.477)
        self.assertTrue(rospy.ServiceProxy('cable/reset', Trigger)().success)
        self.wait_for_height(AT_REST)


if __name__ == '__main__':
    rostest.rosrun('my_cables', 'lowest_point_test', LowestPointTest)
