#!/usr/bin/env python3
"""A scene in UTM: clouds, markers and hands near its origin, everything else in the fixed frame."""
import sys
import time
import unittest

import numpy as np
import rospy
import rostest
import yaml
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerInit, InteractiveMarkerUpdate, Marker, MarkerArray

from cable_client import CableClient, Messages, cable

SCENE = open(sys.argv[1]).read()
FRAME = 'map/cable_origin'
NEAR = 20  # [m] from the origin: everything of the scene is


def positions(cloud):
    """As they lie in the cloud's data, single precision."""
    record = np.dtype({'names': ['x', 'y', 'z'], 'formats': 3 * ['<f4'], 'offsets': [0, 4, 8], 'itemsize': cloud.point_step})
    points = np.frombuffer(cloud.data, record)
    return np.stack([points[axis] for axis in 'xyz'], axis=1).astype(float)


def numbers(points):
    return np.array([(p.x, p.y, p.z) for p in points])


class OriginTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('origin_test')
        cls.node = CableClient('/map/cable')
        cls.origin = np.array(yaml.safe_load(SCENE)['origin'], dtype=float)

    def setUp(self):
        self.load(SCENE)

    def load(self, scene):
        answer = self.node.load_scene(yaml=scene)
        self.assertTrue(answer.success, answer.message)

    def error_of_points(self):
        """[m] The largest distance of a point of the cloud, set in the fixed frame, from its node in `state`, and the cloud's frame."""
        with self.node.states() as states, Messages('/map/cable/points', PointCloud2) as clouds:
            cloud = clouds.wait_for(lambda c: any(s.header.stamp == c.header.stamp for s in states.all()), 'cloud with its state')
            state = next(s for s in states.all() if s.header.stamp == cloud.header.stamp)
        nodes = numbers(cable(state, 'rope').positions)
        self.assertEqual(state.header.frame_id, 'utm')
        origin = self.origin if cloud.header.frame_id == FRAME else 0
        return np.abs(positions(cloud)[:len(nodes)] + origin - nodes).max(), cloud.header.frame_id

    def test_points_are_exact(self):
        error, frame = self.error_of_points()
        self.assertEqual(frame, FRAME)
        self.assertLess(error, 1e-4)

    def test_surface_and_markers_are_near(self):
        with Messages('/map/cable/surface', PointCloud2) as clouds:
            cloud = clouds.next()
        self.assertEqual(cloud.header.frame_id, FRAME)
        self.assertLess(np.abs(positions(cloud)).max(), NEAR)
        with Messages('/map/cable/markers', MarkerArray) as messages:
            markers = messages.wait_for(lambda m: any(k.ns == 'rope' for k in m.markers), 'markers of the rope').markers
        shown = [marker for marker in markers if marker.action == Marker.ADD]
        self.assertEqual({m.ns for m in shown}, {'rope', 'payloads', 'flag', 'ball', 'pins', 'guides', 'obstacles', 'bodies'})
        for marker in shown:
            self.assertEqual(marker.header.frame_id, FRAME)
            for point in [marker.pose.position, *marker.points]:
                self.assertLess(np.abs((point.x, point.y, point.z)).max(), NEAR, marker.ns)

    def test_hands_are_near(self):
        with Messages('/map/cable/hands/update', InteractiveMarkerUpdate), \
                Messages('/map/cable/hands/update_full', InteractiveMarkerInit) as messages:
            hands = messages.wait_for(lambda m: m.markers and m.markers[0].header.frame_id == FRAME, 'hands').markers
        for hand in hands:
            self.assertLess(np.abs((hand.pose.position.x, hand.pose.position.y, hand.pose.position.z)).max(), NEAR, hand.name)

    def test_the_frame_is_on_tf(self):
        with Messages('/tf_static', TFMessage) as messages:
            message = messages.wait_for(lambda m: any(t.child_frame_id == FRAME for t in m.transforms), FRAME)
        sent = next(t for t in message.transforms if t.child_frame_id == FRAME)
        self.assertEqual(sent.header.frame_id, 'utm')
        np.testing.assert_array_equal((sent.transform.translation.x, sent.transform.translation.y, sent.transform.translation.z), self.origin)

    def test_a_scene_without_one_is_warned_of(self):
        with Messages('/rosout', Log) as log:
            while not any(m.name == '/map/cable' for m in log.all()):  # it is connected
                self.load(SCENE)
                time.sleep(0.1)
            self.load(SCENE.replace('origin: [500000, 5400000, 0]\n', ''))
            error, frame = self.error_of_points()
            self.assertEqual(frame, 'utm')
            self.assertGreater(error, 1e-2)
            warning = log.wait_for(lambda m: 'single precision' in m.msg, 'warning')
        self.assertEqual(warning.level, Log.WARN)
        self.assertIn('`origin: [500000, 5400000, 0]`', warning.msg)

    def test_its_name_is_taken(self):
        answer = self.node.load_scene(yaml=SCENE.replace('name: right,', f'name: right, frame: {FRAME},'))
        self.assertFalse(answer.success)
        self.assertIn(f'cables[0].attachments[1].frame: "{FRAME}"; allowed: other names', answer.message)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'origin', OriginTest, sys.argv)
