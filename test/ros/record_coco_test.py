#!/usr/bin/env python3
"""record_coco: what it writes are the messages of one stamp."""
import json
import os
import signal
import subprocess
import sys
import tempfile
import unittest

import numpy as np
import PIL.Image
import rospkg
import rospy
import rostest
from sensor_msgs.msg import CameraInfo, Image

from cable_client import Messages
from images import array
from verlet_cable.msg import CableView

PROGRAM = os.path.join(rospkg.RosPack().get_path('verlet_cable'), 'scripts', 'record_coco')
TOPICS = {'rgb/image_raw': Image, 'mask/image_raw': Image, 'depth/image_raw': Image, 'truth': CableView, 'camera_info': CameraInfo}
IMAGES = 5


def pixels(*path):
    with PIL.Image.open(os.path.join(*path)) as file:
        return np.asarray(file)


def started(*arguments):
    return subprocess.Popen([sys.executable, PROGRAM, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


class RecordCocoTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.mkdtemp()
        self.output = os.path.join(self.folder, 'set')

    def content(self):
        with open(os.path.join(self.output, 'annotations.json'), encoding='utf-8') as file:
            return json.load(file)

    def test_images_are_the_messages_of_their_stamp(self):
        with Messages('/camera/rgb/image_raw', Image) as colors, Messages('/camera/mask/image_raw', Image) as masks, \
                Messages('/camera/depth/image_raw', Image) as depths, Messages('/camera/truth', CableView) as views:
            views.next()
            program = started('--output', self.output, '--images', str(IMAGES), '--every', '0.2', '--fixed', 'world', '--keypoints', '6')
            output, errors = program.communicate(timeout=60)
            rospy.sleep(0.5)
            logs = [log.all() for log in (colors, masks, depths, views)]
        self.assertEqual((program.returncode, output), (0, f'{IMAGES} images in {self.output}\n'), errors)
        content = self.content()
        self.assertEqual(len(content['images']), IMAGES)
        times = [image['time'] for image in content['images']]
        self.assertGreaterEqual(min(np.diff(times)), 0.2 - 1e-6)
        for image in content['images']:
            color, mask, depth, view = (next(m for m in log if abs(m.header.stamp.to_sec() - image['time']) < 1e-6) for log in logs)
            np.testing.assert_array_equal(pixels(self.output, image['file_name']), array(color))
            np.testing.assert_array_equal(pixels(self.output, image['mask_file']), array(mask))
            np.testing.assert_array_equal(pixels(self.output, image['depth_file']), array(depth))
            self.assertEqual(image['labels'], list(view.labels))
            np.testing.assert_allclose(image['pose'][:3], [0, -1, 0.75], atol=1e-9)
            self.assertEqual((image['width'], image['height'], image['matrix'][0][2]), (160, 120, 79.5))
            for annotation in (a for a in content['annotations'] if a['image_id'] == image['id']):
                number = view.labels.index(annotation['cable']) + 1
                self.assertEqual(annotation['area'], int((array(mask) == number).sum()))
                nodes = np.array([(p.x, p.y, p.z) for p in view.positions])[26 * (number - 1):26 * number]
                np.testing.assert_allclose(annotation['positions'], nodes[::5], atol=1e-6)
        self.assertEqual({a['cable'] for a in content['annotations']}, {'left', 'right'})

    def test_a_signal_ends_it_and_what_there_is_is_whole(self):
        with Messages('/camera/truth', CableView) as views:
            views.next()
            program = started('--output', self.output)
            try:
                for _ in range(300):
                    rospy.sleep(0.1)
                    if os.path.isdir(self.output) and len(os.listdir(os.path.join(self.output, 'depth'))) > 3:
                        break
            finally:
                program.send_signal(signal.SIGINT)
            _, errors = program.communicate(timeout=60)
        self.assertEqual(program.returncode, 0, errors)
        images = self.content()['images']
        self.assertGreater(len(images), 2)
        for image in images:
            self.assertEqual(pixels(self.output, image['mask_file']).shape, (120, 160))

    def test_wrong_options_are_named(self):
        os.mkdir(self.output)
        with open(os.path.join(self.output, 'file'), 'w', encoding='utf-8'):
            pass
        for arguments, text in ((['--output', self.output], "allowed: a directory that is new or empty"),
                                (['--output', self.output, '--images', '0'], '--images: 0; allowed: 1 or more'),
                                (['--output', self.output, '--every', 'nan'], '--every: nan; allowed: 0 or more'),
                                (['--output', self.output + '2', '--keypoints', '1'], 'keypoints: 1; allowed: an integer')):
            program = started(*arguments)
            _, errors = program.communicate(timeout=60)
            self.assertEqual(program.returncode, 2, errors)
            self.assertIn(text, errors)

    def test_topics_that_nobody_publishes_are_named(self):
        program = started('--output', self.output, '--camera', 'no_camera')
        try:
            line = next(line for line in program.stderr if 'nobody publishes' in line)
        finally:
            program.send_signal(signal.SIGINT)
            program.communicate(timeout=60)
        self.assertIn('/no_camera/rgb/image_raw', line)
        self.assertEqual(self.content()['images'], [])


if __name__ == '__main__':
    rospy.init_node('record_coco_test')
    rostest.rosrun('verlet_cable', 'record_coco', RecordCocoTest, sys.argv)
