#!/usr/bin/python3
"""play_motion.py _motion:=FILE.csv [_pause:=SECONDS]: sends the frames of a motion on tf at 100 Hz.

A motion is one as for cable_sim, with the columns t,frame,x,y,z,qx,qy,qz,qw. Between rows the frames move as there
(src/scene/motion.cpp): positions follow a cubic Hermite spline with limited tangents, orientations are interpolated by slerp. At the
beginning the frames stay where they are for a second, so that nobody sees them first on their way; at the end they stay for `~pause`
seconds and go back the way they came; then the cables are reset, and the motion starts again.
"""
import math
import os
import sys
import threading

import numpy as np
import rosgraph
import rospy
import tf2_ros
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from std_srvs.srv import Trigger

from verlet_cable.msg import CableArray

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import node_thread  # noqa: E402

RATE = 100.0  # [Hz]
REWIND = 3.0  # times as fast as forward
FIRST_PAUSE = 1.0  # [s] until everyone has heard of the frames
HEADER = 't,frame,x,y,z,qx,qy,qz,qw'
LARGEST = 1e9  # [s, m] as for cable_sim, and so
MOST_FRAMES = 20000
LEAST_QUATERNION = 1e-6
MOST_LISTED = 8  # frames in a message


class MotionError(Exception):
    """A file that is not a motion; the message names the file, the line, what was found and what is allowed."""


class Track:
    """The poses of a frame over time."""

    def __init__(self, rows):
        self.times = np.array([row[0] for row in rows])
        self._positions = np.array([row[1:4] for row in rows])
        self._orientations = np.array([row[4:8] for row in rows])
        self._orientations /= np.linalg.norm(self._orientations, axis=1)[:, None]

    def at(self, time):
        """Position and quaternion; held before the first row and after the last."""
        last = len(self.times) - 1
        if time <= self.times[0] or last == 0:
            return self._positions[0], self._orientations[0]
        if time >= self.times[last]:
            return self._positions[last], self._orientations[last]
        i = int(np.searchsorted(self.times, time, side='right')) - 1
        duration = self.times[i + 1] - self.times[i]
        u = (time - self.times[i]) / duration
        way = (u * u * (3 - 2 * u) * (self._positions[i + 1] - self._positions[i])
               + u * (1 - u) * ((1 - u) * self._tangent(i, duration) - u * self._tangent(i + 1, duration)))
        return self._positions[i] + way, slerp(self._orientations[i], self._orientations[i + 1], u)

    def _tangent(self, row, duration):
        """The spline's tangent at a row times the duration [m] of the interval before or after it."""
        def velocity(start, end):
            return (self._positions[end] - self._positions[start]) / ((self.times[end] - self.times[start]) / duration)

        if row == 0:
            return velocity(0, 1)
        if row == len(self.times) - 1:
            return velocity(row - 1, row)
        mean = velocity(row - 1, row + 1)
        longest = 3 * min(np.linalg.norm(velocity(row - 1, row)), np.linalg.norm(velocity(row, row + 1)))
        length = np.linalg.norm(mean)
        return longest / length * mean if length > longest else mean


def slerp(first, second, u):
    """Between two unit quaternions, the short way."""
    cosine = first @ second
    if cosine < 0:
        second, cosine = -second, -cosine
    weights = 1 - u, u
    if cosine < 1 - np.finfo(float).eps:
        angle = np.arccos(cosine)
        weights = np.sin((1 - u) * angle) / np.sin(angle), np.sin(u * angle) / np.sin(angle)
    orientation = weights[0] * first + weights[1] * second
    return orientation / np.linalg.norm(orientation)


def read_motion(path):
    """Tracks by frame. Raises MotionError."""
    try:
        if os.path.exists(path) and not os.path.isfile(path):
            raise MotionError(f'motion: "{os.path.abspath(path)}": not a file; allowed: a CSV file')
        with open(path, encoding='utf-8-sig') as file:
            lines = [(number, line.strip()) for number, line in enumerate(file, start=1)]
    except FileNotFoundError as error:
        raise MotionError(f'motion: "{os.path.abspath(path)}": no such file') from error
    except OSError as error:
        raise MotionError(f'motion: "{os.path.abspath(path)}": cannot be read: {error.strerror}') from error
    except UnicodeDecodeError as error:
        raise MotionError(f'{path}: not a text file; allowed: {HEADER}') from error
    lines = [(number, line) for number, line in lines if line]
    if not lines:
        raise MotionError(f'{path}: empty; allowed: the header {HEADER} and rows')
    number, header = lines[0]
    if header != HEADER:
        raise MotionError(f'{path}: line {number}: header "{header[:80]}"; allowed: {HEADER}')
    rows = {}
    for number, line in lines[1:]:
        frame, row = read_row(line, f'{path}: line {number}')
        earlier = rows.setdefault(frame, [])
        if earlier and row[0] <= earlier[-1][0]:
            raise MotionError(f'{path}: line {number}: t {row[0]:g} of "{frame}"; allowed: times that ascend, the frame\'s last one is '
                              f'{earlier[-1][0]:g}')
        earlier.append(row)
    if not rows:
        raise MotionError(f'{path}: no rows; allowed: at least one pose')
    if len(rows) > MOST_FRAMES:
        raise MotionError(f'{path}: {len(rows)} frames; allowed: at most {MOST_FRAMES}')
    return {frame: Track(numbers) for frame, numbers in rows.items()}


