#!/usr/bin/env python3
"""A winch lifts a load and lowers it: length, tension and what cannot be done."""
import math
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped

from cable_client import CableClient, Messages, cable, contents

GRAVITY, DENSITY, PAYLOAD = 9.81, 0.1, 0.2
NAN = float('nan')


class WinchTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('winch_test')
        cls.node = CableClient('/cable')
        with cls.node.states() as states:
            states.next()

    def test_a_load_goes_up_and_down_smoothly(self):
        with self.node.states() as states, Messages('/cable/wrench/winch', WrenchStamped) as wrenches:
            for goal in (0.5, 2.0):
                wrenches.clear()
                answer = self.node.set_length('crane', False, goal, 0.5, 0)
                self.assertTrue(answer.success, answer.message)
                states.wait_for(lambda s: abs(cable(s, 'crane').rest_length - goal) < 1e-3, f'cable of {goal} m')
                rospy.sleep(1.0)
                statics = GRAVITY * (PAYLOAD + DENSITY * goal)
                heaviest = GRAVITY * (PAYLOAD + DENSITY * 2)
                forces = [-w.wrench.force.z for w in wrenches.all()]
                self.assertLess(max(forces), 1.5 * heaviest)
                self.assertAlmostEqual(forces[-1], statics, delta=0.05 * statics)
                self.assertAlmostEqual(cable(states.next(), 'crane').rest_length, goal, delta=1e-3)
                states.clear()

    def test_a_tension_is_kept_until_a_length_is_set(self):
        weight = GRAVITY * (PAYLOAD + DENSITY * 2)
        with self.node.states() as states, Messages('/cable/wrench/winch', WrenchStamped) as wrenches:
            # A load that is lighter than what holds it goes up to where the winch stops.
            answer = self.node.set_tension('crane', False, 1.05 * weight, 0.5, 1.2, 2.0)
            self.assertTrue(answer.success, answer.message)
            states.wait_for(lambda s: abs(cable(s, 'crane').rest_length - 1.2) < 1e-3, 'cable of 1.2 m')
            # A spool that turns freely lets it fall.
            self.assertTrue(self.node.set_tension('crane', False, 0, 5, 0.2, 2.0).success)
            states.wait_for(lambda s: cable(s, 'crane').rest_length > 1.9, 'cable of 1.9 m')
            # A brake of less than its weight slips; one of more takes it in again.
            self.assertTrue(self.node.set_length('crane', False, 1.5, 0.5, 2 * weight).success)
            states.wait_for(lambda s: abs(cable(s, 'crane').rest_length - 1.5) < 1e-3, 'cable of 1.5 m')
            rospy.sleep(1.0)
            wrenches.clear()
            rospy.sleep(0.3)
            statics = GRAVITY * (PAYLOAD + DENSITY * 1.5)
            self.assertAlmostEqual(-wrenches.all()[-1].wrench.force.z, statics, delta=0.05 * statics)
            self.assertTrue(self.node.set_length('crane', False, 1.5, 0.5, 0).success)
            states.clear()

    def test_diagnostics_list_winches_that_run(self):
        weight = GRAVITY * (PAYLOAD + DENSITY * 2)

        def told(part):
            with Messages('/diagnostics', DiagnosticArray) as messages:
                messages.wait_for(lambda array: any(value.key == 'winch crane' and part in value.value for status in array.status
                                                    for value in status.values), part)

        self.assertTrue(self.node.set_tension('crane', False, 0.9 * weight, 0.5, 0.2, 2.1).success)
        told(f'at the start, keeps {0.9 * weight} N: ')
        self.assertTrue(self.node.set_tension('crane', False, 0, 0.01, 0.2, 2.1).success)
        told('at the start, free spool: ')
        self.assertTrue(self.node.set_length('crane', False, 2.0, 0.5, 2 * weight).success)
        told(f'at the start, to 2 m with at most {2 * weight} N: ')
        # Without a limit it has done when it has wound.
        self.assertTrue(self.node.set_length('crane', False, 2.0, 0.5, 0).success)
        with Messages('/diagnostics', DiagnosticArray) as messages:
            messages.wait_for(lambda array: any(status.name.endswith('simulation') for status in array.status)
                              and not any(value.key == 'winch crane' for status in array.status for value in status.values),
                              'diagnostics without the winch')

    def test_bad_requests_are_refused(self):
        self.assertTrue(self.node.pause(True).success)
        before = self.node.state()
        for request, part in ((('nothing', False, 1, 1), 'cable: "nothing"'), (('', False, 1, 1), 'cable: ""'),
                              (('x' * 10_000_000, False, 1, 1), 'allowed: crane, line'),
                              (('crane', False, NAN, 1), 'length: nan'), (('crane', False, math.inf, 1), 'length: inf'),
                              (('crane', False, 0, 1), 'length: 0'), (('crane', False, 50, 1), 'limits.segments'),
                              (('crane', True, 1, NAN), 'speed: nan'), (('crane', True, 1, -1), 'speed: -1'),
                              (('crane', True, 1, math.inf), 'speed: inf'), (('line', True, 0.39, 1), 'distance')):
            answer = self.node.set_length(*request, 0)
            self.assertFalse(answer.success, request[0][:20])
            self.assertIn(part, answer.message)
            self.assertLess(len(answer.message), 1000)
        answer = self.node.set_length('crane', False, 1, 1, -1)
        self.assertIn('max_tension: -1', answer.message)
        for tension in (1e300, math.inf, NAN):
            answer = self.node.set_tension('crane', False, tension, 0.5, 0.2, 2.0)
            self.assertFalse(answer.success)
            self.assertIn('allowed: 0 or more [N] (from 0 to 1e+09)', answer.message)
        answer = self.node.set_tension('crane', False, NAN, 0, -1, math.inf)
        self.assertFalse(answer.success)
        for part in ('tension: nan', 'max_speed: 0', 'min_length: -1'):
            self.assertIn(part, answer.message)
        self.assertEqual(contents(self.node.state()), contents(before))
        self.assertTrue(self.node.pause(False).success)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'winch', WinchTest, sys.argv)
