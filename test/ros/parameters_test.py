#!/usr/bin/env python3
"""Bad parameters: the node names all errors and exits with a status that says so."""
import subprocess
import sys
import unittest

import rospy
import rostest

GOOD = {'materials': {'rope': {'linear_density': 0.1, 'radius': 0.005}},
        'cables': [{'name': 'rope', 'length': 1.0, 'segments': 10, 'material': 'rope'}]}


class ParametersTest(unittest.TestCase):
    def run_node(self, name, parameters):
        if parameters:
            rospy.set_param(name, parameters)
        return subprocess.run(['rosrun', 'verlet_cable', 'cable_node', f'__name:={name}'], capture_output=True, text=True, timeout=10)

    def test_all_errors_are_named(self):
        cable = dict(GOOD['cables'][0], segments=0, lenght=2.0, material='none_such')
        ended = self.run_node('bad_scene', {'gravty': [0, 0, 0], 'time_step': -1, 'cables': [cable], 'materials': GOOD['materials']})
        self.assertGreater(ended.returncode, 0)
        for part in ('gravty', 'time_step', 'segments', 'lenght', 'none_such'):
            self.assertIn(part, ended.stdout + ended.stderr)

    def test_no_parameters_at_all(self):
        ended = self.run_node('no_scene', None)
        self.assertGreater(ended.returncode, 0)
        self.assertIn('/no_scene', ended.stdout + ended.stderr)

    def test_a_name_that_no_node_can_have(self):
        for name in ('1a', 'a b'):
            ended = self.run_node(name, None)
            self.assertEqual(ended.returncode, 2)
            self.assertIn('cable_node: ', ended.stderr)


if __name__ == '__main__':
    rospy.init_node('parameters_test')
    rostest.rosrun('verlet_cable', 'parameters', ParametersTest, sys.argv)
