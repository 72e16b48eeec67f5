#!/usr/bin/python3
"""Recordings as the replay reads them: what follows from the markers, and what is refused."""
import os
import sys
import tempfile
import unittest

import numpy as np
import rosunit

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..', '..', 'scripts'))
from recording import Recording, RecordingError  # noqa: E402

ROUNDING = 1e-12


def rotated(quaternion, vector):
    u, w = quaternion[:3], quaternion[3]
    return vector + 2 * np.cross(u, np.cross(u, vector) + w * vector)


class RecordingTest(unittest.TestCase):

    def setUp(self):
        self._directory = tempfile.TemporaryDirectory()
        self.path = os.path.join(self._directory.name, 'recording.csv')

    def tearDown(self):
        self._directory.cleanup()

    def write(self, text):
        with open(self.path, 'w', encoding='utf-8') as file:
            file.write(text)

    def write_markers(self, times, markers):
        header = ','.join(['t'] + [f'{axis}{i}' for i in range(len(markers[0])) for axis in 'xyz'])
        rows = [','.join(repr(float(value)) for value in [time, *np.ravel(row)]) for time, row in zip(times, markers)]
        self.write('\n'.join([header, *rows]) + '\n')
        return Recording(self.path)

    def straight(self, rows=2, speed=0.0):
        """Four markers at 0, 0.1, 0.4 and 0.5 m along x, moving along z."""
        times = [2.0 + 0.01 * row for row in range(rows)]
        markers = [[[x, 0, speed * 0.01 * row] for x in (0, 0.1, 0.4, 0.5)] for row in range(rows)]
        return self.write_markers(times, markers)

    def test_what_follows_from_the_markers(self):
        recording = self.straight(rows=3, speed=0.7)
        np.testing.assert_allclose(recording.times, [0, 0.01, 0.02], atol=ROUNDING)
        np.testing.assert_allclose(recording.marker_places(), [0, 0.2, 0.8, 1], atol=ROUNDING)
        np.testing.assert_allclose(recording.initial_velocities(), [[0, 0, 0.7]] * 4, atol=ROUNDING)
        self.assertAlmostEqual(recording.length(), 0.5, places=12)

    def test_length_is_that_of_most_rows(self):
        markers = [[[x * scale, 0, 0] for x in (0, 0.1, 0.4, 0.5)] for scale in (1.5, 1, 1, 1, 0.2)]
        self.assertAlmostEqual(self.write_markers(range(5), markers).length(), 0.5, places=12)

    def test_between_rows_and_outside(self):
        recording = self.straight(rows=3, speed=1.0)
        self.assertAlmostEqual(recording.at(0.013)[2][2], 0.013, places=12)
        np.testing.assert_array_equal(recording.at(-1), recording.markers[0])
        np.testing.assert_array_equal(recording.at(99), recording.markers[-1])

    def test_held_poses_follow_the_cable(self):
        rng = np.random.default_rng(0)
        markers = rng.normal(size=(50, 4, 3))
        recording = self.write_markers(range(50), markers)
        directions = (markers[:, 1] - markers[:, 0], markers[:, -1] - markers[:, -2])
        for (positions, quaternions), outer, along in zip(recording.held_poses(), (0, -1), directions):
            np.testing.assert_array_equal(positions, recording.markers[:, outer])
            for quaternion, direction in zip(quaternions, along):
                expected = direction / np.linalg.norm(direction)
                np.testing.assert_allclose(rotated(quaternion, np.array([1.0, 0, 0])), expected, atol=ROUNDING)

    def test_roll_is_the_smallest_there_is(self):
        # A direction that goes round one octant of the sphere, x to y to z to x, comes back rolled by the octant's area, pi / 2.
        angles = np.linspace(0, np.pi / 2, 200)
        c, s, o = np.cos(angles), np.sin(angles), np.zeros(200)
        path = np.concatenate([np.column_stack(leg) for leg in ((c, s, o), (o, c, s), (s, o, c))])
        markers = [[[0, 0, 0], direction, direction + np.array([1, 0, 0]), direction + np.array([2, 0, 0])] for direction in path]
        (_, quaternions), _ = self.write_markers(range(len(path)), markers).held_poses()
        np.testing.assert_allclose(rotated(quaternions[0], np.array([0, 1.0, 0])), [0, 1, 0], atol=ROUNDING)
        np.testing.assert_allclose(rotated(quaternions[-1], np.array([0, 1.0, 0])), [0, 0, 1], atol=1e-10)  # 600 products

    def assert_refused(self, *wanted):
        with self.assertRaises(RecordingError) as caught:
            Recording(self.path)
        for text in (self.path, *wanted):
            self.assertIn(text, str(caught.exception))

    def test_no_file(self):
        self.assert_refused('cannot be read')

    def test_other_columns(self):
        self.write('time,x,y\n1,2,3\n')
        self.assert_refused('time,x,y', 't,x0,y0,z0')

    def test_too_few_markers(self):
        self.write('t,x0,y0,z0,x1,y1,z1\n0,1,2,3,4,5,6\n1,1,2,3,4,5,6\n')
        self.assert_refused('4 markers')

    def header(self):
        return ','.join(['t'] + [f'{axis}{i}' for i in range(4) for axis in 'xyz']) + '\n'

    def row(self, time, last='12'):
        return f'{time},1,2,3,4,5,6,7,8,9,10,11,{last}\n'

    def test_too_few_rows(self):
        self.write(self.header() + self.row(0))
        self.assert_refused('1 rows', '2 or more')

    def test_text_in_a_number(self):
        self.write(self.header() + self.row(0) + self.row(1, 'twelve'))
        self.assert_refused('line 3:', 'twelve')

    def test_missing_value(self):
        self.write(self.header() + self.row(0) + '1,2,3\n')
        self.assert_refused('line 3:', '3 columns', 'allowed: 13')

    def test_nan(self):
        self.write(self.header() + self.row(0) + self.row(1, 'nan'))
        self.assert_refused('z3', 'nan')

    def test_time_goes_back(self):
        self.write(self.header() + self.row(1) + self.row(1))
        self.assert_refused('ascend')

    def test_no_direction(self):
        self.write(self.header() + '0,1,2,3,1,2,3,7,8,9,10,11,12\n1,1,2,3,1,2,3,7,8,9,10,11,12\n')
        self.assert_refused('markers 0 and 1')


if __name__ == '__main__':
    rosunit.unitrun('verlet_cable', 'display_recording', RecordingTest)
