#!/usr/bin/python3
"""play_motion.py: sends the frames of a motion (CSV: t,frame,x,y,z,qx,qy,qz,qw, as for cable_sim) on tf at 100 Hz.

Between rows the frames move as in cable_sim (src/scene/motion.cpp): positions follow a cubic Hermite spline with limited tangents,
orientations slerp. When all is played, the frames stay for `~pause` seconds and go back the way they came; then the cables are reset,
and it begins again. Where there is no file, nothing moves: there is only a frame `scene`, so that tf knows `world`.
"""
import csv
import os
import sys
import threading

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from std_srvs.srv import Trigger

from verlet_cable.msg import CableArray

RATE = 100.0  # [Hz]
REWIND = 3.0  # times as fast as forward


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
    """Tracks by frame."""
    rows = {}
    with open(path, newline='') as file:
        for row in csv.DictReader(file):
            numbers = [float(row[key]) for key in ('t', 'x', 'y', 'z', 'qx', 'qy', 'qz', 'qw')]
            rows.setdefault(row['frame'], []).append(numbers)
    return {frame: Track(numbers) for frame, numbers in rows.items()}


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
        self._duration = max(track.times[-1] for track in tracks.values())
        self._broadcaster = tf2_ros.TransformBroadcaster()
        self._rate = rospy.Rate(RATE)

    def play(self, pause):
        """From the first row to the last, and stays there."""
        self._go(lambda elapsed: elapsed, self._duration + pause)

    def rewind(self):
        """The same way back."""
        self._go(lambda elapsed: self._duration - REWIND * elapsed, self._duration / REWIND)

    def wait_for_simulation(self):
        """Stays at the first row until the cables have been simulated up to now: they run behind ROS time."""
        arrived = rospy.Time.now()
        seen = threading.Event()
        subscriber = rospy.Subscriber('cable/state', CableArray, lambda state: seen.set() if state.header.stamp > arrived else None)
        while not seen.is_set() and not rospy.is_shutdown():
            self._send(0)
        subscriber.unregister()

    def _go(self, time_at, seconds):
        started = rospy.Time.now()
        elapsed = 0
        while elapsed < seconds and not rospy.is_shutdown():
            self._send(time_at(elapsed))
            elapsed = (rospy.Time.now() - started).to_sec()

    def _send(self, time):
        now = rospy.Time.now()
        self._broadcaster.sendTransform([transform(frame, track.at(time), now) for frame, track in self._tracks.items()])
        self._rate.sleep()


def main():
    rospy.init_node('play_motion')
    path = rospy.get_param('~motion', '')
    if not path:
        sys.exit('play_motion.py: no motion; type: rosrun verlet_cable play_motion.py _motion:=MOTION.csv')
    if not os.path.exists(path):
        rospy.loginfo('no motion file %s: nothing moves', path)
        # rviz warns of a fixed frame that tf does not know.
        broadcaster = tf2_ros.StaticTransformBroadcaster()
        broadcaster.sendTransform(transform('scene', ((0, 0, 0), (0, 0, 0, 1)), rospy.Time.now()))
        rospy.spin()
        return
    player = Player(read_motion(path))
    reset = rospy.ServiceProxy('cable/reset', Trigger)
    while not rospy.is_shutdown():
        player.play(rospy.get_param('~pause', 2.0))
        player.rewind()
        player.wait_for_simulation()
        if not rospy.is_shutdown():
            reset()


if __name__ == '__main__':
    try:
        main()
    except (rospy.ROSException, rospy.ServiceException):
        if not rospy.core.is_shutdown_requested():  # else it has only been ended
            raise
