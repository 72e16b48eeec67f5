#!/usr/bin/env python3
"""What happens to cables is told: one is pulled too hard and breaks, one found no equilibrium to start from."""
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus

from cable_client import CableClient, Frames, Messages, cable
from verlet_cable.msg import CableEvent


class CableReportsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('cable_reports_test')
        cls.frames = Frames(hand=lambda t: (0.98, 0, 0))
        cls.frames.__enter__()
        cls.node = CableClient('/cable')
        with cls.node.states() as states:
            states.wait_for(lambda state: cable(state, 'string'), 'string')

    @classmethod
    def tearDownClass(cls):
        cls.frames.__exit__()

    def test_a_cable_that_breaks_is_an_event_and_two_cables(self):
        with self.node.events() as events, self.node.states() as states:
            # 15 N strain it by 15 mm; 0.1 m/s is slow enough for tf's samples to be a smooth motion.
            start = rospy.get_time()
            self.frames.motions['hand'] = lambda t: (0.98 + min(0.1 * max(t - start, 0), 0.06), 0, 0)
            limit = events.wait_for(lambda e: e.type == CableEvent.LIMIT, 'LIMIT')
            event = events.wait_for(lambda e: e.type == CableEvent.BROKE, 'BROKE')
            self.assertEqual(limit.cable, 'string')
            self.assertIn('above maximum_tension, 12 N', limit.message)
            self.assertLess(limit.header.stamp, event.header.stamp)
            self.assertEqual((event.cable, event.other), ('string', 'string_2'))
            self.assertIn('15 N', event.message)
            state = states.wait_for(lambda s: cable(s, 'string_2'), 'second piece')
        # The segment that broke is gone, and its nodes are the pieces' ends.
        first, second = cable(state, 'string'), cable(state, 'string_2')
        self.assertEqual(len(first.positions), event.node + 1)
        self.assertEqual(len(first.positions) + len(second.positions), 21)
        self.assertEqual((first.attachments, second.attachments), (['fixed'], ['held']))
        self.assertGreaterEqual(state.header.stamp, event.header.stamp)

    def test_a_cable_that_found_no_equilibrium_is_a_warning(self):
        with Messages('/diagnostics', DiagnosticArray) as diagnostics:
            array = diagnostics.wait_for(lambda a: any(s.name == 'cable: simulation' for s in a.status), 'status')
        status = next(s for s in array.status if s.name == 'cable: simulation')
        self.assertGreaterEqual(status.level, DiagnosticStatus.WARN)
        self.assertIn('no static equilibrium', status.message)
        self.assertEqual({v.key: v.value for v in status.values}['unsettled_cables'], 'gum')


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'cable_reports', CableReportsTest)
