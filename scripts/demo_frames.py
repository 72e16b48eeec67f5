#!/usr/bin/python3
"""demo_frames.py: moves the frames of config/demo.yaml, and every 24 s cuts the rope at its tightest and later resets the scene.

Publishes tf left_hand, right_hand, hook and swivel at 100 Hz, and demo/markers: what there is to see, in words.
"""
import os
import sys
import threading

import rospy
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from verlet_cable.msg import CableLocation
from verlet_cable.srv import Cut

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import moving_frames  # noqa: E402
import node_thread  # noqa: E402
from example_motions import DEMO_CYCLE, demo  # noqa: E402

CUT_AT = 20.0         # [s] of the cycle, at a pull
RESET_AT = 23.9       # [s] of the cycle, when the hands are close again
CUT_PLACE = 0.6       # [m] from the start of the rope
LABEL_HEIGHT = 0.075  # [m]


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
            self._sleep_until(started, cycle * DEMO_CYCLE + CUT_AT)
            self._check(self._cut(CableLocation(cable='rope', mode=CableLocation.ARC_LENGTH, arc_length=CUT_PLACE)))
            self._show(f'cut by the demo, whole again in {RESET_AT - CUT_AT:.0f} s')
            self._sleep_until(started, cycle * DEMO_CYCLE + RESET_AT)
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
        self._labels.publish([
            moving_frames.label(number, text, x, 0, z, LABEL_HEIGHT)
            for number, (text, x, z) in enumerate([(rope, 0, 1.12), ('a payload', -1.5, 1.2), ('a free end', 1.5, 1.2)])])


def main():
    node_thread.run('demo_frames', move_frames)


def move_frames():
    director = Director()
    moving_frames.move_frames(
        demo, lambda started: threading.Thread(target=director.run, args=(started,), daemon=True).start())


if __name__ == '__main__':
    main()
