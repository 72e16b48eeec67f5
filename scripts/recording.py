"""A recorded cable: marker positions over time, and what follows from them. No ROS.

The format is that of the motion captures named in the README: a CSV with the header `t,x0,y0,z0,x1,y1,z1,...`, times in s and
positions in m, gravity along -z, markers numbered along the cable. The two markers at each end sit on what holds the cable.
"""
import os

import numpy as np

LARGEST_FILE = 1_000_000_000  # [bytes]
FEWEST_MARKERS = 4  # two at each end give the direction in which the cable is held
FEWEST_ROWS = 2     # give the velocity at the start


class RecordingError(Exception):
    """A file that is not a recording; the message names the file, what was found and what is needed."""


class Recording:
    """times: [s] (rows,), from 0; markers: [m] (rows, markers, 3); names follow the file."""

    def __init__(self, path):
        self.path = path
        header, rows = _read(path)
        _check(path, header, rows)
        self.times = rows[:, 0] - rows[0, 0]
        self.markers = rows[:, 1:].reshape(len(rows), -1, 3)

    @property
    def duration(self):
        """[s]"""
        return self.times[-1]

    def at(self, time):
        """Positions of the markers [m] at a time [s] of the recording, between rows on straight lines, held outside."""
        time = np.clip(time, 0, self.duration)
        after = int(np.clip(np.searchsorted(self.times, time), 1, len(self.times) - 1))
        fraction = (time - self.times[after - 1]) / (self.times[after] - self.times[after - 1])
        return (1 - fraction) * self.markers[after - 1] + fraction * self.markers[after]

    def initial_velocities(self):
        """[m/s] of every marker, from the first two rows."""
        return (self.markers[1] - self.markers[0]) / (self.times[1] - self.times[0])

    def length(self):
        """[m] of the cable between the outer markers: the median over the rows, as measured distances vary by some percent."""
        return float(np.median(np.linalg.norm(np.diff(self.markers, axis=1), axis=2).sum(axis=1)))

    def marker_places(self):
        """Where the markers sit, as fractions of the cable's length, from their distances in the first row."""
        steps = np.linalg.norm(np.diff(self.markers[0], axis=0), axis=1)
        return np.concatenate([[0], np.cumsum(steps)]) / steps.sum()

    def held_poses(self):
        """Positions [m] (rows, 3) and quaternions x, y, z, w (rows, 4) of what holds the start, and the same for the end.

        The origin is the outer marker, +x the direction of the cable from start to end; roll was not recorded and is the smallest
        rotation from the world's axes at the first row, then the smallest from row to row.
        """
        start = self.markers[:, 1] - self.markers[:, 0]
        end = self.markers[:, -1] - self.markers[:, -2]
        return (self.markers[:, 0], _carried_along(start)), (self.markers[:, -1], _carried_along(end))


def _read(path):
    if os.path.exists(path) and not os.path.isfile(path):
        raise RecordingError(f'{path}: not a file; allowed: a CSV file')
    try:
        with open(path, encoding='utf-8') as file:
            size = os.fstat(file.fileno()).st_size
            if size > LARGEST_FILE:
                raise RecordingError(f'{path}: {size} bytes; allowed: at most {LARGEST_FILE}')
            header = file.readline().strip().split(',')
            lines = [line.strip() for line in file]
    except OSError as error:
        raise RecordingError(f'{path}: cannot be read: {error.strerror}') from error
    except UnicodeDecodeError as error:
        raise RecordingError(f'{path}: is not a text file: {error}') from error
    _check_header(path, header)
    rows = []
    for number, line in enumerate(lines, start=2):
        if not line:
            continue
        try:
            row = [float(value) for value in line.split(',')]
        except ValueError as error:
            raise RecordingError(f'{path}: line {number}: {error}; allowed: numbers') from error
        if len(row) != len(header):
            raise RecordingError(f'{path}: line {number}: {len(row)} columns; allowed: {len(header)}, as the header has')
        rows.append(row)
    return header, np.array(rows)


def _check_header(path, header):
    markers = (len(header) - 1) // 3
    wanted = ['t'] + [f'{axis}{marker}' for marker in range(markers) for axis in 'xyz']
    if header != wanted or markers < FEWEST_MARKERS:
        raise RecordingError(f'{path}: line 1: header "{",".join(header)[:80]}"; allowed: t,x0,y0,z0,x1,y1,z1,... '
                             f'with {FEWEST_MARKERS} markers or more')


def _check(path, header, rows):
    markers = (len(header) - 1) // 3
    if len(rows) < FEWEST_ROWS:
        raise RecordingError(f'{path}: {len(rows)} rows, allowed are {FEWEST_ROWS} or more')
    if not np.isfinite(rows).all():
        row, column = np.argwhere(~np.isfinite(rows))[0]
        raise RecordingError(f'{path}: {header[column]} is {rows[row, column]} in row {row + 1}; only finite numbers are allowed')
    backwards = np.flatnonzero(np.diff(rows[:, 0]) <= 0)
    if backwards.size:
        row = backwards[0]
        raise RecordingError(f'{path}: t goes from {rows[row, 0]} to {rows[row + 1, 0]} in row {row + 2}; times must ascend')
    positions = rows[:, 1:].reshape(len(rows), -1, 3)
    for first, second in ((0, 1), (markers - 2, markers - 1)):
        same = np.flatnonzero(np.linalg.norm(positions[:, second] - positions[:, first], axis=1) == 0)
        if same.size:
            raise RecordingError(f'{path}: markers {first} and {second} are at the same place in row {same[0] + 1}; '
                                 'the direction of the cable between them is needed')


def _smallest_rotation(before, after):
    """Quaternion x, y, z, w that turns the unit vector `before` into `after` by the shortest way."""
    real = 1 + before @ after
    if real < 1e-12:  # opposite: half a turn about any axis across
        axis = np.cross(before, np.eye(3)[np.argmin(np.abs(before))])
        return np.append(axis / np.linalg.norm(axis), 0)
    quaternion = np.append(np.cross(before, after), real)
    return quaternion / np.linalg.norm(quaternion)


def _product(left, right):
    """Quaternion product, x, y, z, w."""
    u, v = left[:3], right[:3]
    product = np.append(left[3] * v + right[3] * u + np.cross(u, v), left[3] * right[3] - u @ v)
    return product / np.linalg.norm(product)


def _carried_along(directions):
    """Quaternions (rows, 4) whose x axes are the directions (rows, 3), each turned as little as possible from the one before."""
    directions = directions / np.linalg.norm(directions, axis=1)[:, None]
    quaternions = []
    last_direction, last = np.array([1.0, 0, 0]), np.array([0, 0, 0, 1.0])
    for direction in directions:
        last = _product(_smallest_rotation(last_direction, direction), last)
        last_direction = direction
        quaternions.append(last)
    return np.array(quaternions)
