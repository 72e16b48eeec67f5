#!/usr/bin/env python3
"""Markers whose meshes kill or hang what reads them: refused by name, while services answer and states come."""
import os
import shutil
import sys
import threading
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Quaternion, Vector3
from visualization_msgs.msg import Marker, MarkerArray

from bad_meshes import bad_files, binary_stl, box, collada, doubling_nodes, obj
from cable_client import CableClient, Messages

# [s] what a machine with ten times more to do than it can may take. In a callback, some of the files took a minute or for ever.
LONGEST_ANSWER = 5.0
PATIENCE = 120.0  # [s] some of the files take seconds of a whole processor until they are given up


def mesh(number, file, position=0.0, action=Marker.ADD):
    message = Marker(ns='seen', id=number, type=Marker.MESH_RESOURCE, action=action, mesh_resource='file://' + file)
    message.header.frame_id = 'world'
    message.pose.position.x = position
    message.pose.orientation = Quaternion(0, 0, 0, 1)
    message.scale = Vector3(1, 1, 1)
    return message


def places(markers):
    """Of the obstacles that are shown: x."""
    return sorted(round(m.pose.position.x) for m in markers.markers if m.ns == 'obstacles' and m.action == Marker.ADD)


class Resets:
    """Calls the service all the time, and measures how long the answers take."""

    def __init__(self, node):
        self._node = node
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.durations = []
        self.problems = []

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()
        rospy.loginfo('%d resets, the longest %.1f ms', len(self.durations), 1e3 * max(self.durations))

    def _run(self):
        while not self._stop.wait(0.005):
            begin = time.monotonic()
            try:
                if not self._node.reset().success:
                    self.problems.append('refused')
            except rospy.ServiceException as error:
                self.problems.append(str(error))
                return
            self.durations.append(time.monotonic() - begin)


class BadMeshesTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('bad_meshes_test')
        cls.directory = rospy.get_param('~scene_directory')
        os.makedirs(cls.directory + '/inside')
        for name, content in bad_files().items():
            cls.write(name, content)
        cls.write('box.stl', binary_stl(box()))
        cls.write('slow.dae', collada('<node><instance_node url="#n0"/></node>', doubling_nodes(40)).encode())
        os.mkfifo(cls.directory + '/pipe.stl')
        os.mkfifo(cls.directory + '/x')
        os.mkdir(cls.directory + '/directory.stl')
        os.symlink('/dev/zero', cls.directory + '/zero.stl')
        cls.write('inside/names_a_pipe.obj', obj('mtllib ../x').encode())
        cls.node = CableClient('/cable')
        cls.publisher = rospy.Publisher('/cable/obstacles', MarkerArray, queue_size=100)
        while cls.publisher.get_num_connections() == 0:
            rospy.sleep(0.05)

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.directory)

    @classmethod
    def write(cls, name, content):
        with open(os.path.join(cls.directory, name), 'wb') as file:
            file.write(content)

    def setUp(self):
        self.send(mesh(0, '', action=Marker.DELETEALL))

    def send(self, *markers):
        self.publisher.publish(list(markers))

    def file(self, name):
        return os.path.join(self.directory, name)

    def wait_for_places(self, wanted):
        with Messages('/cable/markers', MarkerArray) as messages:
            messages.wait_for(lambda m: places(m) == wanted, f'obstacles at {wanted}', PATIENCE)

    @staticmethod
    def diagnostics(key):
        def values(message):
            return [v.value for status in message.status for v in status.values if v.key == key]
        with Messages('/diagnostics', DiagnosticArray) as messages:
            return int(values(messages.wait_for(values, key))[0])

    def assertAnswered(self, resets):
        self.assertEqual(resets.problems, [])
        self.assertGreater(len(resets.durations), 10)
        self.assertLess(max(resets.durations), LONGEST_ANSWER)

    def test_each_is_refused_while_services_answer(self):
        names = list(bad_files()) + ['pipe.stl', 'directory.stl', 'zero.stl', 'none.stl']
        before = self.diagnostics('refused_markers')
        with Resets(self.node) as resets:
            self.send(*(mesh(number, self.file(name)) for number, name in enumerate(names)))
            deadline = time.monotonic() + PATIENCE
            while self.diagnostics('refused_markers') < before + len(names):
                self.assertEqual(resets.problems, [])
                self.assertLess(time.monotonic(), deadline, 'not all are refused')
        self.assertAnswered(resets)
        self.send(mesh(1, self.file('inside/names_a_pipe.obj'), 3))
        self.wait_for_places([3])

    def test_a_later_marker_wins(self):
        slow, good = self.file('slow.dae'), self.file('box.stl')
        with Resets(self.node) as resets:
            # The last of each is a change while its mesh is still waited for.
            self.send(mesh(1, slow), mesh(2, good, 12), mesh(3, good, 13), mesh(4, good, 14), mesh(4, good, 24))
            self.send(mesh(3, good, action=Marker.DELETE), mesh(1, good, 11))
            self.wait_for_places([11, 12, 24])
            self.send(mesh(2, good, 22), mesh(4, good, action=Marker.DELETE))
            self.wait_for_places([11, 22])
            self.send(mesh(5, self.file('inside/names_a_pipe.obj'), 15), mesh(0, '', action=Marker.DELETEALL), mesh(6, good, 16))
            self.wait_for_places([16])
        self.assertAnswered(resets)

    def test_no_more_wait_than_are_allowed(self):
        def refused(message):
            return any(v.key == 'last_refused' and 'too many obstacles wait' in v.value for s in message.status for v in s.values)
        with Messages('/diagnostics', DiagnosticArray) as diagnostics, Resets(self.node) as resets:
            self.send(*(mesh(i, self.file(f'none_{i}.stl' if i else 'slow.dae')) for i in range(300)))
            diagnostics.wait_for(refused, 'refusal', PATIENCE)
        self.assertAnswered(resets)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'bad_meshes', BadMeshesTest, sys.argv)
