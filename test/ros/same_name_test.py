#!/usr/bin/env python3
"""A node takes the name of another that runs: the older one ends, the newer one stays."""
import signal
import subprocess
import sys
import time
import unittest

import roslib.packages
import rospy
import rostest

from cable_client import STARTING, CableClient

NODE = roslib.packages.find_node('verlet_cable', 'cable_node')[0]


class SameNameTest(unittest.TestCase):
    def start(self):
        node = subprocess.Popen([NODE, '__name:=twin'])
        self.addCleanup(node.wait, 20)
        self.addCleanup(node.send_signal, signal.SIGINT)
        return node

    def test_the_newer_node_stays(self):
        older = self.start()
        CableClient('/twin').step(1)
        newer = self.start()
        older.wait(STARTING)
        time.sleep(2)  # in which the newer one would end
        self.assertIsNone(newer.poll(), 'the newer node has ended')
        answer = CableClient('/twin').reset()
        self.assertTrue(answer.success, answer.message)


if __name__ == '__main__':
    rospy.init_node('same_name_test')
    rostest.rosrun('verlet_cable', 'same_name', SameNameTest, sys.argv)
