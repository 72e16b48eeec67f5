#!/usr/bin/env python3
"""What cameras publish: depth by closed forms, masks, colors, clouds and truth of one stamp."""
import contextlib
import math
import sys
import unittest

import numpy as np
import rospy
import rostest
from geometry_msgs.msg import Point
from rosgraph_msgs.msg import Log
from sensor_msgs.msg import CameraInfo, Image, PointCloud2

from cable_client import CableClient, Frames, Messages, cable
from images import array, labels_of, points_of
from verlet_cable.msg import Cable, CableArray, CableView

WIDTH, HEIGHT, FOV = 640, 480, 1.05
FOCAL = WIDTH / 2 / math.tan(FOV / 2)     # [pixels]
CENTER = (WIDTH - 1) / 2, (HEIGHT - 1) / 2
EYE = np.array([0, -1, 0.75])             # [m]
EXACT = 5e-5                              # [m]
TOPICS = {'mask/image_raw': Image, 'depth/image_raw': Image, 'rgb/image_raw': Image, 'points': PointCloud2, 'truth': CableView,
          'camera_info': CameraInfo}
# In the order of the numbers in masks: cables, particles, bodies, what is named in `labels`, and the others.
LABELS = ['left', 'right', 'speck', 'brick', 'screen', 'floor', 'ball', 'forearm', 'arm']


def sights():
    """x and y at z = 1 in each pixel of `camera`."""
    u, v = np.meshgrid(np.arange(WIDTH), np.arange(HEIGHT))
    return (u - CENTER[0]) / FOCAL, (v - CENTER[1]) / FOCAL


def pixel(point):
    """Column and row where a point [m] of the world is seen."""
    x, y, z = np.array(point) - EYE
    return round(CENTER[0] + FOCAL * x / y), round(CENTER[1] - FOCAL * z / y)


@contextlib.contextmanager
def collected(camera, topics):
    with contextlib.ExitStack() as stack:
        yield {topic: stack.enter_context(Messages(f'/{camera}/{topic}', TOPICS[topic])) for topic in topics}


def shot(camera, topics=TOPICS, wanted=lambda image: True):
    """One message of each topic, with one stamp."""
    with collected(camera, topics) as logs:
        def complete(message):
            return wanted(message) and all(any(m.header.stamp == message.header.stamp for m in log.all()) for log in logs.values())
        first, *others = topics
        for _ in range(50):
            rospy.sleep(0.1)
            for message in logs[first].all():
                if complete(message):
                    return {topic: next(m for m in log.all() if m.header.stamp == message.header.stamp) for topic, log in logs.items()}
    raise AssertionError(f'no images of all topics {list(topics)} with one stamp')


class CameraTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('camera_test')
        cls.frames = Frames(arm=lambda t: (-0.15, -0.5, 0.85))
        cls.frames.__enter__()
        cls.node = CableClient('/cable')
        with cls.node.states() as states:
            states.wait_for(lambda state: cable(state, 'right'), 'cables')
        cls.seen = shot('camera', wanted=lambda mask: (array(mask) == len(LABELS)).any())
        cls.depth = array(cls.seen['depth/image_raw'])
        cls.mask = array(cls.seen['mask/image_raw'])

    @classmethod
    def tearDownClass(cls):
        cls.frames.__exit__()

    def at(self, image, point):
        column, row = pixel(point)
        return image[row, column]

    def number(self, name):
        return LABELS.index(name) + 1

    def pixels(self, name):
        """Rows and columns of pixels that show something all around."""
        shows = self.mask == self.number(name)
        inner = shows.copy()
        for axis in (0, 1):
            for shift in (-1, 1):
                inner &= np.roll(shows, shift, axis)
        self.assertGreater(inner.sum(), 20, name)
        return inner

    def test_images_of_one_state_have_its_stamp_and_the_optical_frame(self):
        for topic, message in self.seen.items():
            self.assertEqual(message.header.stamp, self.seen['truth'].header.stamp, topic)
            self.assertEqual(message.header.frame_id, 'camera_optical_frame', topic)
        with self.node.states() as states, Messages('/camera/depth/image_raw', Image) as images:
            image = images.next(5)
            states.wait_for(lambda state: state.header.stamp == image.header.stamp, 'state of that stamp')

    def test_camera_info(self):
        info = self.seen['camera_info']
        self.assertEqual((info.width, info.height, info.distortion_model), (WIDTH, HEIGHT, 'plumb_bob'))
        np.testing.assert_allclose(info.K, [FOCAL, 0, CENTER[0], 0, FOCAL, CENTER[1], 0, 0, 1], rtol=1e-9)
        np.testing.assert_allclose(info.P, [FOCAL, 0, CENTER[0], 0, 0, FOCAL, CENTER[1], 0, 0, 0, 1, 0], rtol=1e-9)
        self.assertEqual(list(info.D), [0] * 5)

    def test_depth_of_cables(self):
        """Of cylinders along z: (sx t - x)^2 + (t - 1)^2 = r^2."""
        sx, sy = sights()
        for name, x in (('left', 0), ('right', 0.2)):
            square, half, rest = sx ** 2 + 1, sx * x + 1, x ** 2 + 1 - 0.01 ** 2
            with np.errstate(invalid='ignore'):
                expected = (half - np.sqrt(half ** 2 - square * rest)) / square
            seen = self.pixels(name) & (np.abs(sy * expected) < 0.24)  # without its ends
            self.assertGreater(seen.sum(), 1000)
            self.assertLess(np.abs(self.depth - expected)[seen].max(), EXACT)

    def test_depth_of_plane_sphere_and_box(self):
        sx, sy = sights()
        floor = self.pixels('floor')
        self.assertLess(np.abs(self.depth - 0.75 / np.where(sy > 0, sy, 1))[floor].max(), EXACT)
        to_center = np.array([0.45, -0.15, 1])
        square = sx ** 2 + sy ** 2 + 1
        half = sx * to_center[0] + sy * to_center[1] + to_center[2]
        with np.errstate(invalid='ignore'):
            ball = (half - np.sqrt(half ** 2 - square * (to_center @ to_center - 0.1 ** 2))) / square
        self.assertLess(np.abs(self.depth - ball)[self.pixels('ball')].max(), EXACT)
        front = self.pixels('screen') & (0.69 * sx > 0.111) & (0.69 * sy > 0.051)  # without its side and its top
        self.assertLess(np.abs(self.depth - 0.69)[front].max(), EXACT)

    def test_nothing_beyond_has_no_depth(self):
        nothing = self.mask == 0
        self.assertGreater(nothing.sum(), 1000)
        self.assertTrue(np.isnan(self.depth[nothing]).all())
        self.assertTrue(np.isfinite(self.depth[~nothing]).all())

    def test_mask_has_the_numbers_of_the_labels(self):
        self.assertEqual(list(self.seen['truth'].labels), LABELS)
        for name, point in (('left', (0, 0, 0.9)), ('right', (0.2, 0, 0.9)), ('brick', (-0.2, -0.1, 0.75)), ('ball', (0.45, -0.1, 0.9)),
                            ('screen', (0.14, -0.31, 0.6)), ('floor', (0.1, 0.9, 0)), ('arm', (-0.15, -0.53, 0.85))):
            self.assertEqual(self.at(self.mask, point), self.number(name), name)

    def test_colors_are_those_of_the_scene(self):
        image = array(self.seen['rgb/image_raw']).astype(int)
        self.assertEqual(image.shape, (HEIGHT, WIDTH, 3))
        for name, strong, weak in (('left', 0, 2), ('right', 2, 0)):
            color = np.median(image[self.pixels(name)], axis=0)
            self.assertGreater(color[strong], 2 * color[weak], name)

    def test_truth(self):
        truth = self.seen['truth']
        self.assertEqual(list(truth.cables), ['left', 'right'])
        self.assertEqual(list(truth.first), [0, 26])
        self.assertEqual(len(truth.positions), 52)
        for node, p in enumerate(truth.positions):
            x, z = (0, 1 - 0.02 * node) if node < 26 else (0.2, 1 - 0.02 * (node - 26))
            expected = x, 0.75 - z, 1
            np.testing.assert_allclose((p.x, p.y, p.z), expected, atol=1e-4)
            self.assertAlmostEqual(truth.u[node], CENTER[0] + FOCAL * p.x / p.z, delta=1e-2)
            self.assertAlmostEqual(truth.v[node], CENTER[1] + FOCAL * p.y / p.z, delta=1e-2)
            # The screen is seen from 0.5 to 0.7 at 0.7 m; from there a ray to the cable falls from 0.75 m.
            hidden = x > 0.1 and (0.5 - 0.75) / 0.69 < z - 0.75 < (0.7 - 0.75) / 0.69
            if abs(z - 0.75 - (0.7 - 0.75) / 0.69) > 0.005:
                self.assertEqual(truth.visible[node], not hidden, (x, z))

    def test_points_are_the_depth(self):
        points, (sx, sy) = points_of(self.seen['points']), sights()
        self.assertEqual((self.seen['points'].height, self.seen['points'].width), (HEIGHT, WIDTH))
        expected = np.stack([sx * self.depth, sy * self.depth, self.depth], axis=-1)
        np.testing.assert_allclose(points, expected, atol=1e-6, equal_nan=True)
        np.testing.assert_array_equal(labels_of(self.seen['points']), self.mask)

    def test_depth_in_millimetres_with_noise(self):
        seen = shot('noisy_camera', ['depth/image_raw', 'mask/image_raw', 'points', 'truth'])
        image = seen['depth/image_raw']
        self.assertEqual((image.encoding, image.width, image.step), ('16UC1', 320, 640))
        depth, mask = array(image), array(seen['mask/image_raw'])
        z = points_of(seen['points'])[..., 2]
        np.testing.assert_array_equal(depth > 0, np.isfinite(z))
        np.testing.assert_allclose(z[depth > 0], depth[depth > 0] / 1000, atol=1e-6)
        # Of the front of the brick, whose depth is 0.9 m: 0.002 z^2, and 1 mm / sqrt(12) of rounding.
        labels = list(seen['truth'].labels)
        brick = depth[mask == labels.index('brick') + 1].astype(float) / 1000
        brick = brick[np.abs(brick - 0.9) < 0.008]  # without its side
        self.assertGreater(len(brick), 200)
        self.assertAlmostEqual(brick.mean(), 0.9, delta=5e-4)
        self.assertAlmostEqual(brick.std(), math.hypot(0.002 * 0.9 ** 2, 0.001 / math.sqrt(12)), delta=3e-4)
        # No depth at grazing angles: the floor is seen at 70 degrees beyond 0.75 m * tan(70 degrees).
        floor = depth[mask == labels.index('floor') + 1]
        self.assertGreater((floor == 0).sum(), 100)
        self.assertGreater((floor > 0).sum(), 100)

    def test_the_same_state_gives_the_same_bytes(self):
        self.assertTrue(self.node.pause(True).success)
        try:
            rospy.sleep(0.3)
            first, second = (shot('noisy_camera', ['depth/image_raw', 'rgb/image_raw', 'points']) for _ in range(2))
            self.assertEqual(first['depth/image_raw'].header.stamp, second['depth/image_raw'].header.stamp)
            for topic in first:
                self.assertEqual(first[topic].data, second[topic].data, topic)
        finally:
            self.assertTrue(self.node.pause(False).success)

    def test_no_more_images_than_wanted(self):
        with Messages('/noisy_camera/truth', CableView) as views:
            views.next()
            rospy.sleep(2)
            periods = [math.floor(10 * view.header.stamp.to_sec() + 1e-6) for view in views.all()]
        self.assertGreater(len(periods), 10)
        self.assertEqual(periods, sorted(set(periods)))

    def test_a_driver_says_what_the_camera_is_like(self):
        info = CameraInfo(width=64, height=48, distortion_model='plumb_bob', D=[-0.1, 0, 0, 0, 0])
        info.K = [50, 0, 31, 0, 50, 23, 0, 0, 1]
        driver = rospy.Publisher('/driver/camera_info', CameraInfo, queue_size=1, latch=True)
        with Messages('/rosout', Log) as log, Messages('/driven_camera/depth/image_raw', Image) as images:
            log.wait_for(lambda line: line.name == '/driven_camera' and '/driver/camera_info' in line.msg, 'a word of what is missing', 10)
            driver.publish(info)
            image = images.next()
            self.assertEqual((image.width, image.height), (64, 48))
            with Messages('/driven_camera/camera_info', CameraInfo) as infos:
                sent = infos.next()
            self.assertEqual((list(sent.K), list(sent.D), sent.header.frame_id), (list(info.K), list(info.D), 'camera_optical_frame'))
            driver.publish(CameraInfo(width=64, height=0, K=info.K))
            refused = log.wait_for(lambda line: line.name == '/driven_camera' and 'height' in line.msg, 'refusal', 10)
            self.assertIn('allowed', refused.msg)
            # Another reason is told at once.
            driver.publish(CameraInfo(width=64, height=48, distortion_model='equidistant', D=[0.1] * 4, K=info.K))
            log.wait_for(lambda line: line.name == '/driven_camera' and 'distortion_model: "equidistant"' in line.msg, 'reason', 3)
            images.next()  # it goes on with what it had

    def test_a_state_without_appearance_is_seen(self):
        """As of a bag that has the state only: after `tf_timeout`, in which an appearance might have come."""
        state = CableArray()
        state.header.frame_id = 'world'
        state.cables = [Cable(name='recorded', radius=0.05, positions=[Point(-0.2, 0, 0.75), Point(0.2, 0, 0.75)])]
        publisher = rospy.Publisher('/bag/state', CableArray, queue_size=5)
        with Messages('/bag_camera/mask/image_raw', Image) as masks, Messages('/bag_camera/truth', CableView) as views:
            for _ in range(60):
                state.header.stamp = rospy.Time.now()
                publisher.publish(state)
                rospy.sleep(0.05)
            mask = array(masks.all()[-1])
            self.assertEqual((mask[24, 32], mask[2, 2]), (1, 0))
            view = views.all()[-1]
        self.assertEqual((view.cables, view.labels, list(view.first)), (['recorded'], ['recorded'], [0]))

    def test_states_that_cannot_be_drawn_are_told_and_left_out(self):
        publisher = rospy.Publisher('/bag/state', CableArray, queue_size=5)
        with Messages('/rosout', Log) as log, Messages('/bag_camera/truth', CableView):
            for _ in range(60):
                state = CableArray()
                state.header.frame_id = 'world'
                state.header.stamp = rospy.Time.now()
                state.cables = [Cable(name='broken', radius=-1, positions=[Point(math.nan, 0, 0.75)])]
                publisher.publish(state)
                rospy.sleep(0.05)
            line = log.wait_for(lambda line: line.name == '/bag_camera' and line.level == Log.ERROR, 'error')
            self.assertIn('tubes[0]', line.msg)

    def test_a_frame_that_tf_does_not_know_is_named(self):
        with Messages('/rosout', Log) as log, Messages('/lost_camera/depth/image_raw', Image) as images:
            line = log.wait_for(lambda line: line.name == '/lost_camera' and 'no_such_frame' in line.msg, 'warning', 10)
            self.assertEqual(line.level, Log.WARN)
            self.assertEqual(images.all(), [])

    def test_a_state_that_nobody_publishes_is_named(self):
        with Messages('/rosout', Log) as log, Messages('/silent_camera/truth', CableView):
            line = log.wait_for(lambda line: line.name == '/silent_camera' and 'nobody publishes /nobody/state' in line.msg, 'warning', 10)
            self.assertEqual(line.level, Log.WARN)

    def test_a_lost_link_is_named_and_the_rest_is_seen(self):
        with Messages('/rosout', Log) as log, Messages('/camera/mask/image_raw', Image) as images:
            images.next()
            motion = self.frames.motions.pop('arm')
            try:
                log.wait_for(lambda line: line.name == '/camera' and 'link arm' in line.msg, 'warning', 10)
                mask = array(images.wait_for(lambda image: self.number('arm') not in array(image), 'image without the arm'))
                self.assertEqual(self.at(mask, (0, 0, 0.9)), self.number('left'))
            finally:
                self.frames.motions['arm'] = motion
            images.wait_for(lambda image: self.number('arm') in array(image), 'the arm again')

    def test_nothing_is_asked_of_the_cable_node_for_nobody(self):
        def listeners(topic):
            return {node for name, nodes in rospy.get_master().getSystemState()[2][1] if name == topic for node in nodes}
        rospy.sleep(0.5)
        self.assertNotIn('/driven_camera', listeners('/cable/appearance'))
        with Messages('/driven_camera/truth', CableView):
            rospy.sleep(0.5)
            self.assertIn('/driven_camera', listeners('/cable/appearance'))


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'camera_images', CameraTest, sys.argv)
