#!/usr/bin/env python3
"""Each service with good and with bad requests; a refused one says why and changes nothing."""
import math
import sys
import unittest

import rospy
import rostest

from cable_client import CableClient, Frames, arc_length_at, cable, distance, nearest_to, node_at
from verlet_cable.msg import CableEvent, CableLocation

NAN = float('nan')


class ServicesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('services_test')
        cls.frames = Frames(left_hand=lambda t: (0, 0, 1), right_hand=lambda t: (0.6, 0, 1), hook=lambda t: (0.2, 1, 0.8))
        cls.frames.__enter__()
        cls.node = CableClient('/robot/cable')
        with cls.node.states() as states:
            states.wait_for(lambda state: cable(state, 'rope'), 'rope')

    @classmethod
    def tearDownClass(cls):
        cls.frames.__exit__()

    def setUp(self):
        self.assertTrue(self.node.pause(False).success)
        self.assertTrue(self.node.reset().success)

    def assertRefused(self, answer, *parts):
        self.assertFalse(answer.success, answer)
        for part in parts:
            self.assertIn(part, answer.message)

    def test_pin_follows_a_frame_and_unpin_lets_go(self):
        with self.node.events() as events, self.node.states() as states:
            answer = self.node.pin(node_at('chain', 10), (0, 0, -0.1), frame_id='hook', name='hooked')
            self.assertTrue(answer.success, answer.message)
            self.assertEqual((answer.name, answer.node), ('hooked', 10))
            event = events.wait_for(lambda e: e.type == CableEvent.PINNED, 'PINNED')
            self.assertEqual((event.cable, event.attachment, event.node), ('chain', 'hooked', 10))
            held = states.wait_for(lambda s: distance(cable(s, 'chain').positions[10], (0.2, 1, 0.7)) < 1e-9, 'pinned node in place')
            self.assertIn('hooked', cable(held, 'chain').attachments)
            self.assertTrue(self.node.unpin('hooked').success)
            event = events.wait_for(lambda e: e.type == CableEvent.UNPINNED, 'UNPINNED')
            self.assertEqual(event.attachment, 'hooked')
            states.wait_for(lambda s: distance(cable(s, 'chain').positions[10], (0.2, 1, 0.7)) > 0.01 and
                            'hooked' not in cable(s, 'chain').attachments, 'node that fell')

    def test_pin_keeps_the_offset_and_makes_a_name(self):
        self.assertTrue(self.node.pause(True).success)
        before = cable(self.node.state(), 'chain')
        answer = self.node.pin(arc_length_at('chain', 0.26), frame_id='hook', clamp=True, keep_offset=True)
        self.assertTrue(answer.success, answer.message)
        self.assertTrue(answer.name)
        self.assertEqual(answer.node, 5)
        self.assertTrue(self.node.step(100).success)
        p = before.positions[5]
        self.assertLess(distance(cable(self.node.state(), 'chain').positions[5], (p.x, p.y, p.z)), 1e-9)

    def test_pin_at_the_nearest_node(self):
        answer = self.node.pin(nearest_to('', (0, 0.05, -0.4), 'hook'), keep_offset=True)  # (0.2, 1.05, 0.4): near the chain
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.node, 10)

    def test_bad_pins_are_refused_with_all_that_is_wrong(self):
        self.assertTrue(self.node.pause(True).success)
        before = self.node.state()
        self.assertRefused(self.node.pin(node_at('hose', 1)), 'location.cable: "hose"', 'rope, chain')
        self.assertRefused(self.node.pin(node_at('waiting', 1)), 'location.cable: "waiting"', 'waits')
        self.assertRefused(self.node.pin(node_at('chain', 11)), 'location.node: 11', 'allowed: 0 to 10')
        self.assertRefused(self.node.pin(arc_length_at('chain', NAN)), 'location.arc_length: nan')
        self.assertRefused(self.node.pin(node_at('chain', 0)), '"ceiling"')
        self.assertRefused(self.node.pin(node_at('chain', 5), (NAN, 0, 0), (0, 0, 0, 1e-3), frame_id='nowhere', name='left'),
                           'offset.position: (nan', 'offset.orientation: (0, 0, 0, 0.001)', 'frame_id: "nowhere"', 'name: "left"')
        self.assertRefused(self.node.pin(node_at('chain', 10), (0, 1, 0.4)), 'offset.position', '0.6 m', '"ceiling"')
        self.assertRefused(self.node.pin(CableLocation(cable='chain', mode=7)), 'location.mode: 7')
        after = self.node.state()
        self.assertEqual(before.cables, after.cables)

    def test_unpin_takes_attachments_of_the_scene_and_refuses_others(self):
        self.assertRefused(self.node.unpin('nothing'), 'nothing')
        self.assertRefused(self.node.unpin(''))
        with self.node.states() as states:
            self.assertTrue(self.node.unpin('right').success)
            states.wait_for(lambda s: cable(s, 'rope').attachments == ['left'], 'rope held on the left alone')

    def test_cut_leaves_two_cables_and_reset_joins_them(self):
        with self.node.events() as events:
            answer = self.node.cut(node_at('rope', 7))
            self.assertTrue(answer.success, answer.message)
            self.assertEqual(answer.first, 'rope')
            self.assertNotIn('mode', answer.message)
            event = events.wait_for(lambda e: e.type == CableEvent.CUT, 'CUT')
            self.assertEqual((event.cable, event.other, event.node), ('rope', answer.second, 7))
            state = self.node.state()
            first, second = cable(state, 'rope'), cable(state, answer.second)
            self.assertEqual((len(first.positions), len(second.positions)), (8, 13))
            self.assertEqual((first.attachments, second.attachments), (['left'], ['right']))
            self.assertTrue(self.node.reset().success)
            events.wait_for(lambda e: e.type == CableEvent.RESET, 'RESET')
        state = self.node.state()
        self.assertEqual(len(cable(state, 'rope').positions), 21)
        self.assertIsNone(cable(state, answer.second))

    def test_bad_cuts_are_refused(self):
        self.assertRefused(self.node.cut(node_at('rope', 0)), 'location.node: 0', '1 to 18')
        self.assertRefused(self.node.cut(node_at('rope', 20)), 'location.node: 20')
        self.assertRefused(self.node.cut(CableLocation(cable='rope', arc_length=0.6)), 'location.node: 0', 'not location.arc_length, 0.6 m')
        self.assertRefused(self.node.cut(arc_length_at('rope', 1.5)), 'location.arc_length: 1.5', '0 to 1')
        self.assertRefused(self.node.cut(nearest_to('rope', (NAN, 0, 0))), 'location.point.point: (nan, 0, 0)')
        self.assertRefused(self.node.cut(nearest_to('rope', (0, 0, 0), 'nowhere')), 'frame_id: "nowhere"')
        self.assertEqual(len(cable(self.node.state(), 'rope').positions), 21)

    def test_paused_messages_go_on_with_the_standing_stamp_and_steps_are_counted(self):
        self.assertTrue(self.node.pause(True).success)
        with self.node.states() as states:
            states.next()
            states.clear()
            rospy.sleep(0.5)
            standing = states.all()
            self.assertAlmostEqual(len(standing), 25, delta=6)  # 0.5 s at 50 Hz, on a busy machine
            self.assertEqual(len({s.header.stamp.to_nsec() for s in standing}), 1)
            stamp = standing[0].header.stamp.to_nsec()
            answer = self.node.step(25)
            self.assertTrue(answer.success, answer.message)
            self.assertAlmostEqual(answer.time, stamp * 1e-9 + 0.025, delta=1e-6)  # a double of about 1e9 s
            states.wait_for(lambda s: s.header.stamp.to_nsec() == stamp + 25 * 10**6, 'state after the steps')
            self.assertTrue(self.node.pause(False).success)
            running = states.wait_for(lambda s: s.header.stamp.to_nsec() > stamp + 100 * 10**6, 'running state')
            self.assertAlmostEqual((rospy.Time.now() - running.header.stamp).to_sec(), 0.08, delta=0.08)

    def test_what_is_ahead_of_ros_time_goes_back_to_it_when_it_runs_again(self):
        self.assertTrue(self.node.pause(True).success)
        ahead = self.node.step(20000).time
        self.assertGreater(ahead, rospy.get_time() + 5)
        with self.node.states() as states, self.node.events() as events:
            self.assertTrue(self.node.pause(False).success)
            self.assertIn('ahead of ROS time', events.wait_for(lambda e: e.type == CableEvent.TIME_JUMP, 'TIME_JUMP').message)
            running = states.wait_for(lambda s: s.header.stamp.to_sec() < ahead - 1, 'state of now')
            states.wait_for(lambda s: s.header.stamp > running.header.stamp and s.header.stamp.to_sec() < ahead - 1, 'next state')
            self.assertAlmostEqual((rospy.Time.now() - running.header.stamp).to_sec(), 0.2, delta=0.2)

    def test_steps_are_refused_while_running_and_in_silly_numbers(self):
        self.assertRefused(self.node.step(5), 'not paused')
        self.assertTrue(self.node.pause(True).success)
        self.assertRefused(self.node.step(0), 'steps: 0')
        self.assertRefused(self.node.step(2**32 - 1), 'steps: 4294967295')

    def test_reset_brings_back_the_first_state(self):
        self.assertTrue(self.node.pause(True).success)
        self.assertTrue(self.node.reset().success)
        first = cable(self.node.state(), 'rope')
        self.assertTrue(self.node.unpin('left').success)
        self.assertTrue(self.node.step(300).success)
        moved = cable(self.node.state(), 'rope')
        self.assertGreater(math.dist((moved.positions[0].x, moved.positions[0].z), (0, 1)), 0.1)
        self.assertTrue(self.node.reset().success)
        again = cable(self.node.state(), 'rope')
        self.assertEqual(again.attachments, first.attachments)
        # tf's interpolation rounds: a frame at rest is not at the same bits at all times.
        for before, after in zip(first.positions + first.velocities, again.positions + again.velocities):
            self.assertLess(math.dist((before.x, before.y, before.z), (after.x, after.y, after.z)), 1e-9)

    def test_what_waited_when_it_was_saved_starts_when_it_is_restored(self):
        self.assertIsNone(cable(self.node.state(), 'waiting'))
        self.assertTrue(self.node.save_state(name='before').success)
        with Frames(late_hand=lambda t: (0, 3, 1)), self.node.states() as states:
            states.wait_for(lambda s: cable(s, 'waiting'), 'cable whose frame has come')
            self.assertTrue(self.node.restore_state(name='before').success)
            stamp = self.node.state().header.stamp
            states.wait_for(lambda s: s.header.stamp > stamp and cable(s, 'waiting'), 'the same after it was restored')


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'services', ServicesTest, sys.argv)
