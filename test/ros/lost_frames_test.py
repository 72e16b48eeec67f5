#!/usr/bin/env python3
"""Frames that are lost and come back, under each policy; transforms that are no numbers; frames that are too fast, or jump."""
import math
import sys
import threading
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from rosgraph_msgs.msg import Log
from tf2_msgs.msg import TFMessage

from cable_client import CableClient, Frames, Messages, all_finite, cable, contents, distance, transform
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
        names = ('hold', 'release', 'pause', 'slow', 'brisk')
        cls.hold, cls.release, cls.pause, cls.slow, cls.brisk = (CableClient(f'/policy/{name}') for name in names)

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
            for node, log in zip(nodes, events):
                event = log.wait_for(back, 'FRAME_BACK')
                self.assertEqual(event.other, 'hand')
                self.assertEqual('0.1 m from where it was lost' in event.message, node is not self.release, event.message)
            for log in (states[0], states[2]):
                log.wait_for(lambda s: distance(cable(s, 'rope').positions[0], BACK) < 1e-9, 'rope at the frame that is back')
            states[2].wait_for(lambda s: s.header.stamp.to_nsec() > min(standing), 'simulation that goes on')
            self.assertEqual(cable(self.release.state(), 'rope').attachments, ['fixed'], 'released until reset')
            self.assertTrue(self.release.reset().success)
            self.assertEqual(cable(self.release.state(), 'rope').attachments, ['held', 'fixed'])
        for log in states:
            self.assertTrue(all(all_finite(s) for s in log.all()))
        for log in (states[0], states[2]):
            self.assert_speed(log.all(), 1)

    def assert_speed(self, states, speed):
        """The rope's start moves, and never faster [m/s]."""
        path = [(s.header.stamp.to_sec(), cable(s, 'rope').positions[0].x) for s in states]
        self.assertGreater(max(x for _, x in path) - min(x for _, x in path), 0.05)
        for (t, a), (u, b) in zip(path, path[1:]):
            # stamps are doubles of about 1e9 s, exact to 2e-7 s; a reset puts the rope where its frame is
            self.assertLessEqual(abs(b - a), speed * max(u - t, 0) + 1e-6)

    def test_one_wrong_pose_when_a_frame_comes_back_throws_nothing(self):
        node = self.hold
        with Frames(hand=lambda t: HELD):
            self.start(node)
        with node.states() as states, node.events() as events:
            events.wait_for(lost, 'FRAME_LOST')
            wrong_until = rospy.get_time() + 0.1
            with Frames(hand=lambda t: (5, 0, 1) if t < wrong_until else HELD):
                self.assertIn('5 m from where it was lost', events.wait_for(back, 'FRAME_BACK').message)
                end = rospy.get_time() + 1
                last = states.wait_for(lambda s: s.header.stamp.to_sec() > end, 'state a second later')
            for state in states.all():
                self.assertTrue(-0.01 < cable(state, 'rope').positions[0].x < 0.3, cable(state, 'rope').positions[0])
            self.assertLess(distance(cable(last, 'rope').positions[0], HELD), 1e-6)

    def test_a_second_parent_that_is_in_no_tree_loses_nothing(self):
        publisher = rospy.Publisher('/tf', TFMessage, queue_size=100)
        with Frames(hand=lambda t: HELD):
            self.start(self.hold)
            with self.hold.events() as events, self.hold.states() as states:
                end = rospy.get_time() + 1
                while rospy.get_time() < end:
                    publisher.publish([transform('hand', rospy.get_time(), BACK, parent='nowhere')])
                    rospy.sleep(0.007)
                last = states.wait_for(lambda s: s.header.stamp.to_sec() > end, 'state after it')
                self.assertFalse([event.message for event in events.all() if lost(event)])
        self.assertLess(distance(cable(last, 'rope').positions[0], HELD), 1e-9)

    def test_the_gap_closes_on_top_of_the_frames_own_motion_and_is_in_snapshots(self):
        node = self.brisk
        start = rospy.get_time()

        def moving(time):
            return (0.05 * (time - start), 0, 1)

        def away(time):
            return (moving(time)[0], 0.4, 1)

        def at(motion):
            return lambda s: cable(s, 'rope') and distance(cable(s, 'rope').positions[0], motion(s.header.stamp.to_sec())) < 1e-4

        def run_on(steps):
            self.assertTrue(node.restore_state(name='closing').success)
            answer = node.step(steps)
            self.assertTrue(answer.success, answer.message)
            states.clear()
            # not one of before that comes late
            return states.wait_for(lambda s: abs(s.header.stamp.to_sec() - answer.time) < 1e-6, f'state at {answer.time}')

        with node.states() as states, node.events() as events:
            with Frames(hand=moving):
                states.wait_for(at(moving), 'rope at its frame')
            events.wait_for(lost, 'FRAME_LOST')
            states.clear()
            events.clear()
            with Frames(hand=away):
                self.assertIn('at 0.5 m/s', events.wait_for(back, 'FRAME_BACK').message)
                states.wait_for(lambda s: cable(s, 'rope').positions[0].y > 0.05, 'rope on its way')
                self.assertTrue(node.save_state(name='closing').success)
                states.wait_for(at(away), 'rope at its frame')
                path = [(s.header.stamp.to_sec(), cable(s, 'rope').positions[0]) for s in states.all()]
                for (t, a), (u, b) in zip(path, path[1:]):
                    self.assertLessEqual(b.y - a.y, 0.5 * (u - t) + 1e-6)
                self.assertTrue(node.pause(True).success)
                saved = cable(run_on(1), 'rope').positions[0].y
                first, second = run_on(300), run_on(300)
                self.assertEqual(contents(first), contents(second), 'the same, bit for bit')
                y = cable(second, 'rope').positions[0].y
                self.assertTrue(saved < y <= 0.4, (saved, y))
                self.assertTrue(node.pause(False).success)

    def test_a_jump_is_told_and_carries_the_rope_along(self):
        node = self.hold
        away = (0.3, 0, 1)
        at = [math.inf]  # the time of the jump
        publisher = rospy.Publisher('/tf', TFMessage, queue_size=10)
        frames = Frames(hand=lambda t: HELD if t < at[0] else away)
        with frames, node.events() as events, node.states() as states:
            self.start(node)
            # The frame may have jumped from where the last test left it: of those within a second only the first is told.
            rospy.sleep(1.2)
            states.clear()
            events.clear()
            at[0] = rospy.get_time() + 0.2
            # tf interpolates: both sides of the jump, ahead of time
            publisher.publish([transform('hand', at[0] - 5e-4, HELD), transform('hand', at[0] + 5e-4, away)])
            event = events.wait_for(lambda e: e.type == CableEvent.JUMPED, 'JUMPED')
            self.assertEqual((event.cable, event.attachment, event.node, event.other), ('rope', 'held', 0, 'hand'))
            self.assertRegex(event.message, r'^frame "hand" jumped by 0\.3 m within [12] ms: cable "rope" was carried along with it$')
            states.wait_for(lambda s: distance(cable(s, 'rope').positions[0], away) < 1e-9, 'rope at its frame')
            for state in states.all():
                # struck by 0.3 m in a step or two, it would have some 200 m/s; it swings on
                self.assertLess(max(abs(v.x) for v in cable(state, 'rope').velocities), 5)
        self.assertEqual(len([e for e in events.all() if e.type == CableEvent.JUMPED]), 1)

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

    def test_stamps_in_the_future_do_not_keep_the_frame_from_being_followed(self):
        publisher = rospy.Publisher('/tf', TFMessage, queue_size=10)
        frames = Frames(hand=lambda t: HELD)

        def rope_at(position):
            states.clear()
            states.wait_for(lambda s: distance(cable(s, 'rope').positions[0], position) < 1e-9, f'rope at {position}')

        def refused():
            report = next(s for s in diagnostics.wait_for(lambda a: a.status[0].name.startswith('policy/hold:'), 'report').status
                          if s.name == 'policy/hold: frames')
            diagnostics.clear()
            return next(int(v.value) for v in report.values if v.key == 'refused_transforms')

        with frames, self.hold.events() as events, self.hold.states() as states, Messages('/diagnostics', DiagnosticArray) as diagnostics:
            self.start(self.hold)
            before = refused()
            for ahead in (1.8, 20, 59):
                frames.motions['hand'] = lambda t: HELD
                rope_at(HELD)
                events.clear()
                begin = rospy.get_time()
                publisher.publish([transform('hand', begin + ahead, HELD)])
                rospy.sleep(0.7)  # longer than tf_timeout
                frames.motions['hand'] = lambda t: BACK
                rope_at(BACK)
                self.assertLess(rospy.get_time() - begin, ahead, 'not only when ROS time is there')
                # Next to one that is stored, a late good one is taken for a gap.
                if ahead > 2:
                    self.assertEqual([e.message for e in events.all() if lost(e)], [], ahead)
                rospy.sleep(max(0, begin + 2 - rospy.get_time()))
            diagnostics.clear()
            rospy.sleep(1.5)  # a report a second
            diagnostics.clear()
            self.assertEqual(refused() - before, 2, 'those that are more than 2 s ahead')

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

    def test_unconnected_frames_are_told_once(self):
        apart = '"left_gripper" and "right_gripper" are on tf, but not connected to "world": set frame_id in the scene ' \
                '(to the root of their tree: "base"), or publish a transform between the two'
        waiting = 'not shown yet: "rope", because tf has no transform from "world" to "left_gripper": "left_gripper" is on tf, but ' \
                  'not connected to "world": set frame_id in the scene (to the root of its tree: "base"), or publish a transform ' \
                  'between the two'

        def of_node(name):
            return lambda m: m.name == f'/policy/{name}' and m.level == Log.WARN

        publisher = rospy.Publisher('/tf', TFMessage, queue_size=100)
        connected = threading.Event()

        def send(_):
            transforms = [transform(name, rospy.get_time(), position, parent='base')
                          for name, position in (('left_gripper', HELD), ('right_gripper', (0.7, 0, 1)))]
            publisher.publish(transforms + [transform('base', rospy.get_time())] * connected.is_set())

        with Messages('/rosout', Log) as log:
            timer = rospy.Timer(rospy.Duration(0.02), send)
            self.addCleanup(timer.shutdown)
            # of frames that are missing at all it is told after 5 s
            self.assertEqual(log.wait_for(of_node('apart'), 'warning', 15).msg, apart)
            log.wait_for(lambda m: of_node('waiting')(m) and m.msg == waiting, 'warning of what waits', 15)
            rospy.sleep(2.5)
            self.assertEqual(len([m for m in log.all() if of_node('apart')(m)]), 1)
            log.clear()
            connected.set()
            log.wait_for(lambda m: m.name == '/policy/apart' and 'has appeared on tf' in m.msg, 'frame that has appeared')
            rospy.sleep(1.5)
            self.assertFalse([m.msg for m in log.all() if of_node('apart')(m)])


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'lost_frames', LostFramesTest, sys.argv)
