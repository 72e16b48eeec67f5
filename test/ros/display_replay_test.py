#!/usr/bin/python3
"""replay.launch as a user starts it: a recording whose simulation is known, and bad recordings."""
import os
import signal
import subprocess
import tempfile
import time
import unittest

import numpy as np
import rospy
import rostest
from std_msgs.msg import Float64
from visualization_msgs.msg import Marker, MarkerArray

from verlet_cable.msg import CableEvent

SPEED = 0.3      # [m/s] downwards
DURATION = 4.0   # [s]
LAUNCH_LIMIT = 60.0  # [s]


def catenary(places, span, a):
    """Points of the curve a cosh(x / a), level ends, at fractions of its length."""
    length = 2 * a * np.sinh(span / 2 / a)
    x = a * np.arcsinh((places - 0.5) * length / a)
    return np.column_stack([x, np.zeros_like(x), a * np.cosh(x / a)])


def write_recording(path):
    """A cable that sinks evenly. Linear drag then only changes what it weighs, and a catenary is the same for any weight."""
    shape = catenary(np.concatenate([[0, 0.02], np.linspace(0.1, 0.9, 9), [0.98, 1]]), span=0.6, a=0.25)
    with open(path, 'w', encoding='utf-8') as file:
        file.write(','.join(['t'] + [f'{axis}{i}' for i in range(len(shape)) for axis in 'xyz']) + '\n')
        for moment in np.arange(0, DURATION + 0.005, 0.01):
            row = shape + [0, 0, 1 - SPEED * moment]
            file.write(','.join(f'{value:.5f}' for value in [moment, *row.ravel()]) + '\n')


class ReplayTest(unittest.TestCase):

    def setUp(self):
        self._directory = tempfile.TemporaryDirectory(prefix='a b')  # paths with spaces are paths
        self.path = os.path.join(self._directory.name, 'recording.csv')

    def tearDown(self):
        self._directory.cleanup()

    def replay(self):
        """Runs one replay to its end; its output."""
        command = ['roslaunch', 'verlet_cable', 'replay.launch', f'data:={self.path}', 'loop:=false', 'rviz:=false']
        return subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=LAUNCH_LIMIT).stdout

    def test_known_motion(self):
        write_recording(self.path)
        errors = []
        subscriber = rospy.Subscriber('/replay/error', Float64, lambda message: errors.append(message.data))
        output = self.replay()
        subscriber.unregister()
        self.assertIn('mean error', output)
        # published at 50 Hz for the length of the recording; the first may come before the subscription stands
        self.assertGreater(len(errors), 0.9 * 50 * DURATION)
        # Segments of 2 cm lie up to l^2 / (8 a) = 0.2 mm inside the curve; at 0.3 m/s, 10 ms out of step would be 1 mm in one of the
        # three coordinates.
        self.assertLess(max(errors), 0.0005)
        self.assertGreater(max(errors), 0)

    def test_measured_and_simulated_begin_again_together_and_end_quietly(self):
        write_recording(self.path)
        shapes, hidden, resets = [], [], []

        def on_markers(message):
            line, balls, label = message.markers
            self.assertEqual(line.action, balls.action)
            if line.action == Marker.ADD:
                shapes.append(line)
            else:
                hidden.append(label)

        subscribers = [
            rospy.Subscriber('/replay/markers', MarkerArray, on_markers, queue_size=1000),
            rospy.Subscriber('/cable/events', CableEvent,
                             lambda event: resets.append(event.header.stamp) if event.type == CableEvent.RESET else None)]
        command = ['roslaunch', 'verlet_cable', 'replay.launch', f'data:={self.path}', 'rviz:=false']
        launch = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, start_new_session=True)
        try:
            deadline = time.monotonic() + LAUNCH_LIMIT
            while not (len(resets) > 1 and shapes and shapes[-1].header.stamp > resets[1]) and time.monotonic() < deadline:
                time.sleep(0.02)
        finally:
            os.killpg(launch.pid, signal.SIGINT)
            output = launch.communicate(timeout=LAUNCH_LIMIT)[0]
        for subscriber in subscribers:
            subscriber.unregister()
        self.assertGreater(len(resets), 1, output)
        fallen = {shape.header.stamp: shapes[0].points[0].z - shape.points[0].z for shape in shapes}
        before = [stamp for stamp in fallen if resets[0] < stamp <= resets[1]]
        after = [(stamp - resets[1]).to_sec() * SPEED - fallen[stamp] for stamp in fallen if stamp > resets[1]]
        for stamp in before:  # the recording has five places
            self.assertAlmostEqual(fallen[stamp], (stamp - resets[0]).to_sec() * SPEED, delta=1e-4)
        end = resets[0] + rospy.Duration.from_sec(DURATION)
        self.assertLess(abs((before[-1] - end).to_sec()), 0.1)
        self.assertLess(max(map(abs, after)), 1e-4)
        # From the end of the recording to the reset there is nothing to compare.
        self.assertLess(max(before), end + rospy.Duration.from_sec(0.001))
        between = [label for label in hidden if end < label.header.stamp < resets[1]]
        self.assertGreater((between[-1].header.stamp - between[0].header.stamp).to_sec(), 2)
        for label in between:
            self.assertIn('back to the start', label.text)
        for word in ('WARN', 'ERROR', 'FATAL', 'Traceback', 'REQUIRED'):
            self.assertNotIn(word, output)

    def assert_refused(self, message):
        """Once, and with nothing else of a program's."""
        output = self.replay()
        self.assertEqual(output.count(self.path + ': '), 1, output)
        self.assertIn(f'{self.path}: {message}', output)
        for word in ('FATAL', 'Traceback', 'KeyboardInterrupt'):
            self.assertNotIn(word, output)

    def test_no_such_file(self):
        self.assert_refused('cannot be read')

    def test_other_file(self):
        with open(self.path, 'w', encoding='utf-8') as file:
            file.write('time,x,frame\n1,2,left\n')
        self.assert_refused('line 1: header "time,x,frame"; allowed: t,x0,y0,z0')


if __name__ == '__main__':
    rospy.init_node('display_replay_test')
    rostest.rosrun('verlet_cable', 'display_replay', ReplayTest)
