#!/usr/bin/env python3
"""A scene of config/scenes runs: what should touch does, nothing is deep in anything, everything is finite."""
import sys
import time
import unittest

import rospy
import rostest
from visualization_msgs.msg import MarkerArray

from cable_client import CableClient, Messages, all_finite, distance

SCENE = sys.argv[1]
# What has to be touched: obstacles by name, cables by theirs.
TOUCHED = {
    'crossed': {'held', 'pulled'},
    'dress_pack': {'forearm_1'},
    'knot': {'rope'},
    'pile': {'floor', 'rope'},
    'pole': {'pole'},
    'table': {'table'},
}[SCENE]
OBSTACLES = {'crossed': 0, 'dress_pack': 6, 'knot': 0, 'pile': 1, 'pole': 2, 'table': 2}[SCENE]
DEEPEST = 0.2    # of the radius
PATIENCE = 30.0  # [s] of wall time; the hands need 2 s


def lowest_gap(cable):
    """The smallest distance of nodes, in radii, of those that are further apart along the cable than half a turn at that distance."""
    step = cable.rest_length / (len(cable.positions) - 1)
    apart = int(7 * cable.radius / step) + 1
    nodes = cable.positions
    return min((distance(nodes[i], (nodes[j].x, nodes[j].y, nodes[j].z)) for i in range(0, len(nodes), 2)
                for j in range(i + apart, len(nodes), 2)), default=1.0) / cable.radius


class SceneTest(unittest.TestCase):
    def test_scene(self):
        rospy.init_node('scene_test')
        node = CableClient('/cable')
        with node.states() as states, Messages('/cable/markers', MarkerArray) as markers:
            touched = set()
            deadline = time.monotonic() + PATIENCE
            while not TOUCHED <= touched and time.monotonic() < deadline:
                rospy.sleep(0.1)
                touched |= {contact.other for state in states.all() for cable in state.cables for contact in cable.contacts}
            self.assertLessEqual(TOUCHED, touched)
            # Links of a robot are shown as soon as tf has them, one after the other.
            markers.wait_for(lambda shown: sum(m.ns == 'obstacles' for m in shown.markers) >= OBSTACLES, 'markers of all obstacles')
            rospy.sleep(2)
            for state in states.all():
                self.assertTrue(all_finite(state))
            for cable in states.all()[-1].cables:
                if SCENE in ('pile', 'knot'):
                    self.assertGreater(lowest_gap(cable), 2 - DEEPEST)
                if SCENE in ('pile', 'pole', 'table'):
                    self.assertGreater(min(p.z for p in cable.positions), (1 - DEEPEST) * cable.radius)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'scene_' + SCENE, SceneTest, sys.argv)
