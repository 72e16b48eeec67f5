#!/usr/bin/env python3
"""A net and a particle in a running node: what is published, pins, cuts, snapshots."""
import sys
import unittest

import rospy
import rostest
from cable_client import Messages, distance
from geometry_msgs.msg import Pose, WrenchStamped
from sensor_msgs import point_cloud2
from sensor_msgs.msg import PointCloud2
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

from verlet_cable.msg import CableArray, CableLocation
from verlet_cable.srv import Cut, Pin, RestoreState, SaveState, Unpin

LINKS = 5 * 5 + 4 * 6 + 2 * 4 * 5
PATIENCE = 10.0


def call(name, kind, *arguments):
    rospy.wait_for_service('/cable/' + name, PATIENCE)
    return rospy.ServiceProxy('/cable/' + name, kind)(*arguments)


def receive(topic, kind):
    return rospy.wait_for_message('/cable/' + topic, kind, PATIENCE)


def node(net, index):
    location = CableLocation(cable=net, mode=CableLocation.NODE, node=index)
    return location


class LectureTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('lecture_test')
        receive('state', CableArray)

    def setUp(self):
        self.assertTrue(call('reset', Trigger).success)

    def test_state_points_and_markers_have_nets_and_particles(self):
        state = receive('state', CableArray)
        self.assertEqual([net.name for net in state.nets], ['flag'])
        self.assertEqual([particle.name for particle in state.particles], ['ball'])
        flag = state.nets[0]
        self.assertEqual((len(flag.positions), len(flag.velocities)), (30, 30))
        self.assertEqual((len(flag.links), len(flag.tension)), (2 * LINKS, LINKS))
        points = list(point_cloud2.read_points(receive('points', PointCloud2), ('cable_id', 'node_id')))
        self.assertEqual(points, [(0, i) for i in range(30)] + [(1, 0)])
        markers = {(m.ns, m.id): m for m in receive('markers', MarkerArray).markers}
        self.assertEqual(len(markers['flag', 0].points), 2 * LINKS)
        self.assertEqual(len(markers['flag', -1].points), 6 * 4 * 5)  # once, not for each side
        self.assertEqual(markers['ball', 0].type, Marker.SPHERE)

    def test_holders_carry_the_net(self):
        start = receive('state', CableArray).header.stamp
        with Messages('/cable/state', CableArray) as states:
            states.wait_for(lambda s: s.header.stamp - start > rospy.Duration(2), 'state 2 s later')
        weight = sum(-receive('wrench/' + name, WrenchStamped).wrench.force.z for name in ('left', 'right'))
        self.assertAlmostEqual(weight, 0.1 * 9.81, delta=0.3)

    def test_pin_and_unpin(self):
        offset = Pose()
        offset.position.x, offset.position.z = 0.2, 1.7
        answer = call('pin', Pin, node('flag', 24), 'corner', '', offset, False, False)
        self.assertTrue(answer.success, answer.message)
        self.assertFalse(call('pin', Pin, node('flag', 24), '', '', offset, False, False).success)
        self.assertFalse(call('pin', Pin, node('flag', 30), '', '', offset, False, False).success)
        self.assertFalse(call('pin', Pin, node('flag', 20), '', '', offset, True, False).success)
        with Messages('/cable/state', CableArray) as states:
            states.wait_for(lambda s: distance(s.nets[0].positions[24], (0.2, 0, 1.7)) < 5e-7, 'node 24 where it is pinned')
            held = states.next().nets[0].positions[24]
        self.assertAlmostEqual(held.x, 0.2, places=6)
        self.assertAlmostEqual(held.y, 0, places=6)
        self.assertAlmostEqual(held.z, 1.7, places=6)
        self.assertTrue(call('unpin', Unpin, 'corner').success)

    def test_cuts_and_snapshots(self):
        self.assertTrue(call('save_state', SaveState, 'whole', '').success)
        nearest = CableLocation(mode=CableLocation.NEAREST)
        nearest.point.point.x, nearest.point.point.z = 0.25, 2
        answer = call('cut', Cut, nearest)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual((answer.first, answer.second), ('flag', ''))
        self.assertEqual(len(receive('state', CableArray).nets[0].tension), LINKS - 1)
        self.assertTrue(call('cut', Cut, node('flag', 29)).success)
        self.assertEqual(len(receive('state', CableArray).nets[0].tension), LINKS - 4)
        self.assertFalse(call('cut', Cut, node('flag', 29)).success)
        self.assertFalse(call('cut', Cut, node('flag', 30)).success)
        self.assertTrue(call('restore_state', RestoreState, 'whole', '').success)
        self.assertEqual(len(receive('state', CableArray).nets[0].tension), LINKS)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'lecture', LectureTest, sys.argv)
