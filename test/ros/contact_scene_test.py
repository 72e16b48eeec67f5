#!/usr/bin/env python3
"""A scene of config/scenes runs: what should touch does, nothing is deep in anything, everything is finite."""
import sys
import time
import unittest

import numpy
import rospy
import rostest
from visualization_msgs.msg import Marker, MarkerArray

from cable_client import CableClient, Messages, all_finite, distance

SCENE = sys.argv[1]
SECONDS = float(sys.argv[2])  # for how long it is watched
# What has to be touched: obstacles by name, cables by theirs.
TOUCHED = {
    'coiled_cable': set(),
    'crossed': {'held', 'pulled'},
    'dress_pack': {'forearm_1'},
    'flat_cable': set(),
    'knot': {'rope'},
    'pile': {'floor', 'rope'},
    'pole': {'pole'},
    'table': {'table'},
}[SCENE]
OBSTACLES = {'coiled_cable': 0, 'crossed': 0, 'dress_pack': 6, 'flat_cable': 0, 'knot': 0, 'pile': 1, 'pole': 2, 'table': 2}[SCENE]
DEEPEST = 0.2    # of the radius
ANCHORED = 0.051  # [m]
PATIENCE = 30.0  # [s] of wall time; the hands need 2 s


def lowest_gap(cable):
    """The smallest distance of nodes, in radii, of those that are further apart along the cable than half a turn at that distance."""
    step = cable.rest_length / (len(cable.positions) - 1)
    apart = int(7 * cable.radius / step) + 1
    nodes = cable.positions
    return min((distance(nodes[i], (nodes[j].x, nodes[j].y, nodes[j].z)) for i in range(0, len(nodes), 2)
                for j in range(i + apart, len(nodes), 2)), default=1.0) / cable.radius


def points_on(cable):
    """Five a segment, but for those near attachments: links that hold a cable do not push its first few centimetres."""
    nodes = numpy.array([(p.x, p.y, p.z) for p in cable.positions])
    places = numpy.arange(0, len(nodes) - 1, 0.2)
    first, part = places.astype(int), (places % 1)[:, None]
    arc_length = numpy.interp(places, range(len(nodes)), cable.arc_length)
    held = [cable.arc_length[node] for node in cable.attachment_nodes]
    free = numpy.array([all(abs(s - h) > ANCHORED for h in held) for s in arc_length])
    return ((1 - part) * nodes[first] + part * nodes[first + 1])[free]


def distances(points, marker):
    """Of points from the surface of an obstacle's marker [m], below 0 inside."""
    q, p, size = marker.pose.orientation, marker.pose.position, marker.scale
    rotation = numpy.array([[1 - 2 * (q.y * q.y + q.z * q.z), 2 * (q.x * q.y - q.w * q.z), 2 * (q.x * q.z + q.w * q.y)],
                            [2 * (q.x * q.y + q.w * q.z), 1 - 2 * (q.x * q.x + q.z * q.z), 2 * (q.y * q.z - q.w * q.x)],
                            [2 * (q.x * q.z - q.w * q.y), 2 * (q.y * q.z + q.w * q.x), 1 - 2 * (q.x * q.x + q.y * q.y)]])
    local = (points - (p.x, p.y, p.z)) @ rotation
    if marker.type == Marker.TRIANGLE_LIST:  # a plane's sheet, drawn a little below the plane, which is the pose's
        return local[:, 2]
    local = numpy.abs(local)
    if marker.type == Marker.SPHERE:
        return numpy.linalg.norm(local, axis=1) - size.x / 2
    if marker.type == Marker.CYLINDER:
        local = numpy.stack([numpy.hypot(local[:, 0], local[:, 1]), local[:, 2]], axis=1)
        outside = local - (size.x / 2, size.z / 2)
    else:
        outside = local - (size.x / 2, size.y / 2, size.z / 2)
    return numpy.linalg.norm(numpy.maximum(outside, 0), axis=1) + numpy.minimum(outside.max(axis=1), 0)


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
            rospy.sleep(SECONDS)
            for state in states.all():
                self.assertTrue(all_finite(state))
            self.check_depths(states.all(), markers.all())
            for cable in states.all()[-1].cables:
                if SCENE in ('pile', 'knot'):
                    self.assertGreater(lowest_gap(cable), 2 - DEEPEST)

    def check_depths(self, states, marker_arrays):
        """Of each state against the obstacles as they were shown with it."""
        obstacles = {array.markers[0].header.stamp: [m for m in array.markers if m.ns == 'obstacles' and m.action == Marker.ADD]
                     for array in marker_arrays if array.markers}
        closest, compared = numpy.inf, 0
        for state in states:
            for marker in obstacles.get(state.header.stamp, []):
                self.assertIn(marker.type, (Marker.SPHERE, Marker.CYLINDER, Marker.CUBE, Marker.TRIANGLE_LIST))
                for cable in state.cables:
                    compared += 1
                    closest = min(closest, distances(points_on(cable), marker).min() / cable.radius)
        print(f'{SCENE}: {compared} pairs of cable and obstacle, the closest centre line {closest:.3f} radii from a surface')
        self.assertGreater(closest, 1 - DEEPEST)
        # On a busy machine not every state finds the markers of its stamp.
        self.assertGreaterEqual(compared, 10 * min(OBSTACLES, 1))


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'scene_' + SCENE, SceneTest, sys.argv)
