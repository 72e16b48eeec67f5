#!/usr/bin/env python3
"""One of launch/examples runs: what its rviz view shows arrives, finite, and it does what it is an example of."""
import math
import os
import sys
import unittest

import numpy as np
import rospy
import rostest
import yaml
from geometry_msgs.msg import WrenchStamped
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import Image, PointCloud2
from visualization_msgs.msg import InteractiveMarkerInit, InteractiveMarkerUpdate, MarkerArray

from cable_client import CableClient, Messages, all_finite, cable
from example_physics import PHYSICS
from images import array, labels_of, points_of
from verlet_cable.msg import CableView

EXAMPLE = sys.argv[1]
PACKAGE = sys.argv[0].partition('/test/ros/')[0]
sys.path.insert(0, os.path.join(PACKAGE, 'scripts'))
import example_motions  # noqa: E402
SECONDS = 3
ROUND = example_motions.PERIODS.get(EXAMPLE, 9.0) + 1  # [s] after which it has begun again, or has shown most of what it does
# Obstacles whose frames move are shown as soon as tf has them; a capsule is three markers.
OBSTACLES = {'arm_dress_pack': 6, 'crane': 5, 'drones_with_bar': 7, 'finger': 1, 'gripper_load': 5, 'harness': 7,
             'hose_between_arms': 8, 'plug': 11, 'rov_tether': 4, 'table_camera': 2, 'tethered_drone': 5,
             'tracker': 0}[EXAMPLE]
PAUSE = 10.0  # [s] more than any hand's
STRETCH = {'finger': 0.4}  # its rubber bands


def farthest(first, second):
    """[m] That a node of a cable is from where it was."""
    return max(math.dist((p.x, p.y, p.z), (q.x, q.y, q.z)) for p, q in zip(first.positions, second.positions))


def is_finite(marker):
    p, q, s = marker.pose.position, marker.pose.orientation, marker.scale
    numbers = [p.x, p.y, p.z, q.x, q.y, q.z, q.w, s.x, s.y, s.z] + [x for v in marker.points for x in (v.x, v.y, v.z)]
    return all(math.isfinite(x) for x in numbers)


