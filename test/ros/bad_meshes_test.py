#!/usr/bin/env python3
"""Markers whose meshes kill or hang what reads them: refused by name, while services answer and states come."""
import contextlib
import math
import os
import shutil
import statistics
import sys
import threading
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Quaternion, Vector3
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

from bad_meshes import bad_files, binary_stl, box, collada, doubling_nodes, obj
from cable_client import Messages

LONGEST_ANSWER = 0.05  # [s] beyond what the machine takes; in a callback, some of the files took a minute or for ever
FEWEST = 100  # answers to judge by
MOST_SLOW = 0.05  # of the answers: on a busy machine one node may wait for a processor where the other does not
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


def values(message, key):
    """What the attacked node says of a key in its diagnostics."""
    return [v.value for status in message.status if status.name.startswith('cable:') for v in status.values if v.key == key]


class Resets:
    """Calls the service of a node all the time, and measures how long the answers take."""

    def __init__(self, node):
        rospy.wait_for_service(f'{node}/reset', PATIENCE)
        self._reset = rospy.ServiceProxy(f'{node}/reset', Trigger, persistent=True)
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
        self._reset.close()
        rospy.loginfo('%s: %d resets, median %.1f ms, longest %.1f ms, %d above %.0f ms', self._reset.resolved_name, len(self.durations),
                      1e3 * statistics.median(self.durations), 1e3 * max(self.durations), self.slow(), 1e3 * LONGEST_ANSWER)

    def _run(self):
        while not self._stop.wait(0.01):
            begin = time.monotonic()
            try:
                if not self._reset().success:
                    self.problems.append('refused')
            except rospy.ServiceException as error:
                self.problems.append(str(error))
                return
            self.durations.append(time.monotonic() - begin)

    def slow(self):
        return sum(d > LONGEST_ANSWER for d in self.durations)


@contextlib.contextmanager
def answering(test):
    """Meanwhile the attacked node answers as one that is left alone does, whatever else the machine has to do."""
    with Resets('/cable') as attacked, Resets('/alone') as alone:
        yield attacked
        deadline = time.monotonic() + PATIENCE
        while min(len(attacked.durations), len(alone.durations)) < FEWEST and not attacked.problems + alone.problems:
            test.assertLess(time.monotonic(), deadline, 'too few answers')
            time.sleep(0.01)
    test.assertEqual(attacked.problems + alone.problems, [])
    test.assertLess(statistics.median(attacked.durations) - statistics.median(alone.durations), LONGEST_ANSWER)
    slow = (attacked.slow() + alone.slow()) / (len(attacked.durations) + len(alone.durations))
    chance = 3 * math.sqrt(slow * (1 - slow) * (1 / len(attacked.durations) + 1 / len(alone.durations)))  # three standard deviations
    test.assertLessEqual(attacked.slow() / len(attacked.durations), alone.slow() / len(alone.durations) + MOST_SLOW + chance)
    test.assertLess(max(attacked.durations), max(alone.durations) + 1)


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
        with Messages('/diagnostics', DiagnosticArray) as messages:
            return int(values(messages.wait_for(lambda message: values(message, key), key), key)[0])

    def test_each_is_refused_while_services_answer(self):
        names = list(bad_files()) + ['pipe.stl', 'directory.stl', 'zero.stl', 'none.stl']
        before = self.diagnostics('refused_markers')
        with answering(self) as resets:
            self.send(*(mesh(number, self.file(name)) for number, name in enumerate(names)))
            deadline = time.monotonic() + PATIENCE
            while self.diagnostics('refused_markers') < before + len(names):
                self.assertEqual(resets.problems, [])
                self.assertLess(time.monotonic(), deadline, 'not all are refused')
        self.send(mesh(1, self.file('inside/names_a_pipe.obj'), 3))
        self.wait_for_places([3])

    def test_a_later_marker_wins(self):
        slow, good = self.file('slow.dae'), self.file('box.stl')
        with answering(self):
            # The last of each is a change while its mesh is still waited for.
            self.send(mesh(1, slow), mesh(2, good, 12), mesh(3, good, 13), mesh(4, good, 14), mesh(4, good, 24))
            self.send(mesh(3, good, action=Marker.DELETE), mesh(1, good, 11))
            self.wait_for_places([11, 12, 24])
            self.send(mesh(2, good, 22), mesh(4, good, action=Marker.DELETE))
            self.wait_for_places([11, 22])
            self.send(mesh(5, self.file('inside/names_a_pipe.obj'), 15), mesh(0, '', action=Marker.DELETEALL), mesh(6, good, 16))
            self.wait_for_places([16])

    def test_no_more_wait_than_are_allowed(self):
        sent, slow, waiting, before = 300, 6, 100, self.diagnostics('refused_markers')
        # Files of their own: one that has failed is not read again soon.
        for i in range(slow):
            shutil.copy(self.file('slow.dae'), self.file(f'slow_{i}.dae'))
        markers = [mesh(i, self.file(f'slow_{i}.dae' if i < slow else f'none_{i}.stl')) for i in range(sent)]

        def refused(message):
            # Those that wait are refused when they have been read, the others at once.
            at_once = [int(value) - before for value in values(message, 'refused_markers')]
            return any(sent - waiting - slow <= count <= sent - waiting + slow for count in at_once)
        with Messages('/diagnostics', DiagnosticArray) as diagnostics, answering(self):
            self.send(*markers)
            diagnostics.wait_for(refused, 'refusal of what would be too many that wait', PATIENCE)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'bad_meshes', BadMeshesTest, sys.argv)
