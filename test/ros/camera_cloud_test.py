#!/usr/bin/env python3
"""The clouds of depth_image_proc are those of the camera."""
import sys
import unittest

import numpy as np
import rospy
import rostest
from sensor_msgs.msg import PointCloud2

from cable_client import Messages
from images import points_of

CLOSE = 1e-4  # [m]


class CloudTest(unittest.TestCase):
    def check(self, cloud, camera):
        with Messages(f'/{cloud}/points', PointCloud2) as clouds, Messages(f'/{camera}/points', PointCloud2) as own:
            own.next()
            made = clouds.wait_for(lambda message: any(m.header.stamp == message.header.stamp for m in own.all()), 'cloud', 20)
            points = points_of(next(m for m in own.all() if m.header.stamp == made.header.stamp))
            self.assertEqual(made.header.frame_id, 'camera_optical_frame')
            self.assertGreater(np.isfinite(points).all(axis=-1).sum(), 10000)
            np.testing.assert_allclose(points_of(made), points, atol=CLOSE, equal_nan=True)

    def test_of_depth_in_metres(self):
        self.check('cloud', 'camera')

    def test_of_depth_in_millimetres(self):
        self.check('coarse_cloud', 'coarse_camera')


if __name__ == '__main__':
    rospy.init_node('camera_cloud_test')
    rostest.rosrun('verlet_cable', 'camera_cloud', CloudTest, sys.argv)
