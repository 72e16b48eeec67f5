"""What the programs share that move the frames of an example: transforms, labels, and a start that nothing misses."""
import threading

import rospy
import tf2_ros
from geometry_msgs.msg import Point, Quaternion, TransformStamped, Vector3
from std_msgs.msg import ColorRGBA
from visualization_msgs.msg import Marker

from verlet_cable.msg import CableArray

FIXED_FRAME = 'world'
RATE = 100.0  # [Hz]
STILL = 1.0   # [s] that frames stand still once the cables are there: until then the node may not have heard of them


def transform(name, frame_pose, stamp):
    message = TransformStamped()
    message.header.stamp = stamp
    message.header.frame_id = FIXED_FRAME
    message.child_frame_id = name
    position, orientation = frame_pose
    message.transform.translation, message.transform.rotation = Vector3(*position), Quaternion(*orientation)
    return message


def label(number, text, x, y, z, height):
    marker = Marker(ns='labels', id=number, type=Marker.TEXT_VIEW_FACING, text=text, color=ColorRGBA(0.1, 0.1, 0.12, 1))
    marker.header.frame_id = FIXED_FRAME
    marker.pose.position = Point(x, y, z)
    marker.pose.orientation.w = 1
    marker.scale.z = height
    return marker


def arrow(number, begin, end):
    """For what moves, but is not seen: wind, a current."""
    marker = Marker(ns='arrows', id=number, type=Marker.ARROW, color=ColorRGBA(0.1, 0.55, 0.9, 1), points=[Point(*begin), Point(*end)])
    marker.header.frame_id = FIXED_FRAME
    marker.pose.orientation.w = 1
    marker.scale = Vector3(0.04, 0.11, 0.14)  # [m] diameter of the shaft and of the head, length of the head
    return marker


def water(size, depth):
    """The surface at z = 0, of a size [m], as a layer of a depth [m] that one sees through."""
    marker = Marker(ns='water', type=Marker.CUBE, color=ColorRGBA(0.3, 0.75, 1, 0.35))
    marker.header.frame_id = FIXED_FRAME
    marker.pose.position.z = -depth / 2
    marker.pose.orientation.w = 1
    marker.scale = Vector3(*size, depth)
    return marker


def move_frames(motion, when_started):
    """Sends `motion` (time [s] to poses by frame) on tf: its start until the node shows its cables and has had time to hear of the frames,
    then all of it, until the node is shut down. Calls `when_started(rospy.Time)` in between."""
    broadcaster = tf2_ros.TransformBroadcaster()
    rate = rospy.Rate(RATE)

    def send(now, seconds):
        broadcaster.sendTransform([transform(name, at, now) for name, at in motion(seconds).items()])
        rate.sleep()

    there = threading.Event()
    state = rospy.Subscriber('cable/state', CableArray, lambda message: there.set() if message.cables else None)
    while not there.is_set() and not rospy.is_shutdown():
        send(rospy.Time.now(), 0)
    state.unregister()
    started = rospy.Time.now() + rospy.Duration(STILL)
    when_started(started)
    while not rospy.is_shutdown():
        now = rospy.Time.now()
        send(now, max((now - started).to_sec(), 0.0))
