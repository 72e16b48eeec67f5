#!/usr/bin/env python3
"""Guides in messages, markers and events; they are no attachments to anybody."""
import sys
import unittest

import rospy
import rostest
from visualization_msgs.msg import Marker, MarkerArray

from cable_client import CableClient, Messages, cable
from verlet_cable.msg import CableEvent

SCENE = open(sys.argv[1]).read()


class GuidesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('guides_test')
        cls.node = CableClient('/robot/cable')

    def load(self):
        self.assertTrue(self.node.load_scene(yaml=SCENE).success)

    def test_state(self):
        self.load()
        with self.node.states() as states:
            state = states.wait_for(lambda s: cable(s, 'cord') and cable(s, 'cord').guides, 'cord in its clip')
        self.assertEqual(cable(state, 'cord').guides, ['clip'])
        self.assertEqual(cable(state, 'cord').attachments, ['cord_top'])
        self.assertAlmostEqual(cable(state, 'cord').guide_arc_length[0], 0.49, delta=0.02)
        self.assertEqual(cable(state, 'rope').guides, ['wheel'])
        self.assertEqual(cable(state, 'rope').attachments, [])
        self.assertAlmostEqual(cable(state, 'rope').guide_arc_length[0], 1, places=3)

    def test_events(self):
        with Messages('/robot/cable/events', CableEvent) as events:
            self.load()
            caught = events.wait_for(lambda e: e.type == CableEvent.CAUGHT, 'CAUGHT')
            self.assertEqual((caught.cable, caught.attachment), ('cord', 'clip'))
            self.assertIn('guide "clip" has taken cable "cord"', caught.message)
            released = events.wait_for(lambda e: e.type == CableEvent.RELEASED, 'RELEASED')
            self.assertEqual((released.cable, released.attachment), ('runner', 'eye'))
            self.assertIn('guide "eye" has let cable "runner" go', released.message)

    def test_markers(self):
        self.load()
        with Messages('/robot/cable/markers', MarkerArray) as markers:
            message = markers.wait_for(lambda m: any(k.ns == 'guides' for k in m.markers), 'guides')
        guides = [m for m in message.markers if m.ns == 'guides' and m.action == Marker.ADD]
        self.assertEqual(sorted(m.type for m in guides), sorted(3 * [Marker.CYLINDER] + 2 * [Marker.LINE_STRIP]))
        self.assertEqual(len([m for m in message.markers if m.ns == 'pins' and m.action == Marker.ADD]), 1)
        for marker in guides:
            self.assertTrue(all(scale >= 0 for scale in (marker.scale.x, marker.scale.y, marker.scale.z)))

    def test_they_are_no_attachments(self):
        self.load()
        topics = [name for name, _ in rospy.get_published_topics('/robot/cable/wrench')]
        for name in ('wheel', 'eye', 'clip'):
            self.assertNotIn('/robot/cable/wrench/' + name, topics)
        answer = self.node.unpin('wheel')
        self.assertFalse(answer.success)
        self.assertIn('wheel', answer.message)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'guides_test', GuidesTest)
