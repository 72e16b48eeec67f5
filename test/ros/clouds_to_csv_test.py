#!/usr/bin/python3
"""clouds_to_csv: clouds of bags and PLY files become points over time, and tf the motion that goes with them."""
import os
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import rosbag
import rospkg
import rospy
import rostest
from sensor_msgs.msg import PointCloud2, PointField
from tf2_msgs.msg import TFMessage

from cable_client import transform

SCRIPTS = os.path.join(rospkg.RosPack().get_path('verlet_cable'), 'scripts')
sys.path.insert(0, SCRIPTS)
from play_motion import read_motion  # noqa: E402
from ply_points import PlyError, read_ply  # noqa: E402

START = 1_700_000_000  # [s] as of real bags
ROWS = 10
CABLE, OTHER = 1, 2  # labels
POINTS = np.array([[0.1 * i, 0.02 * i, 0.5 - 0.1 * i] for i in range(12)])
HALF = np.sqrt(0.5)
RECORD = np.dtype({'names': ['x', 'y', 'z', 'label'], 'formats': ['<f4', '<f4', '<f4', '<u4'], 'offsets': [0, 4, 8, 20],
                   'itemsize': 24})


def stamp(row):
    return rospy.Time(START, 0) + rospy.Duration.from_sec(0.1 * row)


def points_at(row):
    """In the frame world: those of the cable."""
    return POINTS + [0, 0.01 * row, 0]


def cloud(row, height=1, padding=0):
    """A pixel of the cable, one of something else and one without depth, in turn; each row of pixels ends in `padding` bytes."""
    records = np.zeros(3 * len(POINTS), RECORD)
    # The camera looks from above: turned half a turn about x, 2 m up.
    seen = points_at(row) * [1, -1, -1] + [0, 0, 2]
    for first, values, label in ((0, seen, CABLE), (1, seen + [0, 0, 0.3], OTHER), (2, np.full_like(seen, np.nan), CABLE)):
        for axis, column in zip('xyz', values.T):
            records[axis][first::3] = column
        records['label'][first::3] = label
    width = len(records) // height
    lines = [records[i * width:(i + 1) * width].tobytes() + b'\xff' * padding for i in range(height)]
    message = PointCloud2(height=height, width=width, point_step=24, row_step=24 * width + padding, data=b''.join(lines))
    message.header.stamp = stamp(row)
    message.header.frame_id = 'camera'
    message.fields = [PointField(name, offset, kind, 1) for name, offset, kind in (
        ('x', 0, PointField.FLOAT32), ('y', 4, PointField.FLOAT32), ('z', 8, PointField.FLOAT32), ('rgb', 16, PointField.FLOAT32),
        ('label', 20, PointField.UINT32))]
    return message


class WithFiles(unittest.TestCase):
    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.directory = directory.name
        self.csv = self.path('clouds.csv')

    def path(self, name):
        return os.path.join(self.directory, name)

    def run_it(self, *arguments, output=None):
        command = [os.path.join(SCRIPTS, 'clouds_to_csv'), self.csv if output is None else output, *arguments]
        return subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)

    def expect_done(self, done):
        """Times, and the points of each."""
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.csv, encoding='utf-8') as file:
            self.assertEqual(file.readline(), 't,x,y,z\n')
            rows = np.array([[float(cell) for cell in line.split(',')] for line in file])
        self.assertTrue((np.diff(rows[:, 0]) >= 0).all())
        times = np.unique(rows[:, 0])
        return times, [rows[rows[:, 0] == time, 1:] for time in times]

    def expect_refused(self, done, *expected):
        self.assertEqual(done.returncode, 2, done.stderr)
        for text in expected:
            self.assertIn(text, done.stderr)
        self.assertNotIn('Traceback', done.stderr)
        self.assertIn('; allowed: ', done.stderr)
        self.assertFalse(os.path.exists(self.csv))


