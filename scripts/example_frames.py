#!/usr/bin/python3
"""example_frames.py: moves the frames of one of config/examples, and says in rviz what there is to see.

Publishes tf at 100 Hz and example/labels. `~example` names the example. Where hands let go of something it asks the node for that,
and for a reset when it begins again.
"""
import itertools
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

from verlet_cable.msg import CableArray
from verlet_cable.srv import Unpin

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import node_thread  # noqa: E402

FIXED_FRAME = 'world'
RATE = 100.0  # [Hz]
# [s] After which an example begins again; when in it its hands let go [s], and of what.
PERIODS = {'harness': 22.0, 'plug': 16.5}
RELEASES = {'harness': (7.5, ['left_hand', 'right_hand']), 'plug': (6.5, ['grip'])}


def swing(t, period, phase=0.0):
    """-1 to 1."""
    return math.sin(2 * math.pi * t / period + phase)


def pose(x, y, z, roll=0.0, pitch=0.0, yaw=0.0):
    """Position [m] and orientation, from fixed-axis roll, pitch and yaw [rad]."""
    (sr, cr), (sp, cp), (sy, cy) = ((math.sin(a / 2), math.cos(a / 2)) for a in (roll, pitch, yaw))
    return Vector3(x, y, z), Quaternion(sr * cp * cy - cr * sp * sy, cr * sp * cy + sr * cp * sy, cr * cp * sy - sr * sp * cy,
                                        cr * cp * cy + sr * sp * sy)


def hose_between_arms(t):
    apart = 0.44 + 0.12 * swing(t, 10)  # [m] half the distance of the grippers
    return {'left_gripper': pose(-apart, 0, 1, roll=2.0 * swing(t, 16), pitch=0.3 * swing(t, 10, 1)),
            'right_gripper': pose(apart, 0.1 * swing(t, 7), 1, pitch=0.3 * swing(t, 10, 2), yaw=math.pi)}


def tethered_drone(t):
    return {'drone': pose(0.2 + 0.8 * swing(t, 12, math.pi / 2), 0.8 * swing(t, 12), 2.0 + 0.3 * swing(t, 8),
                          roll=0.08 * swing(t, 3), pitch=0.15, yaw=0.3 * swing(t, 12))}


def crane(t):
    return {'trolley': pose(0.6 * swing(t, 14), 0, 2.2)}


def rov_tether(t):
    return {'ship': pose(0, 0, 0.08 * swing(t, 5), pitch=0.1 * swing(t, 5, 1)),
            'rov': pose(1.1 + 0.3 * swing(t, 15), 0.3 * swing(t, 20), -1.8 + 0.25 * swing(t, 11), yaw=0.5 * swing(t, 20))}


def tracker(t):
    return {'left_hand': pose(-0.4 - 0.1 * swing(t, 6), 0.1 * swing(t, 8), 1.05),
            'right_hand': pose(0.4 + 0.1 * swing(t, 6), -0.1 * swing(t, 8), 1.05 + 0.1 * swing(t, 5)),
            # z forward, x right, y down
            'camera_optical_frame': pose(0.15 * swing(t, 13), -1.2, 1.0, roll=-math.pi / 2)}


def gripper_load(t):
    return {'gripper': pose(0.55 + 0.15 * swing(t, 7), 0.15 * swing(t, 5), 1.0 + 0.15 * swing(t, 9), roll=0.8 * swing(t, 8),
                            pitch=0.4 * swing(t, 6), yaw=math.pi)}


def drones_with_bar(t):
    x, y, yaw = 0.5 * swing(t, 11), 0.3 * swing(t, 9), 0.5 * swing(t, 17)
    apart = 0.75 + 0.12 * swing(t, 8)  # [m] half the distance of the drones
    rise = 0.2 * swing(t, 7)           # [m] of the left one above the right one, half of it
    along, across = apart * math.cos(yaw), apart * math.sin(yaw)
    roll, pitch = 0.06 * swing(t, 4), 0.08 * swing(t, 5)
    return {'left_drone': pose(x - along, y - across, 1.9 + rise, roll, pitch, yaw),
            'right_drone': pose(x + along, y + across, 1.9 - rise, -roll, pitch, yaw)}


def ramp(t, begin, end):
    """0 before `begin` [s], 1 after `end`, smoothly between."""
    u = min(max((t - begin) / (end - begin), 0.0), 1.0)
    return u * u * (3 - 2 * u)


def harness(t):
    t %= PERIODS['harness']
    z = 0.3 - 0.294 * ramp(t, 1, 6) + 0.294 * ramp(t, 8.5, 10.5)
    x = 0.247 + 0.0028 * (ramp(t, 6, 7) - ramp(t, 11, 12))  # stretched when it lies
    tilt = 1.1 * (ramp(t, 11, 14) - ramp(t, 17, 20))  # [rad]
    return {'left_hand': pose(-x, 0, z), 'right_hand': pose(x, 0, z), 'board': pose(0, 0, 0, roll=tilt)}


