#!/usr/bin/python3
"""play_motion.py: sends the frames of a motion (CSV: t,frame,x,y,z,qx,qy,qz,qw, as for cable_sim) on tf at 100 Hz.

Between rows positions follow a cubic Hermite spline (Catmull-Rom), as in cable_sim, orientations a normalized line. When all is
played, the frames stay for `~pause` seconds; then the cables are reset, and it begins again. Nothing moves where there is no file.
"""
import csv
import os

import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import Quaternion, TransformStamped, Vector3
from std_srvs.srv import Trigger

RATE = 100.0  # [Hz]


class Track:
    """The poses of a frame over time."""

    def __init__(self, rows):
        self.times = np.array([row[0] for row in rows])
        self._positions = np.array([row[1:4] for row in rows])
        self._orientations = np.array([row[4:8] for row in rows])
        self._velocities = np.zeros_like(self._positions)
        if len(rows) > 2:
            spans = self.times[2:] - self.times[:-2]
            self._velocities[1:-1] = (self._positions[2:] - self._positions[:-2]) / spans[:, None]

    def at(self, time):
        """Position and quaternion; held before the first row and after the last."""
        last = len(self.times) - 1
        time = min(max(time, self.times[0]), self.times[last])
        i = min(int(np.searchsorted(self.times, time, side='right')) - 1, last - 1)
        if i < 0:
            return self._positions[0], self._orientations[0]
        h = self.times[i + 1] - self.times[i]
        s = (time - self.times[i]) / h
        p, v = self._positions, self._velocities
        position = ((1 + 2 * s) * (1 - s) ** 2 * p[i] + s * (1 - s) ** 2 * h * v[i]
                    + s * s * (3 - 2 * s) * p[i + 1] + s * s * (s - 1) * h * v[i + 1])
        first, second = self._orientations[i], self._orientations[i + 1]
        orientation = (1 - s) * first + s * (second if first @ second >= 0 else -second)
        return position, orientation / np.linalg.norm(orientation)


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


def main():
    rospy.init_node('play_motion')
    path = rospy.get_param('~motion')
    if not os.path.exists(path):
        rospy.loginfo('no motion: there is no %s', path)
        return
    tracks = read_motion(path)
    duration = max(track.times[-1] for track in tracks.values()) + rospy.get_param('~pause', 2.0)
    reset = rospy.ServiceProxy('cable/reset', Trigger)
    broadcaster = tf2_ros.TransformBroadcaster()
    rate = rospy.Rate(RATE)
    started = rospy.Time.now()
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        elapsed = (now - started).to_sec()
        broadcaster.sendTransform([transform(frame, track.at(min(elapsed, duration)), now) for frame, track in tracks.items()])
        if elapsed > duration:
            started = now
            broadcaster.sendTransform([transform(frame, track.at(0), now) for frame, track in tracks.items()])
            rospy.sleep(0.2)  # the simulation runs behind ROS time
            reset()
        rate.sleep()


if __name__ == '__main__':
    try:
        main()
    except rospy.ROSInterruptException:
        pass
