#!/usr/bin/env python3
"""Frames that are lost and come back, under each policy; transforms that are no numbers; frames that are too fast."""
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from tf2_msgs.msg import TFMessage

from cable_client import CableClient, Frames, Messages, all_finite, cable, distance, transform
from verlet_cable.msg import CableEvent

HELD = (0, 0, 1)
BACK = (0.1, 0, 1)
NAN = float('nan')


def lost(event):
    return event.type == CableEvent.FRAME_LOST


def back(event):
    return event.type == CableEvent.FRAME_BACK


class LostFramesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('lost_frames_test')
        cls.hold, cls.release, cls.pause, cls.slow = (CableClient(f'/policy/{name}') for name in ('hold', 'release', 'pause', 'slow'))

    def start(self, node):
        """With the frame there: from the beginning of the scene."""
        with node.states() as states:
            states.wait_for(lambda s: cable(s, 'rope') and distance(cable(s, 'rope').positions[0], HELD) < 1e-9, 'rope at its frame')
        self.assertTrue(node.reset().success)

    def collect(self, messages):
        """Until the end of the test."""
        self.addCleanup(messages.__exit__)
        return messages.__enter__()

    def test_hold_release_and_pause(self):
        nodes = (self.hold, self.release, self.pause)
        with Frames(hand=lambda t: HELD):
            for node in nodes:
                self.start(node)
            rospy.sleep(0.2)
            events = [self.collect(node.events()) for node in nodes]
            states = [self.collect(node.states()) for node in nodes]
            last = rospy.get_time()
        holding, releasing, pausing = events
        for log in events:
            event = log.wait_for(lost, 'FRAME_LOST')
            self.assertEqual((event.cable, event.attachment, event.node, event.other), ('rope', 'held', 0, 'hand'))
            # the simulated time is that of the newest pose: 10 ms before the end of sending, and as much for a busy machine
            self.assertAlmostEqual(event.header.stamp.to_sec(), last - 0.01, delta=0.04)
        released = releasing.wait_for(lambda e: e.type == CableEvent.UNPINNED, 'UNPINNED')
        self.assertEqual(released.attachment, 'held')
        for log in states:
            log.clear()
        rospy.sleep(0.3)
        for state in states[0].all():
            self.assertLess(distance(cable(state, 'rope').positions[0], HELD), 1e-9)
        self.assertEqual(cable(states[1].all()[-1], 'rope').attachments, ['fixed'])
        standing = {s.header.stamp.to_nsec() for s in states[2].all()}
        self.assertEqual(len(standing), 1, 'paused')
        self.assertGreater(len(states[2].all()), 5, 'messages go on')

        with Frames(hand=lambda t: BACK):
            for log in events:
                self.assertEqual(log.wait_for(back, 'FRAME_BACK').other, 'hand')
            for log in (states[0], states[2]):
                log.wait_for(lambda s: distance(cable(s, 'rope').positions[0], BACK) < 1e-9, 'rope at the frame that is back')
            states[2].wait_for(lambda s: s.header.stamp.to_nsec() > min(standing), 'simulation that goes on')
            self.assertEqual(cable(self.release.state(), 'rope').attachments, ['fixed'], 'released until reset')
            self.assertTrue(self.release.reset().success)
            self.assertEqual(cable(self.release.state(), 'rope').attachments, ['held', 'fixed'])
        for log in states:
            self.assertTrue(all(all_finite(s) for s in log.all()))

    def test_transforms_that_are_no_numbers_are_refused_and_lose_the_frame(self):
        publisher = rospy.Publisher('/tf', TFMessage, queue_size=10)
        with Frames(hand=lambda t: HELD):
            self.start(self.hold)
        with self.hold.events() as events, self.hold.states() as states, Messages('/diagnostics', DiagnosticArray) as diagnostics:
            for bad in (dict(position=(NAN, 0, 0)), dict(rotation=(0, 0, 0, 0)), dict(rotation=(NAN, 0, 0, 1))) * 20:
                publisher.publish([transform('hand', rospy.get_time(), **bad)])
                rospy.sleep(0.01)
            events.wait_for(lost, 'FRAME_LOST')
            status = diagnostics.wait_for(lambda a: any(s.name == 'policy/hold: frames' and s.level for s in a.status), 'warning')
            frames = next(s for s in status.status if s.name == 'policy/hold: frames')
            self.assertEqual(frames.level, DiagnosticStatus.WARN)
            self.assertIn('refused', frames.message)
            states.next(10)
            for state in states.all():
                self.assertTrue(all_finite(state))
                self.assertLess(distance(cable(state, 'rope').positions[0], HELD), 1e-9)

    def test_a_frame_that_is_too_fast_is_followed_at_the_limit(self):
        speed = 0.1  # [m/s] max_frame_speed of the node
        frames = Frames(hand=lambda t: HELD)
        with frames, self.slow.states() as states, Messages('/diagnostics', DiagnosticArray) as diagnostics:
            self.start(self.slow)
            rospy.sleep(0.2)
            states.clear()
            frames.motions['hand'] = lambda t: BACK  # 0.1 m away, at once
            states.wait_for(lambda s: distance(cable(s, 'rope').positions[0], BACK) < 1e-9, 'rope at the frame')
            x = [(s.header.stamp.to_sec(), cable(s, 'rope').positions[0].x) for s in states.all()]
            for (t, a), (u, b) in zip(x, x[1:]):
                # stamps are doubles of about 1e9 s, exact to 2e-7 s
                self.assertLessEqual(abs(b - a), speed * (u - t) + 1e-6)
            diagnostics.wait_for(lambda a: any('too fast' in s.message for s in a.status), 'warning')


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'lost_frames', LostFramesTest, sys.argv)
