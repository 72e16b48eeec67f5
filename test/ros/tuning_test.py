#!/usr/bin/env python3
"""dynamic_reconfigure under ~tuning: true ranges, changes that act at once and last, bad ones that change nothing."""
import sys
import unittest

import rospy
import rostest
from dynamic_reconfigure.client import Client
from dynamic_reconfigure.msg import Config, DoubleParameter, StrParameter
from dynamic_reconfigure.srv import Reconfigure

from cable_client import CableClient, cable


class TuningTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('tuning_test')
        cls.node = CableClient('/cable')
        with cls.node.states() as states:
            states.next()
        cls.client = Client('/cable/tuning', timeout=5)
        cls.service = staticmethod(rospy.ServiceProxy('/cable/tuning/set_parameters', Reconfigure))

    def values(self):
        return {p.name: p.value for p in self.service(Config()).config.doubles}

    def test_parameters_have_their_values_and_ranges(self):
        described = {d['name']: d for d in self.client.get_parameter_descriptions()}
        values = self.values()
        self.assertEqual([values[f'gravity_{axis}'] for axis in 'xyz'], [0, 0, -9.81])
        self.assertEqual(values['wind_x'], 0)
        self.assertEqual(values['rope_drag'], 0.1)
        for name in ('bending_stiffness', 'torsional_stiffness', 'bending_damping', 'torsional_damping', 'axial_damping', 'friction'):
            self.assertEqual((described[f'rope_{name}']['min'], described[f'rope_{name}']['max']), (0, 1e12), name)
        self.assertNotIn('rope_axial_stiffness', described, 'what is inextensible stays so')
        self.assertNotIn('rope_linear_density', described)

    def test_gravity_and_wind_act_at_once_and_last(self):
        self.client.update_configuration({'gravity_z': 0.0, 'rope_drag': 1.0, 'wind_y': 3.0, 'rope_bending_stiffness': 0.01})
        with self.node.states() as states:
            states.wait_for(lambda s: cable(s, 'rope').positions[50].y > 0.1, 'rope in the wind')
        self.assertTrue(self.node.reset().success)
        self.assertEqual(self.values()['wind_y'], 3.0)
        self.client.update_configuration({'gravity_z': -9.81, 'rope_drag': 0.1, 'wind_y': 0.0, 'rope_bending_stiffness': 0.0})

    def test_bad_values_change_nothing(self):
        service = self.service
        before = service(Config()).config
        for name, value in (('gravity_z', float('nan')), ('gravity_z', float('inf')), ('rope_drag', -1.0), ('rope_friction', 1e300),
                            ('nothing', 1.0), ('', 1.0), ('x' * 10_000_000, 1.0), ('rope_bending_damping', 1e12)):
            changes = Config(doubles=[DoubleParameter('wind_x', 1.0), DoubleParameter(name, value)])
            self.assertEqual(service(changes).config, before, f'{name[:30]} {value}')
        self.assertEqual(service(Config(strs=[StrParameter('wind_x', '1')])).config, before)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'tuning', TuningTest, sys.argv)
