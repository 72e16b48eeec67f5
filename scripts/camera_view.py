#!/usr/bin/python3
"""camera_view.py: what a depth camera would see of the cables, for trackers to be tried on, and where the cables really are.

Subscribes to cable/surface and cable/state, and to tf. Publishes in the camera's optical frame, with their stamps:
* camera/points (sensor_msgs/PointCloud2, x y z): the visible side, with noise;
* camera/ground_truth (geometry_msgs/PoseArray): the first cable's nodes, x along the cable.
Parameters: ~optical_frame, ~noise [m], standard deviation along the line of sight.
"""
import numpy as np
import rospy
import tf2_ros
from geometry_msgs.msg import Point, Pose, PoseArray, Quaternion
from sensor_msgs.msg import PointCloud2, PointField

from verlet_cable.msg import CableArray

FOCAL_LENGTH = 525.0      # [pixels]
SIZE = 640, 480           # [pixels]
BLOCK = 4                 # [pixels] a nearer point hides others in its block
STARTING = 3.0            # [s] the first cables may be older than what is known of the camera
THICKNESS = 0.006         # [m] points this far behind the nearest one are still seen
NEAREST = 0.1             # [m]
FIELDS = [PointField(name, 4 * i, PointField.FLOAT32, 1) for i, name in enumerate('xyz')]


def matrix(transform):
    """4 x 4."""
    q, p = transform.rotation, transform.translation
    x, y, z, w = q.x, q.y, q.z, q.w
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), p.x],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), p.y],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), p.z],
                     [0, 0, 0, 1]])


def points_of(cloud):
    """n x 3, of a cloud whose first three fields are x, y and z."""
    return np.ndarray((cloud.width * cloud.height, 3), np.float32, cloud.data, 0, (cloud.point_step, 4)).astype(float)


def visible(points):
    """Of points in the optical frame, those that a camera sees."""
    points = points[points[:, 2] > NEAREST]
    pixels = (FOCAL_LENGTH * points[:, :2] / points[:, 2:] + np.array(SIZE) / 2).astype(int)
    inside = ((pixels >= 0) & (pixels < SIZE)).all(axis=1)
    points, pixels = points[inside], pixels[inside] // BLOCK
    blocks = pixels[:, 1] * SIZE[0] + pixels[:, 0]
    nearest = np.full(SIZE[0] * SIZE[1], np.inf)
    np.minimum.at(nearest, blocks, points[:, 2])
    return points[points[:, 2] < nearest[blocks] + THICKNESS]


def product(a, b):
    """Of quaternions x, y, z, w."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return Quaternion(aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
                      aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz)


def until_shutdown(callback):
    """The same, but without a word when the topics are closed."""
    def call(message):
        try:
            callback(message)
        except rospy.ROSException:
            if not rospy.core.is_shutdown_requested():
                raise
    return call


class Camera:
    def __init__(self):
        self._frame = rospy.get_param('~optical_frame')
        self._noise = rospy.get_param('~noise', 0.001)
        self._random = np.random.default_rng(0)
        self._started = rospy.Time.now()
        self._buffer = tf2_ros.Buffer()
        self._listener = tf2_ros.TransformListener(self._buffer)
        self._points = rospy.Publisher('camera/points', PointCloud2, queue_size=5)
        self._truth = rospy.Publisher('camera/ground_truth', PoseArray, queue_size=5)
        self._subscribers = [rospy.Subscriber('cable/surface', PointCloud2, until_shutdown(self._see), queue_size=5),
                             rospy.Subscriber('cable/state', CableArray, until_shutdown(self._know), queue_size=5)]

    def _transform(self, header):
        """From a message's frame at its time into the optical frame; None where tf does not know it."""
        try:
            return self._buffer.lookup_transform(self._frame, header.frame_id, header.stamp, rospy.Duration(0.2)).transform
        except tf2_ros.TransformException as problem:
            if (rospy.Time.now() - self._started).to_sec() > STARTING:
                rospy.logwarn_throttle(5, str(problem))
            return None

    def _see(self, cloud):
        transform = self._transform(cloud.header)
        if transform is None:
            return
        camera = matrix(transform)
        seen = visible(points_of(cloud) @ camera[:3, :3].T + camera[:3, 3])
        seen *= 1 + self._noise * self._random.standard_normal((len(seen), 1)) / np.linalg.norm(seen, axis=1, keepdims=True)
        message = PointCloud2(height=1, width=len(seen), fields=FIELDS, point_step=12, row_step=12 * len(seen), is_dense=True,
                              data=seen.astype(np.float32).tobytes())
        message.header.stamp = cloud.header.stamp
        message.header.frame_id = self._frame
        self._points.publish(message)

    def _know(self, state):
        transform = self._transform(state.header)
        if transform is None or not state.cables:
            return
        camera, turn = matrix(transform), transform.rotation
        cable = state.cables[0]
        message = PoseArray()
        message.header.stamp = state.header.stamp
        message.header.frame_id = self._frame
        for node, p in enumerate(cable.positions):
            q = cable.orientations[min(node, len(cable.orientations) - 1)]
            orientation = product((turn.x, turn.y, turn.z, turn.w), (q.x, q.y, q.z, q.w))
            message.poses.append(Pose(Point(*(camera @ (p.x, p.y, p.z, 1))[:3]), orientation))
        self._truth.publish(message)


def main():
    rospy.init_node('camera_view')
    camera = Camera()  # noqa: F841: its subscribers call it
    rospy.spin()


if __name__ == '__main__':
    main()
