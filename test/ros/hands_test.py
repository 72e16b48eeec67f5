#!/usr/bin/env python3
"""Interactive markers: what is shown, what a drag and a menu do, and what of rviz's feedback is refused."""
import math
import sys
import unittest

import rospy
import rostest
from geometry_msgs.msg import Point, Pose, Quaternion
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerInit, InteractiveMarkerUpdate

from cable_client import CableClient, Frames, Messages, cable, contents, distance
from verlet_cable.msg import CableEvent

PIN, RELEASE, CUT, RESET = 1, 2, 3, 4  # entries of the menus
NAN = float('nan')
QUARTER = (0, 0, math.sqrt(0.5), math.sqrt(0.5))  # turn about z


class Shown:
    """The interactive markers as rviz has them: all at first, then what the updates change."""

    def __init__(self, ns):
        self._full = Messages(f'{ns}/update_full', InteractiveMarkerInit)
        self._updates = Messages(f'{ns}/update', InteractiveMarkerUpdate)

    def __enter__(self):
        self._updates.__enter__()
        self._full.__enter__()
        return self

    def __exit__(self, *_):
        self._full.__exit__()
        self._updates.__exit__()

    def wait_for(self, wanted, what):
        """The markers by name, as soon as they are as `wanted`."""
        full = self._full.wait_for(lambda message: wanted({m.name: m for m in message.markers}), what)
        return {m.name: m for m in full.markers}

    def clear(self):
        self._full.clear()

    def poses(self):
        return [m.pose for message in self._full.all() + self._updates.all() for m in message.markers] + \
            [p.pose for message in self._updates.all() for p in message.poses]


def is_finite(pose):
    p, q = pose.position, pose.orientation
    return all(math.isfinite(v) for v in (p.x, p.y, p.z, q.x, q.y, q.z, q.w))


class HandsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('hands_test')
        cls.frames = Frames(left_hand=lambda t: (0, 0, 1), right_hand=lambda t: (0.6, 0, 1))
        cls.frames.__enter__()
        cls.node = CableClient('/robot/cable')
        cls.mouse = rospy.Publisher('/robot/cable/hands/feedback', InteractiveMarkerFeedback, queue_size=100)
        with cls.node.states() as states:
            states.wait_for(lambda state: cable(state, 'rope'), 'rope')
        cls.shown = Shown('/robot/cable/hands')
        cls.shown.__enter__()
        while cls.mouse.get_num_connections() == 0:
            rospy.sleep(0.01)

    @classmethod
    def tearDownClass(cls):
        cls.shown.__exit__()
        cls.frames.__exit__()

    def setUp(self):
        self.assertTrue(self.node.pause(False).success)
        self.assertTrue(self.node.reset().success)
        self.shown.clear()
        self.shown.wait_for(lambda markers: 'rope/10' in markers and 'attachment/right' in markers, 'all handles')

    def send(self, marker, event, position=(0, 0, 0), orientation=(0, 0, 0, 1), frame='world', entry=0):
        feedback = InteractiveMarkerFeedback(marker_name=marker, event_type=event, menu_entry_id=entry, client_id='test')
        feedback.header.frame_id = frame
        feedback.header.stamp = rospy.Time.now()
        feedback.pose = Pose(Point(*position), Quaternion(*orientation))
        self.mouse.publish(feedback)

    def drag(self, marker, *position, **kinds):
        self.send(marker, InteractiveMarkerFeedback.POSE_UPDATE, position, **kinds)

    def select(self, marker, entry):
        self.send(marker, InteractiveMarkerFeedback.MENU_SELECT, entry=entry)

    def test_handles_of_attachments_and_of_nodes_that_nothing_holds(self):
        self.shown.clear()
        markers = self.shown.wait_for(lambda _: True, 'handles')
        nodes = {f'rope/{i}' for i in range(1, 20)} | {f'chain/{i}' for i in range(1, 11)}
        self.assertEqual(set(markers), nodes | {f'attachment/{name}' for name in ('left', 'right', 'ceiling', 'upper', 'lower')})
        self.assertEqual(len(markers['attachment/left'].controls), 4)   # taken, three arrows
        self.assertEqual(len(markers['attachment/right'].controls), 7)  # and three rings: a clamp
        self.assertEqual([e.id for e in markers['attachment/left'].menu_entries], [RELEASE, CUT, RESET])
        self.assertEqual([e.id for e in markers['attachment/upper'].menu_entries], [RELEASE, RESET])
        self.assertEqual([e.id for e in markers['rope/3'].menu_entries], [PIN, CUT, RESET])
        self.assertLess(distance(markers['attachment/right'].pose.position, (0.7, 0, 1)), 1e-6)

    def test_who_comes_late_gets_all_handles_as_they_are_now(self):
        for _ in range(2):
            with Messages('/robot/cable/hands/update', InteractiveMarkerUpdate) as updates:
                number = updates.next().seq_num
                with Messages('/robot/cable/hands/update_full', InteractiveMarkerInit) as late:
                    full = late.wait_for(lambda _: True, 'handles')
            self.assertIn('rope/10', {m.name for m in full.markers})
            self.assertGreaterEqual(full.seq_num, number)
            self.assertEqual(full._connection_header['latching'], '0', 'what nobody listens to is put together')

    def test_poses_are_sent_of_what_moves_and_of_what_a_viewer_has_moved(self):
        def poses_of(update):
            return {p.name for p in update.poses}

        self.assertTrue(self.node.pause(True).success)
        with Messages('/robot/cable/hands/update', InteractiveMarkerUpdate) as updates:
            updates.wait_for(lambda m: m.type == InteractiveMarkerUpdate.UPDATE and not m.poses, 'update without poses')
            # no mouse button was pressed: nothing moves but in the viewer
            self.send('rope/7', InteractiveMarkerFeedback.MOUSE_UP)
            updates.wait_for(lambda m: poses_of(m) == {'rope/7'}, 'pose of what a viewer has moved')
            updates.clear()
            updates.wait_for(lambda m: m.type == InteractiveMarkerUpdate.UPDATE and not m.poses, 'update without poses, again')
            self.assertTrue(self.node.pause(False).success)
            self.drag('attachment/left', 0, 0.1, 1.1)
            updates.wait_for(lambda m: {'attachment/left', 'rope/10'} <= poses_of(m), 'poses of what moves')

    def test_handles_of_nodes_are_not_seen(self):
        self.shown.clear()
        markers = self.shown.wait_for(lambda _: True, 'handles')
        for name, marker in markers.items():
            seen = [shape.color.a > 0 for control in marker.controls for shape in control.markers]
            self.assertEqual(any(seen), name.startswith('attachment/'), name)

    def test_a_dragged_attachment_moves_in_its_frame(self):
        with self.node.states() as states:
            self.drag('attachment/left', 0, 0.1, 1.1)
            states.wait_for(lambda s: distance(cable(s, 'rope').positions[0], (0, 0.1, 1.1)) < 1e-6, 'start at the mouse')
            self.drag('attachment/left', 0.05, 0, 0, frame='right_hand')
            states.wait_for(lambda s: distance(cable(s, 'rope').positions[0], (0.65, 0, 1)) < 1e-6, 'start in another frame')
            self.frames.motions['left_hand'] = lambda t: (0, 0, 1.2)
            states.wait_for(lambda s: distance(cable(s, 'rope').positions[0], (0.65, 0, 1.2)) < 1e-3, 'start that follows its frame')
            self.frames.motions['left_hand'] = lambda t: (0, 0, 1)
            self.assertTrue(self.node.reset().success)
            states.wait_for(lambda s: distance(cable(s, 'rope').positions[0], (0, 0, 1)) < 1e-3, 'start as in the scene')

    def test_what_holds_a_net_is_dragged_and_released(self):
        def node(state, number):
            return state.nets[0].positions[number]

        with self.node.states() as states:
            self.drag('attachment/upper', 0.05, 3, 1.05)
            states.wait_for(lambda s: distance(node(s, 0), (0.05, 3, 1.05)) < 1e-6, 'corner at the mouse')
            self.select('attachment/upper', CUT)  # not in its menu
            self.select('attachment/upper', RELEASE)
            states.wait_for(lambda s: node(s, 0).z < 0.8, 'corner that falls')
        self.assertLess(distance(node(self.node.state(), 8), (0, 3, 0.8)), 1e-9)

    def test_a_drag_is_smooth(self):
        with self.node.states() as states:
            for i in range(1, 21):
                self.drag('attachment/left', 0.01 * i, 0, 1)
                rospy.sleep(0.03)
            states.wait_for(lambda s: distance(cable(s, 'rope').positions[0], (0.2, 0, 1)) < 1e-6, 'start at the mouse')
            speeds = [math.hypot(v.x, v.y, v.z) for v in (cable(s, 'rope').velocities[0] for s in states.all())]
        self.assertGreater(max(speeds), 0.1)
        self.assertLess(max(speeds), 1.5)  # 0.33 m/s on the whole, in jumps of 10 mm that would be 10 m/s in a step

    def test_a_clamp_turns(self):
        self.send('attachment/right', InteractiveMarkerFeedback.POSE_UPDATE, (0.7, 0, 1), QUARTER)

        def along_y(state):
            *_, before, end = cable(state, 'rope').positions
            return end.y - before.y > 0.0499
        with self.node.states() as states:
            states.wait_for(along_y, 'last segment along y')

    def test_an_attachment_goes_no_further_than_the_cable_reaches(self):
        with self.node.states() as states:
            self.drag('attachment/left', -5, 0, 1)
            states.wait_for(lambda s: distance(cable(s, 'rope').positions[0], (-0.299, 0, 1)) < 1e-5, 'start at the end of its reach')

    def test_a_node_is_held_as_long_as_the_button_is_down(self):
        with self.node.states() as states:
            self.drag('chain/10', 0.2, 1, 0.9)
            states.wait_for(lambda s: distance(cable(s, 'chain').positions[10], (0.2, 1, 0.9)) < 1e-6, 'node at the mouse')
            self.shown.clear()
            markers = self.shown.wait_for(lambda _: True, 'handles')
            self.assertIn('chain/10', markers)
            self.assertEqual(sum(name.startswith('attachment/') for name in markers), 5)
            self.send('chain/10', InteractiveMarkerFeedback.MOUSE_UP)
            states.wait_for(lambda s: cable(s, 'chain').attachments == ['ceiling'] and
                            distance(cable(s, 'chain').positions[10], (0.2, 1, 0.9)) > 0.05, 'node that fell')

    def test_a_node_falls_when_rviz_is_heard_of_no_more(self):
        with self.node.states() as states:
            self.drag('chain/5', 0.1, 1, 0.9)
            states.wait_for(lambda s: len(cable(s, 'chain').attachments) == 2, 'held node')
            rospy.sleep(1.5)
            self.send('chain/5', InteractiveMarkerFeedback.KEEP_ALIVE)
            rospy.sleep(1.5)
            states.clear()
            states.wait_for(lambda s: len(cable(s, 'chain').attachments) == 2, 'held node')
            states.wait_for(lambda s: cable(s, 'chain').attachments == ['ceiling'], 'released node')

    def test_menu(self):
        with self.node.events() as events:
            self.select('chain/10', PIN)
            pinned = events.wait_for(lambda e: e.type == CableEvent.PINNED, 'PINNED')
            self.assertEqual((pinned.cable, pinned.node), ('chain', 10))
            name = 'attachment/' + pinned.attachment
            self.shown.wait_for(lambda markers: name in markers and 'chain/10' not in markers, 'handle of the pin')
            self.select(name, RELEASE)
            events.wait_for(lambda e: e.type == CableEvent.UNPINNED and e.attachment == pinned.attachment, 'UNPINNED')
            self.select('rope/7', CUT)
            cut = events.wait_for(lambda e: e.type == CableEvent.CUT, 'CUT')
            self.assertEqual((cut.cable, cut.node), ('rope', 7))
            self.shown.wait_for(lambda m: f'{cut.other}/0' in m and 'rope/7' in m and 'rope/8' not in m, 'handles of both pieces')
            self.select('rope/3', RESET)
            events.wait_for(lambda e: e.type == CableEvent.RESET, 'RESET')
            self.shown.clear()
            self.shown.wait_for(lambda m: 'rope/19' in m and f'{cut.other}/0' not in m, 'handles of the whole rope')

    def test_bad_feedback_changes_nothing(self):
        self.assertTrue(self.node.pause(True).success)
        before = self.node.state()
        for marker in ('attachment/left', 'chain/10'):
            self.drag(marker, NAN, 0, 1)
            self.drag(marker, math.inf, 0, 1)
            self.drag(marker, 2e9, 0, 1)
            self.drag(marker, 0, 0, 1, orientation=(0, 0, 0, 0.3))
            self.drag(marker, 0, 0, 1, orientation=(NAN, 0, 0, 1))
            self.drag(marker, 0, 0, 1, frame='nowhere')
            self.drag(marker, 0, 0, 1, frame='x' * 10**6)
            self.select(marker, 77)
        for marker in ('', 'attachment/nothing', 'chain/11', 'nobody/0', 'x' * 10**6):
            self.drag(marker, 0, 0, 1)
            self.select(marker, PIN)
        self.select('attachment/left', PIN)     # held already
        self.select('chain/10', RELEASE)        # nothing to release
        self.select('attachment/left', CUT)     # no piece would be left
        self.send('chain/10', InteractiveMarkerFeedback.MOUSE_UP)
        self.send('chain/10', 200)
        rospy.sleep(0.5)
        self.assertEqual(contents(before)[2:], contents(self.node.state())[2:])
        self.assertTrue(self.node.step(200).success)
        self.assertLess(distance(cable(self.node.state(), 'rope').positions[0], (0, 0, 1)), 1e-9)
        self.assertTrue(all(is_finite(pose) for pose in self.shown.poses()))

    def load_first_scene(self):
        with open(sys.argv[1]) as file:
            self.assertTrue(self.node.load_scene(yaml=file.read()).success)

    def test_another_scene_has_other_handles(self):
        scene = '{cables: [{name: wire, length: 1, segments: 400, material: steel_wire_rope_4mm, ' \
                'attachments: [{name: hook, at: start}]}]}'
        self.addCleanup(self.load_first_scene)
        answer = self.node.load_scene(yaml=scene)
        self.assertTrue(answer.success, answer.message)
        self.shown.clear()
        markers = self.shown.wait_for(lambda m: 'attachment/hook' in m and 'rope/10' not in m, 'handles of the other scene')
        self.assertEqual(len(markers), 1 + 134)  # every third node, and the last


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'hands', HandsTest, sys.argv)
