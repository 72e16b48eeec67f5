#!/usr/bin/python3
"""demo.launch as a user starts it: rates, stamps and a log without warnings."""
import os
import subprocess
import sys
import threading
import time
import unittest

import numpy as np
import rospy
import rostest
import yaml
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import MarkerArray

from verlet_cable.msg import CableArray

PACKAGE = os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..')
sys.path.insert(0, os.path.join(PACKAGE, 'scripts'))
import demo_frames  # noqa: E402

STOP_LIMIT = 30.0  # [s]


class DemoTest(unittest.TestCase):

    def test_hands_never_ask_for_more_rope_than_there_is(self):
        with open(os.path.join(PACKAGE, 'config', 'demo.yaml'), encoding='utf-8') as file:
            cables = {cable['name']: cable for cable in yaml.safe_load(file)['cables']}
        for moment in np.arange(0, demo_frames.CYCLE, 0.01):
            poses = demo_frames.frame_poses(moment)
            left, right = (poses[hand][0] for hand in ('left_hand', 'right_hand'))
            distance = np.linalg.norm([left.x - right.x, left.y - right.y, left.z - right.z])
            self.assertLess(distance, cables['rope']['length'])

    def test_rates_and_stamps(self):
        command = ['roslaunch', 'verlet_cable', 'demo.launch', 'rviz:=false']
        process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        try:
            self.watch()
        finally:
            process.terminate()
            output = process.communicate(timeout=STOP_LIMIT)[0]
        self.assertNotIn('WARN', output)
        self.assertNotIn('ERROR', output)

    def watch(self, seconds=4.0):
        stamps = {'markers': [], 'points': [], 'state': []}
        came = threading.Event()

        def receive(topic, stamp):
            stamps[topic].append(stamp)
            if all(stamps.values()):
                came.set()

        subscribers = [
            rospy.Subscriber('/cable/markers', MarkerArray, lambda m: receive('markers', m.markers[0].header.stamp)),
            rospy.Subscriber('/cable/points', PointCloud2, lambda m: receive('points', m.header.stamp)),
            rospy.Subscriber('/cable/state', CableArray, lambda m: receive('state', m.header.stamp)),
        ]
        self.assertTrue(came.wait(20.0), f'within 20 s came {({topic: len(seen) for topic, seen in stamps.items()})}')
        time.sleep(seconds)
        for subscriber in subscribers:
            subscriber.unregister()
        for topic, seen in stamps.items():
            steps = np.diff([stamp.to_sec() for stamp in seen])
            np.testing.assert_allclose(steps, 0.02, atol=1e-6, err_msg=topic)  # no message left out; stamps have whole ns
            self.assertGreater(len(seen), 45 * seconds, topic)
        common = set(stamps['markers']) & set(stamps['points']) & set(stamps['state'])
        self.assertGreater(len(common), 40 * seconds)


if __name__ == '__main__':
    rospy.init_node('display_demo_test')
    rostest.rosrun('verlet_cable', 'display_demo', DemoTest)
