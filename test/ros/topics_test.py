#!/usr/bin/env python3
"""What a running node publishes: rates, stamps, and attachments that are where tf says they are at the stamp."""
import contextlib
import math
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import PointCloud2
from visualization_msgs.msg import MarkerArray

from cable_client import CableClient, Frames, Messages, all_finite, cable, distance
from verlet_cable.msg import CableArray

RATE = 50  # [Hz] the default
GRAVITY = 9.81


def left_hand(t):
    return 0.2 * math.sin(3 * t), 0.1 * math.cos(2 * t), 1


def right_hand(t):
    turn = 0.5 * math.sin(t)
    return (0.6, 0.05 * math.sin(t), 1), (0, 0, math.sin(turn / 2), math.cos(turn / 2))


def stamp_of(message):
    """[ns]"""
    return (message.markers[0] if isinstance(message, MarkerArray) else message).header.stamp.to_nsec()


class TopicsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('topics_test')
        cls.frames = Frames(left_hand=left_hand, right_hand=right_hand)
        cls.frames.__enter__()
        cls.node = CableClient('/robot/cable')
        with cls.node.states() as states:
            states.wait_for(lambda state: cable(state, 'rope'), 'rope')

    @classmethod
    def tearDownClass(cls):
        cls.frames.__exit__()

    def test_every_topic_comes_at_the_rate_and_with_the_stamps_of_the_ticks(self):
        kinds = {'state': CableArray, 'points': PointCloud2, 'markers': MarkerArray, 'wrench/left': WrenchStamped}
        with contextlib.ExitStack() as stack:
            logs = {topic: stack.enter_context(Messages(f'/robot/cable/{topic}', kind)) for topic, kind in kinds.items()}
            rospy.sleep(1.5)
            stamps = {topic: [stamp_of(message) for message in log.all()] for topic, log in logs.items()}
        for topic, seen in stamps.items():
            self.assertGreater(len(seen), 1.5 * RATE / 2, topic)  # connecting takes a while
            gaps = {b - a for a, b in zip(seen, seen[1:])}
            self.assertEqual(gaps, {10**9 // RATE}, topic)
            self.assertEqual({stamp % (10**9 // RATE) for stamp in seen}, {0}, topic)
        first = max(seen[0] for seen in stamps.values())
        last = min(seen[-1] for seen in stamps.values())
        common = {topic: [s for s in seen if first <= s <= last] for topic, seen in stamps.items()}
        for topic, seen in common.items():
            self.assertEqual(seen, common['state'], topic)

    def test_stamps_are_tf_latency_behind_the_time(self):
        with self.node.states() as states:
            state = states.next(5)
            # a tick and an update late at most, and as much again for a busy machine
            self.assertAlmostEqual((rospy.Time.now() - state.header.stamp).to_sec(), 0.05 + 0.03, delta=0.05)
            self.assertEqual(state.header.frame_id, 'world')

    def test_attachments_are_where_their_frames_are_at_the_stamp(self):
        with self.node.states() as states:
            states.next(25)
            for state in states.all():
                rope = cable(state, 'rope')
                t = state.header.stamp.to_sec()
                # tf interpolates between samples 10 to 20 ms apart: at most a (0.02 s)^2 / 8, with a = 0.2 * 3^2 m/s^2
                self.assertLess(distance(rope.positions[0], left_hand(t)), 1e-4)
                (x, y, z), (_, _, qz, qw) = right_hand(t)
                turn = 2 * math.atan2(qz, qw)
                # the offset of the attachment, 0.1 m along the frame's x axis
                self.assertLess(distance(rope.positions[-1], (x + 0.1 * math.cos(turn), y + 0.1 * math.sin(turn), z)), 1e-4)
                self.assertTrue(all_finite(state))

    def test_a_cable_is_not_there_before_its_frames_and_one_with_initial_poses_is(self):
        state = self.node.state()
        self.assertIsNone(cable(state, 'waiting'))
        patient = cable(state, 'patient')
        self.assertLess(distance(patient.positions[0], (0, 2, 1)), 1e-9)
        with Frames(late_hand=lambda t: (1, 1, 1), later_hand=lambda t: (0.05, 2, 1)), self.node.states() as states:
            appeared = states.wait_for(lambda state: cable(state, 'waiting'), 'cable whose frame came')
            self.assertLess(distance(cable(appeared, 'waiting').positions[0], (1, 1, 1)), 1e-9)
            states.wait_for(lambda state: distance(cable(state, 'patient').positions[0], (0.05, 2, 1)) < 1e-9, 'patient cable that moved')

    def test_the_wrench_carries_the_hanging_weight(self):
        with Messages('/robot/cable/wrench/ceiling', WrenchStamped) as wrenches:
            # 0.05 kg that have hung still from a fixed point since the start
            wrench = wrenches.next(5).wrench
            self.assertAlmostEqual(wrench.force.z, -0.05 * GRAVITY, delta=1e-6)

    def test_diagnostics_tell_how_the_simulation_and_the_frames_are(self):
        with Messages('/diagnostics', DiagnosticArray) as messages:
            def status(array, name):
                return next((s for s in array.status if s.name == f'robot/cable: {name}' and s.values), None)
            array = messages.wait_for(lambda a: status(a, 'simulation') and status(a, 'frames'), 'status of the node')
            values = {v.key: v.value for v in status(array, 'simulation').values}
            self.assertGreater(float(values['real_time_factor']), 1)
            for key in ('step_time_mean_s', 'step_time_max_s', 'dropped_time_s', 'max_strain', 'faults'):
                self.assertGreaterEqual(float(values[key]), 0, key)
            frames = {v.key: v.value for v in status(array, 'frames').values}
            self.assertIn('age', frames['frame left_hand'])


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'topics', TopicsTest, sys.argv)
