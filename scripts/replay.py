#!/usr/bin/python3
"""replay.py _data:=FILE.csv [_loop:=true]: plays a recorded cable against the simulated one, see replay.launch.

A run: the grippers are held at the first pose until the cable hangs still; tf stops, so that the simulation has to wait for it;
`reset` puts the cable into the recorded shape and motion; the recording plays from exactly that time on. From its end to the next
reset the measured cable is not shown, as there is nothing to compare. Without `loop` one run is played and its mean error logged.

Publishes tf start_gripper and end_gripper, replay/markers (the measured cable) and replay/error (running mean [m] over the frames
of a run, all markers, the three coordinates of |simulated - measured|).
"""
import signal

# Where replay.launch ends while this still starts, SIGINT is no traceback of an import; rospy takes it over later.
signal.signal(signal.SIGINT, signal.SIG_DFL)

import os  # noqa: E402
import sys  # noqa: E402
import threading  # noqa: E402
import time  # noqa: E402

import numpy as np  # noqa: E402
import rospy  # noqa: E402
import tf2_ros  # noqa: E402
from geometry_msgs.msg import Point, Quaternion, TransformStamped, Vector3  # noqa: E402
from std_msgs.msg import ColorRGBA, Float64  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402
from visualization_msgs.msg import Marker, MarkerArray  # noqa: E402

from verlet_cable.msg import CableArray, CableEvent  # noqa: E402

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import node_thread  # noqa: E402
from recording import Recording, RecordingError  # noqa: E402

FIXED_FRAME = 'world'
TF_PERIOD = 0.01          # [s]
HOLD_BEFORE = 1.5         # [s] at the first pose
HOLD_AFTER = 1.0          # [s] at the last pose
RETURN = 2.0              # [s] from the last pose to the first
STANDSTILL = 0.15         # [s] without tf after which the simulation has used up what it had: a multiple of tf_latency
ANSWER_TIMEOUT = 10.0     # [s] for the node
LOOK_PERIOD = 0.1         # [s] while it is waited for
MEASURED_COLOR = ColorRGBA(0.1, 0.6, 0.25, 0.8)
TEXT_COLOR = ColorRGBA(0.1, 0.1, 0.12, 1.0)


class MeanError:
    """Running mean of |simulated - measured| over frames, markers and coordinates [m]."""

    def __init__(self):
        self.frames = 0
        self.mean = 0.0

    def add(self, simulated, measured):
        self.frames += 1
        self.mean += (np.abs(simulated - measured).mean() - self.mean) / self.frames


def points_at(cable, fractions):
    """Positions (n, 3) on a cable message at fractions of its rest length."""
    nodes = np.array([(p.x, p.y, p.z) for p in cable.positions])
    places = fractions * cable.rest_length
    return np.column_stack([np.interp(places, cable.arc_length, nodes[:, axis]) for axis in range(3)])


def blend(pose, other, fraction):
    """Between two poses (position, quaternion): straight, and the short way round."""
    position = (1 - fraction) * pose[0] + fraction * other[0]
    towards = other[1] if pose[1] @ other[1] >= 0 else -other[1]
    quaternion = (1 - fraction) * pose[1] + fraction * towards
    return position, quaternion / np.linalg.norm(quaternion)


class Grippers:
    """The two recorded ends as tf frames."""

    FRAMES = ('start_gripper', 'end_gripper')

    def __init__(self, recording):
        self._poses = [list(zip(positions, quaternions)) for positions, quaternions in recording.held_poses()]
        self._broadcaster = tf2_ros.TransformBroadcaster()

    def row(self, row):
        """The two poses of a row."""
        return [poses[row] for poses in self._poses]

    def send(self, poses, stamp):
        self._broadcaster.sendTransform([self._transform(frame, pose, stamp) for frame, pose in zip(self.FRAMES, poses)])

    @staticmethod
    def _transform(frame, pose, stamp):
        transform = TransformStamped()
        transform.header.stamp = stamp
        transform.header.frame_id = FIXED_FRAME
        transform.child_frame_id = frame
        transform.transform.translation = Vector3(*pose[0])
        transform.transform.rotation = Quaternion(*pose[1])
        return transform


class MeasuredCable:
    """The measured cable as markers: a line through the markers, a ball on each, and the error as text."""

    def __init__(self):
        self._publisher = rospy.Publisher('replay/markers', MarkerArray, queue_size=5)

    def publish(self, positions, stamp, text, shown):
        """The markers at their positions, or where they are not shown only the text."""
        points = [Point(*position) for position in positions]
        line = self._marker('measured', Marker.LINE_STRIP, stamp)
        line.scale.x = 0.006
        line.points = points
        balls = self._marker('measured markers', Marker.SPHERE_LIST, stamp)
        balls.scale = Vector3(0.022, 0.022, 0.022)
        balls.points = points
        if not shown:
            line.action = balls.action = Marker.DELETE
        label = self._marker('error', Marker.TEXT_VIEW_FACING, stamp)
        label.color = TEXT_COLOR
        label.scale.z = 0.045
        label.text = text
        label.pose.position = Point(*(positions[[0, -1]].mean(axis=0) + [0, 0, 0.22]))
        self._publisher.publish([line, balls, label])

    @staticmethod
    def _marker(namespace, kind, stamp):
        marker = Marker(ns=namespace, type=kind, color=MEASURED_COLOR)
        marker.header.frame_id = FIXED_FRAME
        marker.header.stamp = stamp
        marker.pose.orientation.w = 1
        return marker