class ExampleTest(*([PHYSICS[EXAMPLE]] if EXAMPLE in PHYSICS else []), unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('example_test')
        cls.node = CableClient('/cable')

    def test_cables_move_and_are_shown(self):
        with self.node.states() as states, Messages('/cable/markers', MarkerArray) as markers:
            markers.wait_for(lambda shown: sum(m.ns == 'obstacles' for m in shown.markers) >= OBSTACLES, 'all obstacles')
            states.clear()
            rospy.sleep(SECONDS)
            seen = states.all()
            self.assertGreater(len(seen), 20 * SECONDS)
            self.assertTrue(all(all_finite(state) for state in seen))
            self.assertTrue(all(is_finite(m) for message in markers.all() for m in message.markers))
            for first in seen[0].cables:
                # Where hands pause, so do the cables.
                moved = states.wait_for(lambda s: farthest(first, cable(s, first.name)) > 0.01, f'{first.name} that moved', PAUSE)
                last = cable(moved, first.name)
                # No cable is torn at: what holds it is never further apart than it is long.
                lengths = [math.dist((p.x, p.y, p.z), (q.x, q.y, q.z)) for p, q in zip(last.positions, last.positions[1:])]
                self.assertAlmostEqual(sum(lengths), last.rest_length, delta=STRETCH.get(EXAMPLE, 0.01) * last.rest_length)

    def test_handles_are_shown(self):
        with Messages('/cable/hands/update', InteractiveMarkerUpdate), \
                Messages('/cable/hands/update_full', InteractiveMarkerInit) as handles:
            handles.wait_for(lambda message: any(m.name.startswith('attachment/') for m in message.markers), 'handles')

    def test_its_view_shows_topics_that_are_there(self):
        with open(f'{PACKAGE}/rviz/examples/{EXAMPLE}.rviz') as file:
            displays = yaml.safe_load(file)['Visualization Manager']['Displays']
        shown = {value for display in displays for key, value in display.items() if key.endswith('Topic')}
        self.assertIn('/cable/markers', shown)
        if EXAMPLE in ('arm_dress_pack', 'table_camera'):
            shown.discard('/example/labels')  # it is not one of those of example_frames.py
        self.assertLessEqual(shown, {topic for topic, _ in rospy.get_published_topics()})

    def test_a_round_is_silent(self):
        with Messages('/rosout', Log) as log:
            rospy.sleep(ROUND)
            warnings = [f'{line.name}: {line.msg}' for line in log.all() if line.level >= Log.WARN]
        if any('cannot keep up' in warning for warning in warnings):
            self.skipTest('the machine is too busy for the example')
        self.assertEqual(warnings, [])

    @unittest.skipUnless(EXAMPLE == 'crane', 'has no winch')
    def test_the_winch_winds(self):
        with self.node.states() as states:
            for wanted in (1.7, 0.8):
                deadline = rospy.get_time() + 20
                while abs(states.next().cables[0].rest_length - wanted) > 1e-3 and rospy.get_time() < deadline:
                    rospy.sleep(0.2)
                self.assertAlmostEqual(states.next().cables[0].rest_length, wanted, delta=2e-3)

    @unittest.skipUnless(EXAMPLE == 'gripper_load', 'shows no load')
    def test_the_load_is_about_the_weight(self):
        with Messages('/cable/wrench/gripper', WrenchStamped) as wrenches:
            load = wrenches.next(5)
        self.assertEqual(load.header.frame_id, 'gripper')
        f, t = load.wrench.force, load.wrench.torque
        self.assertTrue(all(math.isfinite(x) for x in (f.x, f.y, f.z, t.x, t.y, t.z)))
        weight = 0.4 * 1.1 * 9.81
        self.assertGreater(math.hypot(f.x, f.y, f.z), 0.2 * weight)
        self.assertLess(math.hypot(f.x, f.y, f.z), 5 * weight)

    @unittest.skipUnless(EXAMPLE == 'tracker', 'has no tracker')
    def test_the_camera_sees_the_rope_where_it_is(self):
        # Clouds only count from when truths come: the first would have none.
        with Messages('/camera/truth', CableView) as truths, Messages('/camera/points', PointCloud2) as clouds:
            truths.next()
            pairs = 0
            while pairs < 5:  # a busy machine may lose some of either
                cloud = clouds.next()
                truth = truths.wait_for(lambda t: t.header.stamp >= cloud.header.stamp, 'truth of this stamp or a later one')
                if truth.header.stamp != cloud.header.stamp:
                    continue
                pairs += 1
                self.assertEqual((cloud.header.frame_id, truth.header.frame_id), ('camera_optical_frame',) * 2)
                points = points_of(cloud)[labels_of(cloud) == 1]
                points = points[np.isfinite(points).all(axis=1)]
                nodes = np.array([(p.x, p.y, p.z) for p in truth.positions])
                self.assertGreater(len(points), 200)
                self.assertGreater(points[:, 2].min(), 0.5)  # in front of it
                nearest = np.linalg.norm(points[:, None] - nodes[None], axis=2).min(axis=1)
                self.assertLess(nearest.max(), 0.012 + 0.01 + 0.006)  # radius, half a segment, six times the noise
                self.assertLess(np.median(points[:, 2]), np.median(nodes[:, 2]))  # the near side

    @unittest.skipUnless(EXAMPLE == 'table_camera', 'has no arm that is seen')
    def test_the_camera_sees_arm_table_and_cables(self):
        with Messages('/camera/truth', CableView) as truths, Messages('/camera/mask/image_raw', Image) as masks:
            labels = list(truths.next().labels)
            self.assertEqual(labels, ['signal', 'probe', 'supply', 'table', 'floor', 'base_link', 'shoulder', 'upper_arm', 'forearm', 'wrist'])
            seen = set()
            deadline = rospy.get_time() + 10
            while seen < set(range(1, len(labels) + 1)) and rospy.get_time() < deadline:
                seen |= set(np.unique(array(masks.next())))
            self.assertEqual(seen - {0}, set(range(1, len(labels) + 1)))


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'example_' + EXAMPLE, ExampleTest, sys.argv)