def plug(t):
    t %= PERIODS['plug']
    there, pushed, back = ramp(t, 1, 4), ramp(t, 4, 6), ramp(t, 14.5, 16)
    away, pulled = ramp(t, 7, 8.5) - ramp(t, 13, 14.5), ramp(t, 9, 11) - ramp(t, 12, 13)
    return {'hand': pose(-0.18 + 0.1 * (there - back) + 0.09 * (pushed - back), 0.12 * away, 0.2 - 0.1 * (there - back)),
            'far_hand': pose(-0.5 - 0.1325 * pulled, 0, 0.2 - 0.1 * pulled)}


def finger(t):
    return {'palm': pose(0, 0, 0.15, pitch=0.3 * swing(t, 9))}


# The frames over time, and texts [what, x, y, z, height: m].
EXAMPLES = {
    'hose_between_arms': (hose_between_arms, [
        ('two arms bend and twist a hose', 0, 0, 1.28, 0.06)]),
    'tethered_drone': (tethered_drone, [
        ('a drone on a tether, in wind', 0, 0, 2.75, 0.14), ('ground station', -0.1, 0, 0.35, 0.1), ('wind ->', -1.2, 0, 1.5, 0.12)]),
    'crane': (crane, [
        ('a crane: the winch on the trolley hoists a payload', 0, 0, 2.5, 0.1), ('payload: 5 kg', 0, 0, 0.2, 0.1)]),
    'rov_tether': (rov_tether, [
        ('the tether between a ship and an underwater robot, in a current', 0.5, 0, 0.55, 0.12),
        ('water surface', -1.1, 0, 0.06, 0.08), ('current ->', -1.1, 0, -0.9, 0.12)]),
    'tracker': (tracker, [
        ('what a depth camera sees of a rope: blue', 0, 0, 1.38, 0.055),
        ('where its nodes are, at the same stamp: red', 0, 0, 1.3, 0.055)]),
    'gripper_load': (gripper_load, [
        ('the load of a cable on a gripper', 0.3, 0, 1.5, 0.06), ('orange: force, purple: torque', 0.3, 0, 1.42, 0.045),
        ('wall', -0.05, 0, 1.25, 0.05)]),
    'harness': (harness, [
        ('two hands lay a wire harness on a board, whose clips hold it', 0, 0, 0.52, 0.04)]),
    'plug': (plug, [
        ('a clip takes the cable behind a plug that a hand pushes into a socket', -0.12, 0, 0.22, 0.013)]),
    'finger': (finger, [
        ('a tendon bends a finger, rubber bands over sheaves straighten it', 0.01, 0, 0.2, 0.008)]),
    'drones_with_bar': (drones_with_bar, [
        ('two drones carry a bar of 1.2 kg on ropes', 0, 0, 2.55, 0.12), ('orange: what each bears', 0, 0, 2.38, 0.09)]),
}


def transform(name, frame_pose, stamp):
    message = TransformStamped()
    message.header.stamp = stamp
    message.header.frame_id = FIXED_FRAME
    message.child_frame_id = name
    message.transform.translation, message.transform.rotation = frame_pose
    return message


def label(number, text, x, y, z, height):
    marker = Marker(ns='labels', id=number, type=Marker.TEXT_VIEW_FACING, text=text, color=ColorRGBA(0.1, 0.1, 0.12, 1))
    marker.header.frame_id = FIXED_FRAME
    marker.pose.position = Point(x, y, z)
    marker.pose.orientation.w = 1
    marker.scale.z = height
    return marker


def handle(example, started):
    """Lets go of what the example's hands hold, and resets the cables when it begins again."""
    unpin, reset = rospy.ServiceProxy('cable/unpin', Unpin), rospy.ServiceProxy('cable/reset', Trigger)
    seconds, names = RELEASES[example]
    try:
        for begin in itertools.count(started.to_sec(), PERIODS[example]):
            rospy.sleep(begin + seconds - rospy.get_time())
            for name in names:
                unpin(name)
            rospy.sleep(begin + PERIODS[example] - rospy.get_time())
            reset()
    except (rospy.ROSException, rospy.ServiceException) as problem:
        if not rospy.core.is_shutdown_requested():
            rospy.logwarn('%s', problem)


def main():
    node_thread.run('example_frames', move_frames)


def move_frames():
    example = rospy.get_param('~example')
    motion, texts = EXAMPLES[example]
    labels = rospy.Publisher('example/labels', MarkerArray, queue_size=1, latch=True)
    labels.publish([label(number, *text) for number, text in enumerate(texts)])
    broadcaster = tf2_ros.TransformBroadcaster()
    rate = rospy.Rate(RATE)

    def send(now, seconds):
        broadcaster.sendTransform([transform(name, at, now) for name, at in motion(seconds).items()])
        rate.sleep()

    if example in RELEASES:
        there = threading.Event()
        state = rospy.Subscriber('cable/state', CableArray, lambda message: there.set() if message.cables else None)
        while not there.is_set() and not rospy.is_shutdown():
            send(rospy.Time.now(), 0)
        state.unregister()
        threading.Thread(target=handle, args=[example, rospy.Time.now()], daemon=True).start()
    started = rospy.Time.now()
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        send(now, (now - started).to_sec())


if __name__ == '__main__':
    main()