class BagsToCsv(WithFiles):
    def setUp(self):
        super().setUp()
        self.bag = self.path('take.bag')
        self.motion = self.path('motion.csv')
        with rosbag.Bag(self.bag, 'w') as bag:
            self.write_tf(bag)
            for row in range(ROWS):
                bag.write('/points', cloud(row), stamp(row))
            # Organized, and told late: rows go by the stamps.
            for row in (1, 0, 2):
                bag.write('/organized', cloud(row, height=6, padding=8), stamp(row + 5))
            early, empty = cloud(-5), cloud(0)
            empty.width, empty.data, empty.row_step = 0, b'', 0
            for number, message in enumerate((early, empty, cloud(1), cloud(2))):
                bag.write('/gaps', message, stamp(number))

    @staticmethod
    def write_tf(bag):
        """A hand on an arm that moves at twice the rate of the clouds, with a tool that is fixed to it."""
        bag.write('/tf_static', TFMessage([transform('camera', stamp(0), (0, 0, 2), (1, 0, 0, 0), 'world'),
                                           transform('tool', stamp(0), (0.1, 0, 0), (0, 0, 0, 1), 'hand')]), stamp(0))
        for half in range(-4, 2 * ROWS + 4):
            time = stamp(0.5 * half)
            bag.write('/tf', TFMessage([transform('arm', time, (0, 0.01 * half, 0.5), (0, 0, HALF, HALF), 'world')]), time)
            if half % 4 == 0:
                bag.write('/tf', TFMessage([transform('hand', time, (0, 0, 0.1), (0, 0, 0, 1), 'arm')]), time)

    def convert(self, topic, *arguments, output=None):
        return self.run_it('--bag', self.bag, '--points', topic, *arguments, output=output)

    def test_points_of_one_label_in_the_fixed_frame(self):
        done = self.convert('/points', '--fixed', 'world', '--label', str(CABLE))
        times, clouds = self.expect_done(done)
        np.testing.assert_allclose(times, 0.1 * np.arange(ROWS), atol=1e-12)  # stamps are whole nanoseconds
        for row in range(ROWS):
            np.testing.assert_allclose(clouds[row], points_at(row), atol=1e-6)  # float32
        self.assertEqual(done.stdout, f'clouds_to_csv: {ROWS} clouds with {ROWS * len(POINTS)} points\n')

    def test_all_labels_where_none_is_asked_for(self):
        times, clouds = self.expect_done(self.convert('/points'))
        self.assertEqual(len(times), ROWS)
        seen = points_at(0) * [1, -1, -1] + [0, 0, 2]
        np.testing.assert_allclose(clouds[0], np.stack([seen, seen + [0, 0, 0.3]], axis=1).reshape(-1, 3), atol=1e-6)

    def test_organized_clouds_with_padding_that_come_late(self):
        times, clouds = self.expect_done(self.convert('/organized', '--fixed', 'world', '--label', str(CABLE)))
        np.testing.assert_allclose(times, [0, 0.1, 0.2], atol=1e-12)
        for row in range(3):
            np.testing.assert_allclose(clouds[row], points_at(row), atol=1e-6)

    def test_box_and_thinning(self):
        box = ('--box', '0.05', '0.75', '-10', '10', '-10', '10')
        done = self.convert('/points', '--fixed', 'world', '--label', str(CABLE), *box, '--most', '3')
        _, clouds = self.expect_done(done)
        for row in range(ROWS):
            np.testing.assert_allclose(clouds[row], points_at(row)[[1, 3, 5]], atol=1e-6)  # of 1 to 7

    def test_fewer_clouds(self):
        for arguments, rows in ((('--every', '4'), [0, 4, 8]), (('--rate', '10'), range(ROWS)), (('--rate', '2.5'), [0, 2, 6]),
                                (('--every', '3', '--rate', '1'), [0, 6])):
            times, _ = self.expect_done(self.convert('/points', *arguments))
            np.testing.assert_allclose(times, 0.1 * np.array(rows), atol=1e-12)

    def test_motion_has_the_stamps_of_what_carries_the_frame(self):
        done = self.convert('/points', '--fixed', 'world', '--motion', self.motion, '--frame', 'tool', '--frame', 'camera')
        self.expect_done(done)
        tracks = read_motion(self.motion)
        self.assertEqual(sorted(tracks), ['camera', 'tool'])
        np.testing.assert_allclose(tracks['tool'].times, 0.05 * np.arange(2 * ROWS - 1), atol=1e-12)
        np.testing.assert_allclose(tracks['camera'].times, [0, 0.1 * (ROWS - 1)], atol=1e-12)
        for half, time in enumerate(tracks['tool'].times):
            position, quaternion = tracks['tool'].at(time)
            np.testing.assert_allclose(position, [0, 0.1 + 0.01 * half, 0.6], atol=1e-12)
            np.testing.assert_allclose(quaternion, [0, 0, HALF, HALF], atol=1e-12)

    def test_what_has_no_tf_or_points_is_left_out_and_told(self):
        done = self.convert('/gaps', '--fixed', 'world', '--motion', self.motion, '--frame', 'hand')
        times, _ = self.expect_done(done)
        np.testing.assert_allclose(times, [0, 0.1], atol=1e-12)  # of those that are written
        self.assertIn('2 clouds with 48 points, 1 clouds without tf left out, 1 clouds without points left out', done.stdout)
        np.testing.assert_allclose(read_motion(self.motion)['hand'].times, [0, 0.05, 0.1], atol=1e-12)

    def test_what_is_wrong_is_said_and_nothing_written(self):
        for arguments, expected in (
                (('/nothing',), ("take.bag: --points: the bag has no '/nothing'; allowed: /gaps, /organized, /points",)),
                (('/tf',), ('--points: /tf is of type tf2_msgs/TFMessage; allowed: sensor_msgs/PointCloud2',)),
                (('/points', '--label', '7'), ('/points: 0 points, 10 clouds without points left out; allowed: 2 or more',)),
                (('/points', '--fixed', 'nowhere', '--motion', self.motion, '--frame', 'hand'),
                 ("--fixed: tf reaches 'camera' from 'nowhere' at none of 10 messages; allowed: connected ones of arm, ",
                  "--frame: tf reaches 'hand' from 'nowhere' at none of 10 messages"))):
            self.expect_refused(self.convert(*arguments), *expected)
            self.assertFalse(os.path.exists(self.motion))

    def test_all_wrong_options_are_told_at_once(self):
        done = self.convert('', *('--every 0 --most 2000001 --rate nan --label -3000000000 --times /nowhere --box 0 1 3 2 0 nan '
                                  '--frame a,b --frame c --frame c --fixed /world').split())
        self.expect_refused(done, '--points: it is empty', '--every: 0; allowed: 1 to', '--most: 2000001; allowed: 1 to 2000000',
                            '--rate: nan; allowed: 0.001 to 1000000 [Hz]', '--label: -3000000000',
                            '--times: it is given with --bag; allowed: only with --ply', "--times: '/nowhere' is no file",
                            '--box: y from 3 to 2', '--box: z from 0 to nan', "--frame: 'a,b'", "--frame: 'c' 2 times",
                            "--fixed: '/world'", '--motion and --frame: only one is given')

    def test_outputs_are_neither_inputs_nor_each_other(self):
        for arguments, output, expected in (
                ((), self.bag, 'is an input'), ((), '', 'it is empty'), ((), '/nonexistent/o.csv', 'No such file or directory'),
                (('--motion', self.bag, '--frame', 'hand'), None, 'is an input'),
                (('--motion', self.csv, '--frame', 'hand'), None, 'is the other output')):
            self.expect_refused(self.convert('/points', *arguments, output=output), expected)

    def test_clouds_without_the_label_or_of_wrong_sizes(self):
        def refuse(expected, **changes):
            message = cloud(0)
            for name, value in changes.items():
                setattr(message, name, value)
            with rosbag.Bag(self.bag, 'w') as bag:
                bag.write('/points', message, stamp(0))
            self.expect_refused(self.convert('/points', '--label', '1'), f'take.bag: {expected}')

        refuse('--label: the fields of the points are x, y, z, rgb; allowed', fields=cloud(0).fields[:4])
        refuse('point_step: 23; allowed: at least the 24 bytes to the end of x, y, z and label', point_step=23)
        refuse('row_step: ', width=4_000_000_000)

    def test_frames_that_differ_need_a_fixed_one(self):
        other = cloud(1)
        other.header.frame_id = 'elsewhere'
        with rosbag.Bag(self.bag, 'w') as bag:
            bag.write('/points', cloud(0), stamp(0))
            bag.write('/points', other, stamp(1))
        self.expect_refused(self.convert('/points'), "--fixed: none, and messages in 'camera' and 'elsewhere'")

    def test_clouds_of_one_time_go_together(self):
        with rosbag.Bag(self.bag, 'w') as bag:
            for row in (0, 0, 0.1, 1):
                bag.write('/points', cloud(row), stamp(row))
        times, clouds = self.expect_done(self.convert('/points', '--label', str(CABLE), '--rate', '10'))
        np.testing.assert_allclose(times, [0, 0.1], atol=1e-12)
        self.assertEqual([len(points) for points in clouds], [2 * len(POINTS), len(POINTS)])

    def test_a_full_device_exits_with_three(self):
        done = self.convert('/points', output='/dev/full')
        self.assertEqual(done.returncode, 3, done.stderr)
        self.assertIn('/dev/full: [Errno 28] No space left on device', done.stderr)

    def test_rosrun_finds_it_and_standard_output_has_the_rows_alone(self):
        command = f'rosrun verlet_cable clouds_to_csv /dev/stdout --bag {self.bag} --points /points --most 5'.split()
        done = subprocess.run(command, capture_output=True, text=True, timeout=60, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(len(done.stdout.splitlines()), 1 + 5 * ROWS)


def ply(kind, before='', after='', vertices=len(POINTS)):
    """A header with x, y and z among other properties, in another order."""
    return (f'ply\nformat {kind} 1.0\ncomment of a test\n{before}element vertex {vertices}\nproperty uchar red\nproperty double z\n'
            f'property float x\nproperty short y\n{after}end_header\n').encode()


def text_rows(points):
    return ''.join(f'7 {z!r} {x!r} {y!r}\n' for x, y, z in points.tolist()).encode()


class PlyToCsv(WithFiles):
    # y of whole numbers, as its type is short
    points = POINTS * [1, 0, 1] + np.outer(np.arange(len(POINTS)), [0, 1, 0])

    def write(self, name, content):
        with open(self.path(name), 'wb') as file:
            file.write(content)
        return self.path(name)

    def bytes_of(self, order):
        records = np.zeros(len(POINTS), [('red', 'u1'), ('z', order + 'f8'), ('x', order + 'f4'), ('y', order + 'i2')])
        for axis, column in zip('xyz', self.points.T):
            records[axis] = column
        return records.tobytes()

    def test_all_formats(self):
        before = 'element camera 2\nproperty float fx\nproperty int n\n'
        after = 'element face 1\nproperty list uchar int vertex_indices\n'
        for kind, content in (('ascii', b'1 2\n3 4\n' + text_rows(self.points) + b'3 0 1 2\n'),
                              ('binary_little_endian', b'\0' * 16 + self.bytes_of('<') + b'\3' + b'\0' * 12),
                              ('binary_big_endian', b'\0' * 16 + self.bytes_of('>') + b'\3' + b'\0' * 12)):
            file = self.write('a.ply', ply(kind, before, after) + content)
            np.testing.assert_allclose(read_ply(file), self.points, atol=1e-7)
        file = self.write('a.ply', (ply('ascii') + text_rows(self.points)).replace(b'\n', b'\r\n'))
        np.testing.assert_allclose(read_ply(file), self.points, atol=1e-15)
        self.assertEqual(read_ply(self.write('a.ply', ply('ascii', vertices=0))).shape, (0, 3))
        self.assertEqual(read_ply(self.write('a.ply', ply('binary_big_endian', vertices=0))).shape, (0, 3))

    def errors_of(self, content):
        with self.assertRaises(PlyError) as refused:
            read_ply(self.write('a.ply', content))
        return refused.exception.errors

    def test_all_that_is_wrong_with_a_header_is_said(self):
        errors = self.errors_of(b'ply\nformat ascii 2.0\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty half y\n'
                                b'property list uchar int links\nproperty float x\nelement face -1\nnonsense\nend_header\n')
        for error, expected in zip(errors, (
                'line 2: format "ascii 2.0"; allowed: ascii 1.0, binary_little_endian 1.0, binary_big_endian 1.0',
                'line 6: type half of y; allowed: char, ', 'line 8: property x once more',
                'line 9: -1 elements face; allowed: 0 to', 'line 10: "nonsense"; allowed: format, ',
                '2 lines with a format; allowed: 1', 'vertex has the list links; allowed: scalar properties',
                'vertex has no y; allowed: x, y and z', 'vertex has no z; ')):
            self.assertTrue(error.startswith(expected), (error, expected))
        self.assertEqual(len(errors), 9)

    def test_files_that_are_wrong(self):
        faces = 'element face 1\nproperty list uchar int links\n'
        for content, expected in (
                (b'solid\n', 'it does not begin with a line "ply"'),
                (b'', 'it does not begin with a line "ply"'),
                (b'ply\nformat ascii 1.0\n', '2 lines of a header without end_header'),
                (b'ply\n' + b'comment\n' * 2000, '1001 lines of a header without end_header'),
                (b'ply\nformat ascii 1.0\nend_header\n', '0 elements vertex; allowed: 1'),
                (ply('binary_little_endian', faces) + self.bytes_of('<'), 'face has the list links and comes before vertex'),
                (ply('binary_little_endian') + self.bytes_of('<')[:-1], '179 bytes of vertices; allowed: 180'),
                (ply('binary_little_endian', vertices=10**9), '0 bytes of vertices; allowed: 15000000000'),
                (ply('binary_little_endian', vertices=10**30), f'line 4: {10**30} elements vertex; allowed: 0 to 1000000000'),
                (ply('ascii') + text_rows(self.points[:5]), '5 lines of vertices; allowed: 12'),
                (ply('ascii', vertices=2) + b'1 2 3 x\n', 'line 10: could not convert string to float'),
                (ply('ascii', vertices=2) + b'1 2 3\n', 'line 10: 3 numbers; allowed: 4 numbers: red z x y')):
            self.assertTrue(self.errors_of(content)[0].startswith(expected), (self.errors_of(content), expected))

    def files(self, count):
        nan = b'7 nan 0 0\n'
        return [self.write(f'{i}.ply', ply('ascii', vertices=len(POINTS) + 1) + nan + text_rows(self.points + [i, 0, 0]))
                for i in range(count)]

    def test_times_of_a_rate_and_of_a_file(self):
        times_file = self.write('times.txt', b'0.5\n\n0.75\n3\n')
        for arguments, expected in ((('--rate', '4'), [0, 0.25, 0.5]), (('--times', times_file), [0.5, 0.75, 3])):
            times, clouds = self.expect_done(self.run_it('--ply', *self.files(3), *arguments))
            np.testing.assert_array_equal(times, expected)
            for i in range(3):
                np.testing.assert_allclose(clouds[i], self.points + [i, 0, 0], atol=1e-12)

    def test_box_and_thinning(self):
        _, clouds = self.expect_done(self.run_it('--ply', *self.files(1), *'--rate 4 --most 2 --box -1 9 -1 3.5 -9 9'.split()))
        np.testing.assert_allclose(clouds[0], self.points[[0, 2]], atol=1e-12)  # of 0 to 3

    def test_all_wrong_files_are_told_at_once(self):
        times_file = self.write('times.txt', b'0.5\n0.5\nsoon\n-1\ninf\n')
        bad = self.write('bad.ply', ply('ascii').replace(b'property float x\n', b''))
        done = self.run_it('--ply', *self.files(1), bad, self.path('missing.ply'), self.directory, '--times', times_file)
        self.expect_refused(done, "times.txt: line 2: '0.5'; allowed: a time", "line 3: 'soon'", "line 4: '-1'", "line 5: 'inf'",
                            'times.txt: 5 times; allowed: 4, one for each PLY file', 'bad.ply: vertex has no x',
                            'missing.ply: it cannot be read: No such file', f'{self.directory}: it is no file')

    def test_points_beyond_all_measure(self):
        for content, expected in ((b'7 1 1e10 1\n', 'far.ply: a coordinate of 1e+10 m; allowed: -1e+09 to 1e+09'),
                                  (b'7 1 1 1\n', '--ply: 1 points; allowed: 2 or more')):
            far = self.write('far.ply', ply('ascii', vertices=1) + content)
            self.expect_refused(self.run_it('--ply', far, '--rate', '1'), expected)

    def test_more_points_than_a_fit_takes(self):
        records = np.zeros(1_100_000, [('x', '<f4'), ('y', '<f4'), ('z', '<f4')])
        header = (b'ply\nformat binary_little_endian 1.0\nelement vertex 1100000\nproperty float x\nproperty float y\n'
                  b'property float z\nend_header\n')
        large = self.write('large.ply', header + records.tobytes())
        done = self.run_it('--ply', large, large, '--rate', '1', '--most', '2000000')
        self.expect_refused(done, 'large.ply: more than 2000000 points in all; allowed: fewer clouds, or fewer points by --most')

    def test_options_of_bags(self):
        done = self.run_it('--ply', *self.files(1), '--label', '0', '--every', '1')
        self.expect_refused(done, '--label: it is given with --ply; allowed: only with --bag', '--every: it is given with --ply',
                            '--rate and --times: none of them; allowed with --ply: one')


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'clouds_to_csv', '__main__')  # both classes
