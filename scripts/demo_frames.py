#!/usr/bin/python3
"""demo_frames.py: moves the frames of config/demo.yaml, and every 24 s cuts the rope at its tightest and later resets the scene.

Publishes tf left_hand, right_hand, hook and swivel at 100 Hz, and demo/markers: what there is to see, in words.
"""
import math
import os
import sys
import threading

import rospy
import tf2_ros
from geometry_msgs.msg import Point, Quaternion, TransformStamped, Vector3
from std_msgs.msg import ColorRGBA
from std_srvs.srv import Trigger
from visualization_msgs.msg import Marker, MarkerArray

from verlet_cable.msg import CableLocation
from verlet_cable.srv import Cut

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import node_thread  # noqa: E402

FIXED_FRAME = 'world'
RATE = 100.0          # [Hz]
PULL_PERIOD = 8.0     # [s] the hands pull the rope tight once in each, at its middle
CYCLE = 24.0          # [s] three pulls
CUT_AT = 20.0         # [s] of the cycle, at a pull
RESET_AT = 23.9       # [s] of the cycle, when the hands are close again
CUT_PLACE = 0.6       # [m] from the start of the rope


def turn(t, period):
    return 2 * math.pi * t / period


def pose(x, y, z, pitch=0.0):
    """Position [m] and pitch [rad]."""
    return Point(x, y, z), Quaternion(0, math.sin(pitch / 2), 0, math.cos(pitch / 2))


def frame_poses(t):
    """Where each frame is at a time [s]."""
    apart = 0.7225 - 0.22 * math.cos(turn(t, PULL_PERIOD))  # [m] half the distance of the hands
    sway = 0.12 * math.sin(turn(t, PULL_PERIOD / 2))
    tilt = math.radians(60) * (1 + math.cos(turn(t, PULL_PERIOD))) / 2  # the hands point along the rope
    whirl = turn(t, 0.8)
    return {
        'left_hand': pose(-apart, sway, 0.95, pitch=tilt),
        'right_hand': pose(apart, -sway, 0.95, pitch=-tilt),
        'hook': pose(-1.5 + 0.15 * math.sin(turn(t, 3.0)), 0, 1.1),
        'swivel': pose(1.5 + 0.1 * math.cos(whirl), 0.1 * math.sin(whirl), 1.1),
    }


def transform(name, frame_pose, stamp):
    message = TransformStamped()
    message.header.stamp = stamp
    message.header.frame_id = FIXED_FRAME
    message.child_frame_id = name
    position, message.transform.rotation = frame_pose
    message.transform.translation = Vector3(position.x, position.y, position.z)
    return message


def label(number, text, x, z):
    marker = Marker(ns='labels', id=number, type=Marker.TEXT_VIEW_FACING, text=text, color=ColorRGBA(0.1, 0.1, 0.12, 1))
    marker.header.frame_id = FIXED_FRAME
    marker.pose.position = Point(x, 0, z)
    marker.pose.orientation.w = 1
    marker.scale.z = 0.075
    return marker


class Director:
    """Cuts and resets at the times of the cycle, in a thread of its own, so that no answer holds up the frames."""

    def __init__(self):
        self._labels = rospy.Publisher('demo/markers', MarkerArray, queue_size=1, latch=True)
        self._cut = rospy.ServiceProxy('cable/cut', Cut)
        self._reset = rospy.ServiceProxy('cable/reset', Trigger)

    def run(self, started):
        try:
            self._run(started)
        except (rospy.ROSException, rospy.ServiceException):
            if not rospy.core.is_shutdown_requested():
                raise

    def _run(self, started):
        rospy.wait_for_service('cable/cut')
        rospy.wait_for_service('cable/reset')
        cycle = 0
        while not rospy.is_shutdown():
            self._show('a rope between two moving frames')
            self._sleep_until(started, cycle * CYCLE + CUT_AT)
            self._check(self._cut(CableLocation(cable='rope', mode=CableLocation.ARC_LENGTH, arc_length=CUT_PLACE)))
            self._show(f'cut by the demo, whole again in {RESET_AT - CUT_AT:.0f} s')
            self._sleep_until(started, cycle * CYCLE + RESET_AT)
            self._check(self._reset())
            cycle += 1

    @staticmethod
    def _sleep_until(started, seconds):
        rospy.sleep(max(rospy.Duration(0), started + rospy.Duration.from_sec(seconds) - rospy.Time.now()))

    @staticmethod
    def _check(answer):
        if not answer.success:
            rospy.logwarn('%s', answer.message)

    def _show(self, rope):
        self._labels.publish([label(0, rope, 0, 1.12), label(1, 'a payload', -1.5, 1.2), label(2, 'a free end', 1.5, 1.2)])


def main():
    node_thread.run('demo_frames', move_frames)


def move_frames():
    broadcaster = tf2_ros.TransformBroadcaster()
    rate = rospy.Rate(RATE)
    started = rospy.Time.now()
    director = Director()
    threading.Thread(target=director.run, args=(started,), daemon=True).start()
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        poses = frame_poses((now - started).to_sec())
        broadcaster.sendTransform([transform(name, frame_pose, now) for name, frame_pose in poses.items()])
        rate.sleep()


if __name__ == '__main__':
    main()
