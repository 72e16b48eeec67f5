#!/usr/bin/python3
"""record_to_csv: bags with state or points and the grippers' tf become recordings that cable_fit reads."""
import os
import resource
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import rosbag
import rospkg
import rospy
import rostest
from geometry_msgs.msg import Point
from sensor_msgs.msg import PointCloud2, PointField
from tf2_msgs.msg import TFMessage

from cable_client import transform
from verlet_cable.msg import Cable, CableArray

SCRIPTS = os.path.join(rospkg.RosPack().get_path('verlet_cable'), 'scripts')
sys.path.insert(0, SCRIPTS)
from output_file import stopped_by_signals, written_whole  # noqa: E402
from recording import Recording  # noqa: E402

ROWS = 20
NODES = np.array([[0.1 * i, 0.02 * i, 0.5 - 0.1 * i] for i in range(1, 7)])


def nodes_at(row):
    return NODES + [0, 0.01 * row, 0]


def stamp(row):
    return rospy.Time.from_sec(100 + 0.02 * row)


def state(row):
    message = CableArray()
    message.header.stamp = stamp(row)
    message.header.frame_id = 'world'
    for name in ('other', 'lead'):
        shift = [0, 0, 5] if name == 'other' else [0, 0, 0]
        message.cables.append(Cable(name=name, positions=[Point(*(p + shift)) for p in nodes_at(row)]))
    return message


def cloud(row, points):
    message = PointCloud2(height=1, width=len(points), point_step=16, row_step=16 * len(points))
    message.header.stamp = stamp(row)
    message.header.frame_id = 'camera'
    message.fields = [PointField(name, offset, PointField.FLOAT32, 1) for name, offset in zip('xyz', (4, 8, 12))]
    data = np.zeros((len(points), 4), np.float32)
    data[:, 1:] = points
    message.data = data.tobytes()
    return message