class Replay:
    """Plays the runs. The main thread sends tf, the callbacks of `state` and `events` compare and tell when a run begins."""

    def __init__(self, recording):
        self._recording = recording
        self._places = recording.marker_places()
        self._grippers = Grippers(recording)
        self._measured = MeasuredCable()
        self._error_publisher = rospy.Publisher('replay/error', Float64, queue_size=5)
        self._lock = threading.Lock()
        self._start = None       # stamp at which the last run was at row 0
        self._time = 0.0         # [s] of the recording, up to the last state
        self._compared = 0.0     # [s] of the recording, up to here
        self._error = MeanError()
        self._cable_seen = threading.Event()
        self._reset_seen = threading.Event()  # cleared while that of this node is waited for; others change nothing
        self._reset_seen.set()
        rospy.Subscriber('cable/events', CableEvent, self._on_event, queue_size=10)
        rospy.Subscriber('cable/state', CableArray, self._on_state, queue_size=100)

    def play(self):
        """One run; returns its mean error."""
        self._hold(self._grippers.row(0), HOLD_BEFORE, until=self._cable_seen)
        start = self._begin_at_row_0()
        for row, moment in enumerate(self._recording.times[1:], start=1):
            stamp = start + rospy.Duration.from_sec(moment)
            self._sleep_until(stamp)
            self._grippers.send(self._grippers.row(row), stamp)
        self._hold(self._grippers.row(-1), HOLD_AFTER)
        with self._lock:
            return self._error

    def go_back(self):
        """Moves the grippers from the last pose to the first, softly."""
        began = rospy.Time.now()
        while not rospy.is_shutdown():
            done = (rospy.Time.now() - began).to_sec() / RETURN
            if done >= 1:
                return
            soft = done * done * (3 - 2 * done)
            poses = [blend(last, first, soft) for last, first in zip(self._grippers.row(-1), self._grippers.row(0))]
            self._send_now(poses)

    def _begin_at_row_0(self):
        """Resets the cable while the simulation waits for tf; the stamp at which that was."""
        rospy.sleep(STANDSTILL)
        self._reset_seen.clear()
        answer = rospy.ServiceProxy('cable/reset', Trigger)()
        if not answer.success:
            raise rospy.ServiceException(f'/cable/reset: {answer.message}')
        if not self._wait_for_reset():
            raise rospy.ServiceException(f'/cable/events: no RESET within {ANSWER_TIMEOUT} s of /cable/reset')
        with self._lock:
            return self._start

    def _wait_for_reset(self):
        deadline = time.monotonic() + ANSWER_TIMEOUT
        while time.monotonic() < deadline and not rospy.is_shutdown():
            if self._reset_seen.wait(LOOK_PERIOD):
                return True
        return False

    def _hold(self, poses, duration, until=None):
        """Holds the grippers for a duration, counted from when `until` has happened."""
        began = rospy.Time.now()
        while not rospy.is_shutdown() and (rospy.Time.now() - began).to_sec() < duration:
            if until is not None and not until.is_set():
                began = rospy.Time.now()
            self._send_now(poses)

    def _send_now(self, poses):
        self._grippers.send(poses, rospy.Time.now())
        rospy.sleep(TF_PERIOD)

    @staticmethod
    def _sleep_until(stamp):
        remaining = stamp - rospy.Time.now()
        if remaining > rospy.Duration(0):
            rospy.sleep(remaining)

    def _on_event(self, event):
        if event.type == CableEvent.RESET and not self._reset_seen.is_set():
            with self._lock:
                self._start = event.header.stamp
                self._compared = 0.0
                self._error = MeanError()
            self._reset_seen.set()

    def _on_state(self, state):
        try:
            self._compare(state)
        except rospy.ROSException:
            if not rospy.core.is_shutdown_requested():  # else the topics are closed
                raise

    def _compare(self, state):
        if not state.cables:
            return
        self._cable_seen.set()
        stamp = state.header.stamp
        with self._lock:
            # A state from before the reset is of the run before: the measured cable begins again together with the simulated one.
            if self._start is not None and stamp > self._start:
                self._time = (stamp - self._start).to_sec()
            measured = self._recording.at(self._time)
            if self._compared < self._time <= self._recording.duration:
                self._compared = self._time
                self._error.add(points_at(state.cables[0], self._places), measured)
                self._error_publisher.publish(self._error.mean)
            ended = self._time > self._recording.duration
            title = 'back to the start' if ended else 'orange: simulated, green: measured'
            self._measured.publish(measured, stamp, f'{title}\nmean error {100 * self._error.mean:.1f} cm', shown=not ended)


def main():
    node_thread.run('replay', replay_runs)


def replay_runs():
    loop = rospy.get_param('~loop', True)
    rospy.wait_for_service('cable/reset')  # first: what is wrong with the recording, replay_scene.py has said before the node starts
    replay = Replay(Recording(rospy.get_param('~data')))
    while not rospy.is_shutdown():
        error = replay.play()
        if rospy.is_shutdown():
            return
        rospy.loginfo('mean error %.2f cm over %d frames', 100 * error.mean, error.frames)
        if not loop:
            return
        replay.go_back()


if __name__ == '__main__':
    try:
        main()
    except (RecordingError, rospy.ROSException, rospy.ServiceException) as problem:
        rospy.logfatal('%s', problem)
        sys.exit(1)