def read_row(line, place):
    """The frame of a row, and its numbers: t, x, y, z, qx, qy, qz, qw."""
    cells = [cell.strip() for cell in line.split(',')]
    names = HEADER.split(',')
    if len(cells) != len(names):
        raise MotionError(f'{place}: {len(cells)} columns; allowed: {len(names)}: {HEADER}')
    numbers = []
    for name, cell in zip(names, cells):
        if name == 'frame':
            continue
        try:
            number = float(cell)
        except ValueError:
            number = math.nan
        if not abs(number) <= LARGEST:
            raise MotionError(f'{place}: {name} "{cell}"; allowed: numbers from {-LARGEST:g} to {LARGEST:g}')
        numbers.append(number)
    frame = cells[names.index('frame')]
    if not frame or frame.startswith('/'):
        raise MotionError(f'{place}: frame "{frame}"; allowed: names of tf frames, without a leading /')
    if np.linalg.norm(numbers[4:]) < LEAST_QUATERNION:
        raise MotionError(f'{place}: quaternion of length 0; allowed: any other, it is normalized')
    return frame, numbers


def transform(frame, pose, stamp):
    message = TransformStamped()
    message.header.stamp = stamp
    message.header.frame_id = 'world'
    message.child_frame_id = frame
    message.transform.translation = Vector3(*pose[0])
    message.transform.rotation = Quaternion(*pose[1])
    return message


class Player:
    """Sends the frames. What they do next begins where they are: none ever jumps, and no stamp comes twice."""

    def __init__(self, tracks):
        self._tracks = tracks
        self.duration = max(track.times[-1] for track in tracks.values())
        self._broadcaster = tf2_ros.TransformBroadcaster()
        self._rate = rospy.Rate(RATE)

    def stay(self, seconds):
        """At the first row."""
        self._go(lambda elapsed: 0, seconds)

    def play(self, pause):
        """From the first row to the last, and stays there."""
        self._go(lambda elapsed: elapsed, self.duration + pause)

    def rewind(self):
        """The same way back."""
        self._go(lambda elapsed: self.duration - REWIND * elapsed, self.duration / REWIND)

    def wait_for_simulation(self):
        """Stays at the first row until the cables have been simulated up to now: they run behind ROS time."""
        arrived = rospy.Time.now()
        seen = threading.Event()
        subscriber = rospy.Subscriber('cable/state', CableArray, lambda state: seen.set() if state.header.stamp > arrived else None)
        while not seen.is_set() and not rospy.is_shutdown():
            self._send(0, rospy.Time.now())
        subscriber.unregister()

    def _go(self, time_at, seconds):
        started = now = rospy.Time.now()
        while (now - started).to_sec() < seconds and not rospy.is_shutdown():
            self._send(time_at((now - started).to_sec()), now)
            now = rospy.Time.now()

    def _send(self, time, stamp):
        self._broadcaster.sendTransform([transform(frame, track.at(time), stamp) for frame, track in self._tracks.items()])
        self._rate.sleep()


def warn_of_unused(path, frames):
    """Warns once if the node `cable`, whose diagnostics list its frames, has none of the motion's."""
    node = rospy.resolve_name('cable')
    looked = threading.Event()

    def look(message):
        status = next((status for status in message.status if status.name == f'{node[1:]}: frames'), None)
        if status is None or looked.is_set():
            return
        looked.set()
        used = [entry.key[len('frame '):] for entry in status.values if entry.key.startswith('frame ') and entry.value != "a body's"]
        if not set(used) & set(frames):
            rospy.logwarn('%s: nothing moves: it has the frames %s, and the node %s uses %s', path, listed(frames), node,
                          listed(used) if used else 'none')

    rospy.Subscriber('/diagnostics', DiagnosticArray, look)


def listed(frames):
    names = [f'"{frame}"' for frame in sorted(frames)]
    return ', '.join(names[:MOST_LISTED]) + (f' and {len(names) - MOST_LISTED} more' if len(names) > MOST_LISTED else '')


def main():
    if len(sys.argv) == 1 and not rosgraph.is_master_online():
        print(__doc__.split('\n', maxsplit=1)[0], file=sys.stderr)
        sys.exit(2)
    node_thread.run('play_motion', play)


def play():
    # Without the underscore it is a name that is remapped, and the parameter is that of the last run.
    mistaken = [argument for argument in sys.argv[1:] if argument.startswith(('motion:=', 'pause:='))]
    if mistaken:
        print(f'play_motion.py: {" ".join(mistaken)}; allowed: _motion:=FILE.csv, _pause:=SECONDS', file=sys.stderr)
        sys.exit(2)
    path = rospy.get_param('~motion', '')
    if not path:
        print('play_motion.py: motion: not set; allowed: the path of a CSV file, as _motion:=FILE.csv', file=sys.stderr)
        sys.exit(2)
    try:
        tracks = read_motion(path)
    except MotionError as error:
        sys.exit(f'play_motion.py: {error}')
    player = Player(tracks)
    warn_of_unused(path, tracks)
    rospy.loginfo('plays %s, %.3g s, goes back, resets the cables and begins again; Ctrl-C ends it', path, player.duration)
    reset = rospy.ServiceProxy('cable/reset', Trigger)
    player.stay(FIRST_PAUSE)
    while not rospy.is_shutdown():
        player.play(rospy.get_param('~pause', 2.0))
        player.rewind()
        player.wait_for_simulation()
        if not rospy.is_shutdown():
            reset()


if __name__ == '__main__':
    main()
