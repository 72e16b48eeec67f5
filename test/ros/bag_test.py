#!/usr/bin/env python3
"""A bag of tf that is played twice gives the same bytes of `state`: the run depends on the frames, not on scheduling."""
import math
import os
import signal
import subprocess
import sys
import tempfile
import unittest

import rosbag
import rospy
import rostest
from tf2_msgs.msg import TFMessage

from cable_client import CableClient, Messages, transform
from verlet_cable.msg import CableArray

START = 1000.0                   # [s] of the bag
DURATION = 3.0                   # [s]
LOST = (1.4, 2.0)                # [s] after the start: without right_hand, for twice tf_timeout
LATENCY = 0.5                    # [s] tf_latency of the node
TICK = 0.02                      # [s]


def write_bag(path):
    """A chain of two moving frames and a static one, and a moving frame that is lost and comes back."""
    with rosbag.Bag(path, 'w') as bag:
        bag.write('/tf_static', TFMessage([transform('left_tool', START, (0.1, 0, 0), parent='left_hand')]), rospy.Time(START))
        for i in range(int(DURATION * 100)):
            t = i / 100
            base = transform('base', START + t, (0.05 * math.sin(7 * t), 0, 1), (0, 0, math.sin(0.1 * t), math.cos(0.1 * t)))
            left = transform('left_hand', START + t, (0, 0.1 * math.sin(3 * t), 0), parent='base')
            right = transform('right_hand', START + t, (0.7, 0, 1 + 0.2 * math.sin(5 * t)))
            moving = [base, left] + ([] if LOST[0] <= t < LOST[1] else [right])
            for one in moving:
                bag.write('/tf', TFMessage([one]), rospy.Time.from_sec(START + t))


class BagTest(unittest.TestCase):
    def play(self, bag):
        """Stamp [ns] -> bytes of the state with that stamp."""
        node = subprocess.Popen(['rosrun', 'verlet_cable', 'cable_node', '__name:=cable'])
        try:
            CableClient('/cable')
            with Messages('/cable/state', rospy.AnyMsg) as states:
                subprocess.run(['rosbag', 'play', '--quiet', '--clock', '--hz=200', '--wait-for-subscribers', '--delay=0.5', bag],
                               check=True, stdin=subprocess.DEVNULL)
                return {CableArray().deserialize(message._buff).header.stamp.to_nsec(): message._buff for message in states.all()}
        finally:
            node.send_signal(signal.SIGINT)
            node.wait()

    def test_the_same_bytes(self):
        with tempfile.TemporaryDirectory() as directory:
            bag = os.path.join(directory, 'frames.bag')
            write_bag(bag)
            first, second = self.play(bag), self.play(bag)
        ticks = int((DURATION - LATENCY) / TICK)
        common = sorted(first.keys() & second.keys())
        # the very first message may be missed while the connection is made, the very last when the clock ends
        self.assertGreaterEqual(len(common), ticks - 3, (len(first), len(second)))
        self.assertLessEqual(len(first.keys() ^ second.keys()), 3)
        states = [CableArray().deserialize(first[stamp]) for stamp in common]
        self.assertGreater(math.dist(*[(c.positions[-1].x, c.positions[-1].z) for s in (states[0], states[-1]) for c in s.cables[1:]]),
                           0.1, 'the whip swings')
        for stamp in common:
            self.assertEqual(first[stamp], second[stamp], f'stamp {stamp}')


if __name__ == '__main__':
    rospy.init_node('bag_test', disable_rostime=True)
    rostest.rosrun('verlet_cable', 'bag', BagTest, sys.argv)
