#!/usr/bin/env python3
"""Cables that are joined: what was cut is whole again, with the event; what cannot be joined is refused."""
import sys
import unittest

import rospy
import rostest

from cable_client import CableClient, cable, contents, distance, node_at
from verlet_cable.msg import CableEvent


class JoinTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('join_test')
        cls.node = CableClient('/cable')
        with cls.node.states() as states:
            states.next()

    def test_a_cut_cable_is_joined_again(self):
        self.assertTrue(self.node.reset().success)
        cut = self.node.cut(node_at('line', 9))
        self.assertTrue(cut.success, cut.message)
        with self.node.events() as events, self.node.states() as states:
            states.next(10)
            answer = self.node.join(cut.first, True, cut.second, False)
            self.assertTrue(answer.success, answer.message)
            self.assertEqual(answer.cable, 'line')
            event = events.wait_for(lambda e: e.type == CableEvent.JOINED, 'JOINED')
            self.assertEqual((event.cable, event.other, event.node), ('line', cut.second, 9))
            whole = states.wait_for(lambda s: cable(s, cut.second) is None and len(cable(s, 'line').positions) == 20, 'one cable')
            line = cable(whole, 'line')
            self.assertEqual(line.attachments, ['left', 'right'])
            self.assertEqual(list(line.attachment_nodes), [0, 19])
            self.assertLess(distance(line.positions[19], (0.4, 1, 1)), 1e-9)
        self.assertTrue(self.node.reset().success)
        self.assertEqual(len(cable(self.node.state(), 'line').positions), 21)

    def test_bad_requests_are_refused(self):
        self.assertTrue(self.node.pause(True).success)
        before = self.node.state()
        for request, part in ((('nothing', True, 'line', True), 'first: "nothing"'), (('line', True, '', True), 'second: ""'),
                              (('line', True, 'x' * 10_000_000, True), 'allowed: crane, line'),
                              (('line', True, 'line', False), 'another cable'), (('crane', True, 'other', False), 'same material'),
                              (('crane', False, 'line', False), 'both ends are held'),
                              (('line', False, 'crane', False), 'both ends are held')):
            answer = self.node.join(*request)
            self.assertFalse(answer.success, request[0][:20])
            self.assertIn(part, answer.message)
            self.assertLess(len(answer.message), 1000)
        self.assertEqual(contents(self.node.state()), contents(before))
        self.assertTrue(self.node.pause(False).success)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'join', JoinTest, sys.argv)
