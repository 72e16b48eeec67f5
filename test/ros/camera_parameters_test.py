#!/usr/bin/env python3
"""Bad parameters of a camera: the node names all errors and exits with a status that says so."""
import re
import subprocess
import sys
import unittest

import rospy
import rostest


class ParametersTest(unittest.TestCase):
    def run_node(self, name, parameters):
        rospy.set_param(name, parameters)
        return subprocess.run(['rosrun', 'verlet_cable', 'camera_node', f'__name:={name}'], capture_output=True, text=True, timeout=20)

    def test_all_errors_are_named(self):
        bad = {'width': 0, 'height': -3, 'horizontal_fov': 180, 'rate': 0, 'depth_encoding': '8UC1', 'near': -1, 'far': 0, 'seed': -1,
               'noise': {'axial': [0, 1], 'dropout_angle': 100}, 'optical_frame': '/camera', 'state': 'not a topic', 'preset': 'none_such',
               'labels': ['a', 'a'], 'robot_description': 'no_such_robot', 'widht': 3, 'camera_info_topic': '1x', 'tf_timeout': -1}
        ended = self.run_node('bad_camera', bad)
        self.assertEqual(ended.returncode, 2)
        for key in [*bad, 'noise.axial', 'noise.dropout_angle', 'labels[1]']:
            if key not in ('noise', 'labels'):
                self.assertRegex(ended.stdout + ended.stderr, rf'\b{re.escape(key)}: .*; allowed: ')

    def test_a_robot_that_is_no_urdf(self):
        rospy.set_param('broken_robot', '<robot')
        ended = self.run_node('camera_without_robot', {'robot_description': 'broken_robot'})
        self.assertEqual(ended.returncode, 2)
        self.assertIn('broken_robot', ended.stdout + ended.stderr)

    def test_help(self):
        ended = subprocess.run(['rosrun', 'verlet_cable', 'camera_node', '--help'], capture_output=True, text=True, timeout=20)
        self.assertEqual(ended.returncode, 0)
        self.assertIn('camera.launch', ended.stdout)


if __name__ == '__main__':
    rospy.init_node('camera_parameters_test')
    rostest.rosrun('verlet_cable', 'camera_parameters', ParametersTest, sys.argv)
