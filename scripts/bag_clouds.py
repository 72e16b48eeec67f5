"""What record_to_csv and clouds_to_csv both do: they read clouds and tf of bags, and write files."""
import os
import sys

import numpy as np
import rospy
import tf2_py
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3

from output_file import stopped_by_signals, why_not_writable

TF_CACHE = 3600.0  # [s]
FLOATS = {7: 'f4', 8: 'f8'}  # numpy's names for the types of sensor_msgs/PointField
INTEGERS = {1: 'i1', 2: 'u1', 3: 'i2', 4: 'u2', 5: 'i4', 6: 'u4'}


class BagError(Exception):
    """What is wrong with a bag; the message names the topic, what was found and what is needed."""


def _check_sizes(message, names, types, offsets):
    """Before anything is taken for them: nobody has to tell the truth."""
    needed = max(offset + np.dtype(kind).itemsize for offset, kind in zip(offsets, types))
    if message.point_step < needed:
        raise BagError(f'point_step: {message.point_step}; allowed: at least the {needed} bytes to the end of '
                       f'{", ".join(names[:-1])} and {names[-1]}')
    row, rows = message.width * message.point_step, message.height * message.row_step
    if message.row_step < row:
        raise BagError(f'row_step: {message.row_step}; allowed: at least width * point_step = {row}')
    if min(message.width, message.height) == 0 or len(message.data) < rows:
        raise BagError(f'data: {len(message.data)} bytes; allowed: points, and height * row_step = {rows}')


def cloud_records(message, label=False):
    """The points of a sensor_msgs/PointCloud2 in their order: an array with the fields x, y, z and, if it is asked for, `label`."""
    allowed = {**dict.fromkeys('xyz', FLOATS), **({'label': INTEGERS} if label else {})}
    found = {field.name: field for field in message.fields if field.datatype in allowed.get(field.name, ())}
    if any(axis not in found for axis in 'xyz'):
        raise BagError('the points have no x, y and z of type float32 or float64')
    if label and 'label' not in found:
        raise BagError(f'--label: the fields of the points are {", ".join(field.name for field in message.fields)}; '
                       'allowed: points with a label of an integer type')
    order = '>' if message.is_bigendian else '<'
    names = list(allowed)
    types = [order + allowed[name][found[name].datatype] for name in names]
    offsets = [found[name].offset for name in names]
    _check_sizes(message, names, types, offsets)
    layout = np.dtype({'names': names, 'formats': types, 'offsets': offsets, 'itemsize': message.point_step})
    rows = [np.frombuffer(message.data, layout, message.width, row * message.row_step) for row in range(message.height)]
    return np.concatenate(rows)


def positions(records):
    """(n, 3) [m] x, y and z of an array that has these fields."""
    return np.column_stack([records[axis].astype(float) for axis in 'xyz'])


def messages(bag, topics):
    """What a bag has of these topics. What rosbag says of damage has many types: all of them are a BagError here."""
    try:
        yield from bag.read_messages(topics=topics)
    except Exception as error:
        raise BagError(f'it cannot be read: {str(error)[:300]}') from error


def check_type(bag, option, topic, needed):
    """Messages of other types lack the fields that are read."""
    types = bag.get_type_and_topic_info().topics
    if topic in types and types[topic].msg_type != needed:
        raise BagError(f'{option}: {topic} is of type {types[topic].msg_type}; allowed: {needed}')


def as_its_class(message):
    """A bag has classes of its own, which tf warns of."""
    shift, turn = message.transform.translation, message.transform.rotation
    return TransformStamped(message.header, message.child_frame_id,
                            Transform(Vector3(shift.x, shift.y, shift.z), Quaternion(turn.x, turn.y, turn.z, turn.w)))


class Transforms:
    """All of a bag's tf."""

    def __init__(self, bag):
        self._buffer = tf2_py.BufferCore(rospy.Duration(TF_CACHE))
        self._parents = {}  # all that a frame ever had
        self._stamps = {}  # of a frame that moves
        for topic, message, _ in messages(bag, ['/tf', '/tf_static']):
            for transform in message.transforms:
                child = transform.child_frame_id.lstrip('/')
                self._parents.setdefault(child, set()).add(transform.header.frame_id.lstrip('/'))
                if topic == '/tf_static':
                    self._buffer.set_transform_static(as_its_class(transform), 'bag')
                else:
                    self._buffer.set_transform(as_its_class(transform), 'bag')
                    self._stamps.setdefault(child, set()).add(transform.header.stamp)

    def __call__(self, target, source, stamp):
        """The transform from `source` to `target`, None where tf does not reach."""
        try:
            return self._buffer.lookup_transform_core(target, source, stamp).transform
        except tf2_py.TransformException:
            return None

    def frames(self):
        return sorted(set(self._parents).union(*self._parents.values()))

    def stamps_between(self, one, other):
        """When anything was told that moves one frame in the other."""
        links = self._with_ancestors(one) ^ self._with_ancestors(other)
        return set().union(*(self._stamps.get(frame, ()) for frame in links))

    def _with_ancestors(self, frame):
        found, left = set(), [frame]
        while left:
            last = left.pop()
            if last not in found:
                found.add(last)
                left += self._parents.get(last, ())
        return found


def moved(transform, points):
    """(n, 3) Points by a geometry_msgs/Transform."""
    turn, shift = transform.rotation, transform.translation
    axis = np.array([turn.x, turn.y, turn.z])
    across = 2 * np.cross(axis, points)
    return points + turn.w * across + np.cross(axis, across) + [shift.x, shift.y, shift.z]


def output_problem(path):
    """Why a file is refused before it is written, or None."""
    problem = why_not_writable(path) if path else 'it is empty'
    return f'cannot write {path!r}: {problem}; allowed: a file in a directory that can be written, or a device' if problem else None


def is_same_file(one, other):
    return os.path.exists(one) and os.path.exists(other) and os.path.samefile(one, other)


def exit_status(program, convert, options):
    """What convert(options) returns, and 3 if a signal ends it."""
    try:
        with stopped_by_signals():
            return convert(options)
    except KeyboardInterrupt as stop:
        print(f'{program}: stopped: ended by {stop}', file=sys.stderr)
        return 3
