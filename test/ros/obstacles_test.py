#!/usr/bin/env python3
"""Obstacles in the markers, contacts in the state, and the topic that adds, moves and removes obstacles."""
import math
import sys
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from visualization_msgs.msg import Marker, MarkerArray

from cable_client import CableClient, Frames, Messages, all_finite, cable
from verlet_cable.msg import Appearance, CableEvent, Solid

NAN = float('nan')


def marker(number, kind=Marker.CUBE, action=Marker.ADD, frame='world', position=(0, 1, 1), scale=(0.1, 0.1, 0.1), ns='seen',
           **fields):
    message = Marker(ns=ns, id=number, type=kind, action=action, **fields)
    message.header.frame_id = frame
    message.pose = Pose(Point(*position), Quaternion(0, 0, 0, 1))
    message.scale = Vector3(*scale)
    return message


def shown(markers):
    return [m for m in markers.markers if m.ns == 'obstacles' and m.action == Marker.ADD]


class ObstaclesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('obstacles_test')
        cls.frames = Frames()
        cls.frames.__enter__()
        cls.node = CableClient('/cable')
        cls.publisher = rospy.Publisher('/cable/obstacles', MarkerArray, queue_size=10)
        with cls.node.states() as states:
            states.wait_for(lambda state: cable(state, 'rope'), 'rope')
        while cls.publisher.get_num_connections() == 0:
            rospy.sleep(0.05)

    @classmethod
    def tearDownClass(cls):
        cls.frames.__exit__()

    def setUp(self):
        self.frames.motions.clear()
        self.send(marker(0, action=Marker.DELETEALL))

    def send(self, *markers):
        self.publisher.publish(list(markers))

    def wait_for_shown(self, wanted, what):
        with Messages('/cable/markers', MarkerArray) as messages:
            return shown(messages.wait_for(lambda m: wanted(shown(m)), what))

    def wait_for_diagnostics(self, key, part):
        def has(message):
            return any(value.key == key and part in value.value for status in message.status for value in status.values)
        with Messages('/diagnostics', DiagnosticArray) as messages:
            messages.wait_for(has, '%s in %s' % (part, key))

    def test_obstacles_of_the_scene_are_shown(self):
        markers = self.wait_for_shown(lambda found: len(found) >= 4, 'floor and pill')
        kinds = [m.type for m in markers]
        self.assertEqual(kinds.count(Marker.CYLINDER), 1)
        floor = next(m for m in markers if m.type == Marker.TRIANGLE_LIST)
        self.assertEqual(kinds.count(Marker.TRIANGLE_LIST), 1)
        self.assertAlmostEqual(floor.pose.position.z, 0)
        for point in floor.points:  # a little below the plane, where rviz draws its grid
            self.assertAlmostEqual(point.z, -0.002)
        for axis in ('x', 'y'):
            self.assertLess(min(getattr(point, axis) for point in floor.points), -2.5)
            self.assertGreater(max(getattr(point, axis) for point in floor.points), 2.5)
        self.assertEqual(len({m.id for m in markers}), len(markers))

    def test_what_a_camera_needs_of_them_is_exact(self):
        self.frames.motions['forearm'] = lambda t: (4, 0, 1)
        with Messages('/cable/appearance', Appearance) as appearances:
            seen = appearances.wait_for(lambda a: any(s.name == 'forearm' and s.pose.position.x > 3.9 for s in a.solids), 'forearm')
        self.assertEqual(seen.header.frame_id, 'world')
        self.assertEqual([(look.name, list(look.radii)) for look in seen.looks], [('rope', [0.01])])
        solids = {solid.name: solid for solid in seen.solids}
        floor, pill, forearm = solids['floor'], solids['pill'], solids['forearm']
        self.assertEqual((floor.type, floor.owner, floor.pose.position.z), (Solid.PLANE, Solid.OBSTACLE, 0))
        self.assertEqual((pill.type, pill.radius, pill.length), (Solid.CAPSULE, 0.1, 0.3))
        self.assertEqual((pill.pose.position.y, pill.pose.position.z), (2, 1))
        # Without the padding that keeps cables away from it.
        self.assertEqual((forearm.type, forearm.owner, forearm.radius), (Solid.SPHERE, Solid.LINK, 0.07))

    def test_what_lies_on_the_floor_touches_it(self):
        with self.node.states() as states:
            state = states.wait_for(lambda s: len(cable(s, 'rope').contacts) > 10, 'contacts')
        self.assertTrue(all_finite(state))
        rope = cable(state, 'rope')
        self.assertEqual({c.other for c in rope.contacts}, {'floor'})
        for contact in rope.contacts:
            self.assertAlmostEqual(contact.normal.z, 1)
            self.assertLess(contact.segment, 20)
            self.assertAlmostEqual(contact.position.z, 0.01, delta=0.002)

    def test_links_and_obstacles_follow_their_frames(self):
        self.frames.motions['cart'] = lambda t: (3, 0, 1)
        self.frames.motions['forearm'] = lambda t: (4, 0, 1)
        markers = self.wait_for_shown(lambda found: {3, 4} <= {round(m.pose.position.x) for m in found}, 'cart and forearm')
        forearm = next(m for m in markers if round(m.pose.position.x) == 4)
        self.assertEqual(forearm.type, Marker.SPHERE)
        self.assertAlmostEqual(forearm.scale.x, 0.14)
        with self.node.events() as events:
            del self.frames.motions['cart']
            lost = events.wait_for(lambda e: e.type == CableEvent.FRAME_LOST, 'FRAME_LOST')
        self.assertEqual((lost.other, lost.attachment), ('cart', ''))
        self.wait_for_diagnostics('obstacle cart', 'cart')
        self.wait_for_shown(lambda found: 3 in {round(m.pose.position.x) for m in found}, 'the cart where it was')

    def test_a_cable_that_is_found_inside_is_told(self):
        self.send(marker(1, position=(0, 0, 0.02)))
        self.wait_for_diagnostics('found_inside_obstacles', 'rope in ')

    def test_no_more_than_a_thousand_that_were_inside_are_remembered(self):
        for message in range(24):
            self.send(*[marker(number, ns=f'new{message}', position=(0, 0, 0.02)) for number in range(100)])
            rospy.sleep(0.1)
            self.send(marker(0, action=Marker.DELETEALL))
        self.wait_for_diagnostics('found_inside_obstacles', ' and 980 more')

    def test_markers_add_move_and_delete(self):
        before = self.wait_for_shown(lambda found: len(found) >= 4, 'floor and pill')
        others = {m.id for m in before}
        self.send(marker(1, position=(0, 5, 1)), marker(2, Marker.SPHERE, position=(0, 6, 1)),
                  marker(3, Marker.CYLINDER, position=(0, 7, 1), scale=(0.2, 0.2, 0.5)))
        added = self.wait_for_shown(lambda found: {5, 6, 7} <= {m.pose.position.y for m in found}, 'three obstacles')
        ids = {m.pose.position.y: m.id for m in added}
        self.assertEqual(next(m for m in added if m.pose.position.y == 7).type, Marker.CYLINDER)
        self.assertTrue(self.node.reset().success)  # a reset does not forget what is seen
        self.send(marker(1, position=(0, 8, 1)), marker(2, action=Marker.DELETE))
        moved = self.wait_for_shown(lambda found: {7, 8} <= {m.pose.position.y for m in found}, 'one moved')
        self.assertEqual(next(m.id for m in moved if m.pose.position.y == 8), ids[5])
        self.wait_for_shown(lambda found: 6 not in {m.pose.position.y for m in found}, 'one deleted')
        self.send(marker(0, action=Marker.DELETEALL))
        self.wait_for_shown(lambda found: {m.id for m in found} <= others | {m.id for m in before}, 'the scene alone')

    def test_a_snapshot_brings_them_back_and_they_can_be_removed_again(self):
        def is_there(found):
            return 4 in {m.pose.position.y for m in found}
        self.send(marker(1, position=(0, 4, 1)))
        self.wait_for_shown(is_there, 'the obstacle')
        self.assertTrue(self.node.save_state(name='with').success)
        self.send(marker(1, action=Marker.DELETE))
        self.wait_for_shown(lambda found: not is_there(found), 'it deleted')
        self.assertTrue(self.node.restore_state(name='with').success)
        self.wait_for_shown(is_there, 'it restored')
        self.send(marker(1, action=Marker.DELETE))
        self.wait_for_shown(lambda found: not is_there(found), 'it deleted again')

    def test_a_cable_is_carried_by_what_is_added_and_moved(self):
        began = rospy.get_time()
        self.frames.motions['lift'] = lambda t: (0, 0, min(-0.1 + 0.15 * (t - began), 0.2))
        self.send(marker(1, frame='lift', position=(0, 0, 0), scale=(2, 2, 0.1)))
        with self.node.states() as states:
            state = states.wait_for(
                lambda s: 'seen/1' in {c.other for c in cable(s, 'rope').contacts}
                and min(p.z for p in cable(s, 'rope').positions) > 0.2, 'the rope on the lift')
        self.assertTrue(all_finite(state))
        self.send(marker(1, action=Marker.DELETE))
        with self.node.states() as states:
            states.wait_for(lambda s: max(p.z for p in cable(s, 'rope').positions) < 0.05, 'the rope on the floor')

    def test_bad_markers_are_refused_and_named(self):
        self.wait_for_shown(lambda found: len(found) >= 4, 'floor and pill')
        bad = {
            'scale: [': marker(1, scale=(NAN, 1, 1)),
            'scale: [0, 1, 1]': marker(2, scale=(0, 1, 1)),
            'ns: "nnn': marker(5, ns=1001 * 'n'),
            'mesh_resource: "file:///aaa': marker(6, Marker.MESH_RESOURCE, mesh_resource='file:///' + 5000 * 'a'),
            'pose.position': marker(3, position=(math.inf, 0, 0)),
            'no ellipsoids': marker(4, Marker.SPHERE, scale=(1, 2, 1)),
            'no elliptic ones': marker(5, Marker.CYLINDER, scale=(1, 2, 1)),
            'type: 0': marker(6, Marker.ARROW),
            'header.frame_id': marker(7, frame='/world'),
            'package "none"': marker(8, Marker.MESH_RESOURCE, mesh_resource='package://none/a.stl'),
            'outside of scene_directory': marker(9, Marker.MESH_RESOURCE, mesh_resource='file:///etc/passwd'),
            'action: 7': marker(10, action=7),
        }
        for part, message in bad.items():
            self.send(message, marker(100, position=(0, 9, 1)))
            self.wait_for_diagnostics('last_refused', part)
        found = self.wait_for_shown(lambda m: 9 in {x.pose.position.y for x in m}, 'the good one')
        self.assertEqual(len([m for m in found if m.pose.position.y not in (2, 0)]), 1)

    def test_what_a_message_does_is_bounded(self):
        self.send(marker(1, position=(0, 5, 1)))
        self.wait_for_shown(lambda found: 5 in {m.pose.position.y for m in found}, 'one')
        self.send(*[marker(0, action=Marker.DELETEALL)] * 5001)
        self.wait_for_diagnostics('last_refused', 'message of 5001 markers; allowed: at most 5000')
        self.send(marker(2, position=(0, 6, 1)))
        self.wait_for_shown(lambda found: {5, 6} <= {m.pose.position.y for m in found}, 'both: the message did nothing')
        self.send(*[marker(0, action=Marker.DELETEALL)] * 2500, marker(2, position=(0, 7, 1)),
                  *[marker(9, action=Marker.DELETE)] * 2499)
        self.wait_for_shown(lambda found: {m.pose.position.y for m in found} & {5, 6, 7} == {7}, 'one that was added again')


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'obstacles', ObstaclesTest, sys.argv)
