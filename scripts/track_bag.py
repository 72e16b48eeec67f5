#!/usr/bin/python3
"""track_bag.py BAG: follows the rope of launch/examples/tracker.launch by what a camera saw of it, as `bag:=BAG` has recorded it, and
prints how far it is from the truth."""
import argparse
import os
import sys

import numpy as np
import rosbag
import rospkg
import rospy
import tf2_py

from verlet_cable.sim import Scene, World

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
from bag_clouds import as_its_class  # noqa: E402
from cloud_tracker import CloudTracker, distances  # noqa: E402

TOPICS = ['/tf', '/tf_static', '/camera/camera_info', '/camera/depth/image_raw', '/camera/truth']
HANDS = ('left_hand', 'right_hand')
CACHE = 86400  # [s] of tf
LEAD_IN = 1.0  # [s] that do not count: the tracker begins at rest


def pose_of(transform):
    """Rotation (3, 3) and translation [m]."""
    x, y, z, w = (getattr(transform.rotation, axis) for axis in 'xyzw')
    rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    return rotation, np.array([transform.translation.x, transform.translation.y, transform.translation.z])


def cloud_of(depth, info):
    """(k, 3) [m] The points of a depth image in the optical frame."""
    z = np.frombuffer(depth.data, np.float32).reshape(depth.height, depth.width).astype(float)
    row, column = np.nonzero(np.isfinite(z))
    z = z[row, column]
    return np.column_stack([(column - info.K[2]) / info.K[0] * z, (row - info.K[5]) / info.K[4] * z, z])


def moments(path, frame):
    """Stamp [s], cloud and true nodes in the fixed frame, of each depth image."""
    with rosbag.Bag(path) as bag:
        buffer = tf2_py.BufferCore(rospy.Duration(CACHE))
        for topic, message, _ in bag.read_messages(TOPICS[:2]):
            for transform in message.transforms:
                (buffer.set_transform_static if topic == '/tf_static' else buffer.set_transform)(as_its_class(transform), path)
        info, truths, images = None, {}, {}
        for topic, message, _ in bag.read_messages(TOPICS[2:]):
            if topic == '/camera/camera_info':
                info = message
                continue
            stamp = message.header.stamp
            (truths if topic == '/camera/truth' else images)[stamp] = message
            if info is None or stamp not in truths or stamp not in images:
                continue
            truth, depth = truths.pop(stamp), images.pop(stamp)
            try:
                camera = buffer.lookup_transform_core(frame, depth.header.frame_id, stamp)
            except tf2_py.TransformException:
                continue  # before the recording of tf begins, or after its end
            rotation, translation = pose_of(camera.transform)
            nodes = np.array([(p.x, p.y, p.z) for p in truth.positions])
            yield stamp.to_sec(), cloud_of(depth, info) @ rotation.T + translation, nodes @ rotation.T + translation


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('bag', help='file')
    path = parser.parse_args().bag
    scene_file = os.path.join(rospkg.RosPack().get_path('verlet_cable'), 'config/examples/tracker.yaml')
    scene = Scene.load(scene_file)
    world, tracker, start, last = World(scene), None, None, None
    errors, aside = [], []
    for stamp, cloud, truth in moments(path, 'world'):
        if tracker is None:
            ends = [truth[0], truth[-1]]
            for name, position in zip(HANDS, ends):
                world.set_frame(name, position, [0, 0, 0, 1])
            world.set_state('rope', positions=truth)  # where a tracker begins somebody has to say
            tracker = CloudTracker(world, 'rope', list(zip(HANDS, ends)), 0.012, 0.1, scene.time_step)
            start = stamp
        elif stamp > last:
            tracker.update(cloud, stamp - last)
            if stamp > start + LEAD_IN:
                errors.append(np.linalg.norm(tracker.nodes - truth, axis=1))
                aside.append(distances(tracker.nodes, truth))
        last = stamp
    if not errors:
        sys.exit(f'{path}: no images with truth and tf for more than {LEAD_IN:g} s; record them with tracker.launch bag:=FILE')
    for name, values in (('nodes from the true ones', errors), ('nodes from the true centre line', aside)):
        print(f'{name}: mean {1000 * np.mean(values):.1f} mm, 95 % within {1000 * np.percentile(values, 95):.1f} mm, '
              f'at most {1000 * np.max(values):.1f} mm')
    print(f'{len(errors)} images in {last - start:.1f} s')


if __name__ == '__main__':
    main()