class RecordToCsv(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.bag = os.path.join(directory.name, 'take.bag')
        self.csv = os.path.join(directory.name, 'take.csv')
        # The camera looks from above: turned half a turn about x, 2 m up. The end's gripper is turned a quarter about z.
        with rosbag.Bag(self.bag, 'w') as bag:
            for row in range(ROWS):
                half = np.sqrt(0.5)
                bag.write('/tf', TFMessage([
                    transform('camera', stamp(row), (0, 0, 2), (1, 0, 0, 0)),
                    transform('start_hand', stamp(row), (0, 0.01 * row, 0.5), (0, 0, 0, 1)),
                    transform('end_hand', stamp(row), (0.7, 0.1 + 0.01 * row, 0), (0, 0, half, half)),
                ]), stamp(row))
                bag.write('/cable/state', state(row), stamp(row))
                seen = nodes_at(row) * [1, -1, -1] + [0, 0, 2]
                bag.write('/points', cloud(row, seen), stamp(row))
                bag.write('/uneven', cloud(row, seen[:3 + row % 2]), stamp(row))

    def convert(self, *arguments, output=None):
        command = [os.path.join(SCRIPTS, 'record_to_csv'), self.bag, self.csv if output is None else output, *arguments]
        return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)

    def expect_recorded(self, tolerance):
        recording = Recording(self.csv)
        self.assertEqual(recording.markers.shape, (ROWS, 10, 3))
        np.testing.assert_allclose(recording.times, 0.02 * np.arange(ROWS), atol=1e-9)
        for row in range(ROWS):
            y = 0.01 * row
            expected = np.vstack([[[0, y, 0.5], [0.03, y, 0.5]], nodes_at(row), [[0.7, 0.07 + y, 0], [0.7, 0.1 + y, 0]]])
            np.testing.assert_allclose(recording.markers[row], expected, atol=tolerance)

    def test_state_with_grippers(self):
        done = self.convert('--state', '/cable/state', '--cable', 'lead', '--start', 'start_hand', '--end', 'end_hand',
                            '--offset', '0.03')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.expect_recorded(1e-12)

    def test_points_seen_by_a_camera(self):
        done = self.convert('--points', '/points', '--fixed', 'world', '--start', 'start_hand', '--end', 'end_hand',
                            '--offset', '0.03')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.expect_recorded(1e-6)  # float32

    def test_rosrun_finds_it_and_what_it_needs(self):
        command = ['rosrun', 'verlet_cable', 'record_to_csv', self.bag, self.csv, '--state', '/cable/state', '--cable', 'lead']
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(Recording(self.csv).markers.shape, (ROWS, 6, 3))

    def test_points_alone(self):
        done = self.convert('--state', '/cable/state', '--cable', 'lead')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(Recording(self.csv).markers.shape, (ROWS, 6, 3))

    def test_what_is_wrong_is_said_and_nothing_written(self):
        for arguments, expected in (
                (('--state', '/nothing'), '/nothing: no messages'),
                (('--state', '/points'), '--state: /points is of type sensor_msgs/PointCloud2; allowed: verlet_cable/CableArray'),
                (('--points', '/cable/state'),
                 '--points: /cable/state is of type verlet_cable/CableArray; allowed: sensor_msgs/PointCloud2'),
                (('--state', '/cable/state'), '--cable: None; allowed: one of other, lead'),
                (('--points', '/uneven'), '3 to 4 points; allowed: the same number'),
                (('--points', '/points', '--fixed', 'nowhere'), 'tf reaches none of its messages'),
                (('--points', '/points', '--start', 'start_hand'), '--start and --end: only one is given')):
            done = self.convert(*arguments)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(expected, done.stderr)
            self.assertFalse(os.path.exists(self.csv))

    def test_a_full_disk_leaves_what_was_there(self):
        with open(self.csv, 'w', encoding='utf-8') as file:
            file.write('old')
        # Not the whole script with this limit: rosbag writes files of its own.
        script = ("import sys; sys.path.insert(0, sys.argv[1]); from output_file import written_whole\n"
                  "with written_whole(sys.argv[2]) as file: file.write('x' * 1001)")
        done = subprocess.run([sys.executable, '-c', script, SCRIPTS, self.csv], capture_output=True, text=True, timeout=60,
                              check=False, preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000)))
        self.assertIn('File too large', done.stderr)
        self.expect_only_old()

    def test_killed_it_leaves_what_was_there(self):
        with open(self.csv, 'w', encoding='utf-8') as file:
            file.write('old')
        script = ("import os, signal, sys; sys.path.insert(0, sys.argv[1]); from output_file import written_whole\n"
                  "with written_whole(sys.argv[2]) as file:\n"
                  "    file.write('new'); file.flush(); os.kill(os.getpid(), signal.SIGKILL)")
        done = subprocess.run([sys.executable, '-c', script, SCRIPTS, self.csv], timeout=60, check=False)
        self.assertEqual(done.returncode, -signal.SIGKILL)
        self.expect_only_old()

    def test_a_full_device_exits_with_three(self):
        done = self.convert('--state', '/cable/state', '--cable', 'lead', output='/dev/full')
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn('/dev/full: [Errno 28] No space left on device', done.stderr)

    def expect_only_old(self):
        with open(self.csv, encoding='utf-8') as file:
            self.assertEqual(file.read(), 'old')
        self.assertEqual(sorted(os.listdir(os.path.dirname(self.csv))), ['take.bag', 'take.csv'])

    def test_a_signal_leaves_what_was_there(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with open(self.csv, 'w', encoding='utf-8') as file:
                file.write('old')
            with self.assertRaises(KeyboardInterrupt), stopped_by_signals(), written_whole(self.csv) as file:
                file.write('new')
                os.kill(os.getpid(), number)
                signal.sigtimedwait([], 10)  # never so long
            self.expect_only_old()

    def test_clouds_whose_sizes_lie_are_refused_before_memory_is_taken(self):
        lies = ({'width': 4_000_000_000}, {'height': 4_000_000_000, 'row_step': 64}, {'width': 0, 'height': 4_000_000_000}, {'point_step': 0},
                {'point_step': 15}, {'row_step': 4_000_000_000}, {'data': b'12345'})
        words = ('row_step: 64', 'data: 64 bytes', 'data: 64 bytes', 'point_step: 0', 'point_step: 15', 'data: 64 bytes', 'data: 5 bytes')
        for lie, word in zip(lies, words):
            message = cloud(0, NODES[:4])
            for name, value in lie.items():
                setattr(message, name, value)
            with rosbag.Bag(self.bag, 'w') as bag:
                bag.write('/points', message, stamp(0))
            done = self.convert('--points', '/points')
            self.assertEqual(done.returncode, 2, (lie, done.stderr))
            self.assertIn(f'take.bag: {word}', done.stderr)
            self.assertIn('; allowed: ', done.stderr)
            self.assertFalse(os.path.exists(self.csv))

    def test_damaged_messages_are_refused(self):
        with open(self.bag, 'rb') as file:
            content = file.read()
        with open(self.bag, 'wb') as file:
            file.write(content.replace(b'lead', b'le\xffd').replace(b'\x05\x00\x00\x00other', b'\xff\xff\xff\x7fother'))
        done = self.convert('--state', '/cable/state')
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn('take.bag: it cannot be read: ', done.stderr)
        self.assertNotIn('Traceback', done.stderr)

    def test_links_and_permissions_stay(self):
        link = self.csv + '.link'
        os.symlink('take.csv', link)
        with written_whole(link) as file:
            file.write('old')
        os.chmod(self.csv, 0o640)
        with written_whole(link) as file:
            file.write('new')
        self.assertTrue(os.path.islink(link))
        self.assertEqual(os.stat(self.csv).st_mode & 0o7777, 0o640)

    def test_standard_output_has_the_rows_alone(self):
        done = self.convert('--state', '/cable/state', '--cable', 'lead', output='/dev/stdout')
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(done.stdout.splitlines()), 1 + ROWS)
        self.assertIn('20 rows of 6 markers', done.stderr)

    def test_what_cannot_be_written_is_refused_before_the_bag_is_read(self):
        pipe = self.csv + '.pipe'
        os.mkfifo(pipe)
        for output, expected in ((pipe, 'it is a named pipe'), ('/nonexistent/o.csv', 'No such file or directory'),
                                 ('/', 'Is a directory'), ('', 'it is empty'), (self.bag, 'is the bag; allowed: another file')):
            done = self.convert('--state', '/cable/state', '--cable', 'lead', output=output)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(expected, done.stderr)

    def test_a_marker_is_near_its_gripper(self):
        for offset in ('0', '1e308'):
            done = self.convert('--state', '/cable/state', '--cable', 'lead', '--start', 'start_hand', '--end', 'end_hand',
                                f'--offset={offset}')
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn('allowed: above 0, at most 10.0 [m]', done.stderr)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'record_to_csv', RecordToCsv)
