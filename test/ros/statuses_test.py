#!/usr/bin/env python3
"""What forces are worth: `status` of cables and bodies, and the events when a status begins and ends."""
import unittest

import rospy
import rostest

from cable_client import CableClient, Frames, cable
from verlet_cable.msg import Body, Cable, CableEvent


class StatusesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('statuses_test')
        cls.frames = Frames(hand=lambda t: (0.95, 0, 0))
        cls.frames.__enter__()
        cls.node = CableClient('/cable')
        with cls.node.states() as states:
            states.wait_for(lambda state: cable(state, 'string'), 'string')

    @classmethod
    def tearDownClass(cls):
        cls.frames.__exit__()

    def move_hand(self, to, speed=0.1):
        start, first = rospy.get_time(), self.frames.motions['hand'](rospy.get_time())[0]
        way = to - first
        self.frames.motions['hand'] = lambda t: (first + way * min(max(t - start, 0) * speed / abs(way), 1), 0, 0)

    def test_a_cable_that_is_drawn_beyond_its_length_says_so_until_the_hand_comes_back(self):
        with self.node.events() as events, self.node.states() as states:
            states.wait_for(lambda s: cable(s, 'string').status == Cable.OK, 'OK')
            self.move_hand(1.02)
            begin = events.wait_for(lambda e: e.type == CableEvent.STATUS and e.cable == 'string', 'begin')
            self.assertEqual(begin.other, 'overstretched')
            self.assertIn('overstretched: ', begin.message)
            state = states.wait_for(lambda s: cable(s, 'string').status == Cable.OVERSTRETCHED, 'OVERSTRETCHED')
            self.assertEqual({body.name: body.status for body in state.bodies}, {'box': Body.OK})
            self.move_hand(0.95)
            end = events.wait_for(lambda e: e.type == CableEvent.STATUS and e.cable == 'string' and 'ended' in e.message, 'end')
            self.assertEqual(end.other, 'overstretched')
            self.assertIn('largest strain', end.message)
            self.assertGreater(end.header.stamp, begin.header.stamp)
            states.wait_for(lambda s: cable(s, 'string').status == Cable.OK, 'OK again')

    def test_a_cable_that_is_inside_an_obstacle_says_so_after_a_reset(self):
        with self.node.events() as events, self.node.states() as states:
            self.assertTrue(self.node.reset().success)
            begin = events.wait_for(
                lambda e: e.type == CableEvent.STATUS and e.cable == 'rope' and e.other == 'inside_obstacle' and 'ended' not in e.message, 'begin')
            self.assertIn('table', begin.message)
            state = states.wait_for(lambda s: cable(s, 'rope') and cable(s, 'rope').status >= Cable.INSIDE_OBSTACLE, 'INSIDE_OBSTACLE')
            self.assertLess(cable(state, 'string').status, Cable.INSIDE_OBSTACLE)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'statuses', StatusesTest)
