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
import example_motions  # noqa: E402

STOP_LIMIT = 30.0  # [s]


class DemoTest(unittest.TestCase):

    def test_hands_never_ask_for_more_rope_than_there_is(self):
        with open(os.path.join(PACKAGE, 'config', 'demo.yaml'), encoding='utf-8') as file:
            rope = next(cable for cable in yaml.safe_load(file)['cables'] if cable['name'] == 'rope')
        for moment in np.arange(0, example_motions.DEMO_CYCLE, 0.01):
            poses = example_motions.demo(moment)
            left, right = (self.held_point(poses[attachment['frame']], attachment['offset']) for attachment in rope['attachments'])
            self.assertLess(np.linalg.norm(left - right), rope['length'])

    @staticmethod
    def held_point(pose, offset):
        """An offset along x, in a frame that is turned about y."""
        position, (_, y, _, w) = pose
        pitch = 2 * np.arctan2(y, w)
        return np.array(position) + offset[0] * np.array([np.cos(pitch), 0, -np.sin(pitch)])

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

    @staticmethod
    def stamp_of(message):
        return message.markers[0].header.stamp if isinstance(message, MarkerArray) else message.header.stamp

    def watch(self, seconds=4.0):
        kinds = {'markers': MarkerArray, 'points': PointCloud2, 'state': CableArray}
        raw = {topic: [] for topic in kinds}  # decoded afterwards: Python is slower at that than the node publishes
        came = threading.Event()

        def decode(topic, message):
            return kinds[topic]().deserialize(message._buff)

        def shows_cables(message):  # before, they wait for their frames
            return any(getattr(message, field, 0) for field in ('markers', 'width', 'cables'))

        def receive(message, topic):
            if raw[topic] or shows_cables(decode(topic, message)):
                raw[topic].append(message)
            if all(raw.values()):
                came.set()

        subscribers = [rospy.Subscriber(f'/cable/{topic}', rospy.AnyMsg, receive, topic) for topic in kinds]
        self.assertTrue(came.wait(20.0), f'within 20 s came {({topic: len(seen) for topic, seen in raw.items()})}')
        time.sleep(seconds)
        for subscriber in subscribers:
            subscriber.unregister()
        stamps = {topic: [self.stamp_of(decode(topic, message)) for message in messages] for topic, messages in raw.items()}
        for topic, seen in stamps.items():
            steps = np.diff([stamp.to_sec() for stamp in seen])
            np.testing.assert_allclose(steps, 0.02, atol=1e-6, err_msg=topic)  # no message left out; stamps have whole ns
            self.assertGreater(len(seen), 45 * seconds, topic)
        common = set(stamps['markers']) & set(stamps['points']) & set(stamps['state'])
        self.assertGreater(len(common), 40 * seconds)


if __name__ == '__main__':
    rospy.init_node('display_demo_test')
    rostest.rosrun('verlet_cable', 'display_demo', DemoTest)
