#!/usr/bin/python3
"""example_frames.py: moves the frames of one of config/examples, and says in rviz what there is to see.

Publishes tf at 100 Hz and example/labels. `~example` names the example. Where hands let go of something it asks the node for that,
and for a reset when it begins again.
"""
import itertools
import os
import sys
import threading

import rospy
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from verlet_cable.srv import Unpin

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import example_motions  # noqa: E402
import moving_frames  # noqa: E402
import node_thread  # noqa: E402

# By example: [what, x, y, z, height: m].
TEXTS = {
    'hose_between_arms': [
        ('two arms bend and twist a hose', 0, 0, 1.28, 0.06)],
    'tethered_drone': [
        ('a drone on a tether, in wind', 0, 0, 2.75, 0.14), ('ground station', -0.1, 0, 0.35, 0.1), ('wind', -1.3, 0, 1.6, 0.12)],
    'crane': [
        ('a crane: the winch on the trolley hoists a payload', 0, 0, 2.5, 0.1), ('payload: 5 kg', 0, 0, 0.2, 0.1)],
    'rov_tether': [
        ('the tether between a ship and an underwater robot, in a current', 0.5, 0, 0.55, 0.12),
        ('water surface', -0.9, -0.6, 0.08, 0.1), ('current', -0.8, 0, -0.8, 0.12)],
    'tracker': [
        ('what a depth camera sees of a rope: blue', 0, 0, 1.38, 0.055),
        ('where its nodes are, at the same stamp: red', 0, 0, 1.3, 0.055)],
    'gripper_load': [
        ('the load of a cable on a gripper', 0.3, 0, 1.5, 0.06),
        ('orange: force, 1 N is 6 cm; purple: torque, 1 N m is 20 cm', 0.3, 0, 1.42, 0.045),
        ('wall', -0.05, 0, 1.25, 0.05)],
    'harness': [
        ('two hands lay a wire harness on a board, whose clips hold it', 0, 0, 0.52, 0.04)],
    'plug': [
        ('a clip takes the cable behind a plug that a hand pushes into a socket', -0.12, 0, 0.26, 0.013)],
    'finger': [
        ('a tendon bends a finger, rubber bands over sheaves straighten it', 0.01, 0, 0.2, 0.008)],
    'drones_with_bar': [
        ('two drones carry a bar of 1.2 kg on ropes', 0, 0, 2.55, 0.12), ('purple: what each bears', 0, 0, 2.38, 0.09)],
}

# By example: from where to where [m].
ARROWS = {
    'tethered_drone': [((-1.55, 0, 1.45), (-1.05, 0, 1.45))],
    'rov_tether': [((-1.05, 0, -1), (-0.55, 0, -1))],
}

# By example: its size and its depth [m].
WATER = {'rov_tether': ((4.5, 3.5), 0.02)}


def handle(example, started):
    """Lets go of what the example's hands hold, and resets the cables when it begins again."""
    unpin, reset = rospy.ServiceProxy('cable/unpin', Unpin), rospy.ServiceProxy('cable/reset', Trigger)
    seconds, names = example_motions.RELEASES[example]
    try:
        for begin in itertools.count(started.to_sec(), example_motions.PERIODS[example]):
            rospy.sleep(begin + seconds - rospy.get_time())
            for name in names:
                unpin(name)
            rospy.sleep(begin + example_motions.PERIODS[example] - rospy.get_time())
            reset()
    except (rospy.ROSException, rospy.ServiceException) as problem:
        if not rospy.core.is_shutdown_requested():
            rospy.logwarn('%s', problem)


def main():
    node_thread.run('example_frames', move_frames)


def move_frames():
    example = rospy.get_param('~example')
    labels = rospy.Publisher('example/labels', MarkerArray, queue_size=1, latch=True)
    shown = [moving_frames.label(number, *text) for number, text in enumerate(TEXTS[example])]
    shown += [moving_frames.arrow(number, *ends) for number, ends in enumerate(ARROWS.get(example, []))]
    if example in WATER:
        shown.append(moving_frames.water(*WATER[example]))
    labels.publish(shown)

    def when_started(started):
        if example in example_motions.RELEASES:
            threading.Thread(target=handle, args=[example, started], daemon=True).start()

    moving_frames.move_frames(example_motions.EXAMPLES[example], when_started)


if __name__ == '__main__':
    main()
