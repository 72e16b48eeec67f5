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

START = 1000.0     # [s] of the bag
DURATION = 2.4     # [s]
LOST = (0.8, 1.4)  # [s] after the start: without right_hand, for twice tf_timeout
LATENCY = 0.5      # [s] tf_latency of the node
TICK = 0.02        # [s]


def write_bag(path):
    """A chain of two moving frames and a static one, and a moving frame that is lost and comes back."""
    with rosbag.Bag(path, 'w') as bag:
        bag.write('/tf_static', TFMessage([transform('left_tool', START, (0.1, 0, 0), parent='left_hand')]), rospy.Time(START))
        for i in range(int(DURATION * 100)):
            t = i / 100
            base = transform('base', START + t, (0.05 * math.sin(7 * t), 0, 1), (0, 0, math.sin(0.1 * t), math.cos(0.1 * t)))
            left = transform('left_hand', START + t, (0, 0.1 * math.sin(3 * t), 0), parent='base')
            right = transform('right_hand', START + t, (0.7, 0, 1 + 0.2 * math.sin(5 * t)))
            for one in [base, left] + ([] if LOST[0] <= t < LOST[1] else [right]):
                bag.write('/tf', TFMessage([one]), rospy.Time.from_sec(START + t))


def runs_of(messages):
    """A dictionary for each run, which begins when stamps go back: from the stamp [ns] to the bytes of the state.

    Without the first four: header.seq counts what roscpp has sent to anyone.
    """
    runs = []
    last = None
    for message in messages:
        stamp = CableArray().deserialize(message._buff).header.stamp.to_nsec()
        if last is None or stamp < last:
            runs.append({})
        runs[-1][stamp] = message._buff[4:]
        last = stamp
    return runs


class BagTest(unittest.TestCase):
    def play(self, bag, times):
        """What a new node makes of the bag, each time it is played."""
        node = subprocess.Popen(['rosrun', 'verlet_cable', 'cable_node', '__name:=cable'])
        try:
            CableClient('/cable')
            with Messages('/cable/state', rospy.AnyMsg) as states:
                for _ in range(times):
                    subprocess.run(['rosbag', 'play', '--quiet', '--clock', '--hz=200', '--wait-for-subscribers', bag],
                                   check=True, stdin=subprocess.DEVNULL)
                return runs_of(states.all())
        finally:
            node.send_signal(signal.SIGINT)
            node.wait()

    def test_the_same_bytes(self):
        with tempfile.TemporaryDirectory() as directory:
            bag = os.path.join(directory, 'frames.bag')
            write_bag(bag)
            # for a new node, for the same node after its time went back, and for another new one
            runs = self.play(bag, 2) + self.play(bag, 1)
        self.assertEqual(len(runs), 3)
        ticks = int((DURATION - LATENCY) / TICK)
        for run in runs:
            # rosbag ends the clock before or after the last tick
            self.assertAlmostEqual(len(run), ticks, delta=2)
        first = runs[0]
        begin, end = (CableArray().deserialize(bytes(4) + first[stamp]) for stamp in (min(first), max(first)))
        whips = [state.cables[1].positions[-1] for state in (begin, end)]
        self.assertGreater(math.hypot(whips[0].x - whips[1].x, whips[0].z - whips[1].z), 0.1, 'something moves')
        for run in runs[1:]:
            for stamp in sorted(first.keys() & run.keys()):
                self.assertEqual(first[stamp], run[stamp], f'stamp {stamp}')


if __name__ == '__main__':
    rospy.init_node('bag_test', disable_rostime=True)
    rostest.rosrun('verlet_cable', 'bag', BagTest, sys.argv)
