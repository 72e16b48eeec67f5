#!/usr/bin/env python3
"""Scenes that replace the one that runs, from files and as text; bad ones change nothing."""
import os
import shutil
import sys
import unittest

import rospy
import rostest

from cable_client import CableClient, cable, contents

SCENE = """
publish_rate: {rate}
materials: {{wire: {{linear_density: 0.05, radius: 0.002}}}}
cables: [{{name: {name}, length: 0.5, segments: 10, material: wire, attachments: [{{name: left, at: start}}]}}]
"""


class LoadSceneTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('load_scene_test')
        cls.node = CableClient('/cable')
        with cls.node.states() as states:
            states.next()
        cls.directory = rospy.get_param('~scene_directory')
        os.makedirs(cls.directory)
        cls.write('good.yaml', SCENE.format(name='filed', rate=50))
        cls.write('bad.yaml', SCENE.format(name='filed', rate=-1))
        cls.write('secret.yaml', SCENE.format(name='secret', rate=50), cls.directory + '_outside')
        os.symlink(cls.directory + '_outside/secret.yaml', cls.directory + '/link.yaml')
        os.mkfifo(cls.directory + '/pipe.yaml')

    @classmethod
    def tearDownClass(cls):
        shutil.rmtree(cls.directory)
        shutil.rmtree(cls.directory + '_outside')

    @classmethod
    def write(cls, name, text, directory=None):
        directory = directory or cls.directory
        os.makedirs(directory, exist_ok=True)
        with open(os.path.join(directory, name), 'w') as file:
            file.write(text)

    def assertShows(self, *names):
        with self.node.states() as states:
            states.wait_for(lambda s: [c.name for c in s.cables] == list(names), f'state of {names}')

    def assertRefused(self, answer, *parts):
        self.assertFalse(answer.success, answer)
        for part in parts:
            self.assertIn(part, answer.message)

    def test_text_replaces_the_scene_and_its_rate(self):
        with self.node.states() as states:
            before = states.next()
            answer = self.node.load_scene(yaml=SCENE.format(name='written', rate=20))
            self.assertTrue(answer.success, answer.message)
            first = states.wait_for(lambda s: cable(s, 'written'), 'the new scene')
            self.assertGreaterEqual(first.header.stamp, before.header.stamp)
            states.clear()
            states.next(4)
            stamps = [s.header.stamp.to_sec() for s in states.all()]
            for earlier, later in zip(stamps, stamps[1:]):
                self.assertAlmostEqual(later - earlier, 0.05, delta=1e-6)  # stamps are doubles of about 1e9 s
        self.assertRefused(self.node.restore_state(name='of_the_old_scene'))
        self.assertTrue(self.node.reset().success)
        self.assertShows('written')

    def test_files_inside_the_directory_and_of_packages(self):
        for file in ('good.yaml', self.directory + '/good.yaml', self.directory + '/../' + os.path.basename(self.directory) + '/good.yaml'):
            answer = self.node.load_scene(file)
            self.assertTrue(answer.success, answer.message)
            self.assertShows('filed')
            self.assertTrue(self.node.load_scene('package://verlet_cable/config/hanging_cable.yaml').success)
            self.assertNotIn('filed', [c.name for c in self.node.state().cables])

    def test_a_scene_is_loaded_while_paused(self):
        self.assertTrue(self.node.pause(True).success)
        self.assertTrue(self.node.load_scene('good.yaml').success)
        before = self.node.state()
        self.assertTrue(self.node.step(10).success)
        self.assertAlmostEqual((self.node.state().header.stamp - before.header.stamp).to_sec(), 0.01, delta=1e-9)
        self.assertTrue(self.node.pause(False).success)

    def test_bad_ones_are_refused_and_change_nothing(self):
        self.assertTrue(self.node.load_scene('good.yaml').success)
        self.assertTrue(self.node.pause(True).success)
        before = self.node.state()
        load = self.node.load_scene
        self.assertRefused(load(), 'both empty')
        self.assertRefused(load('good.yaml', 'cables: []'), 'both given')
        self.assertRefused(load('bad.yaml'), 'publish_rate: -1')
        for file in ('/etc/passwd', '../secret.yaml', '/dev/zero', 'link.yaml', self.directory + '_outside/secret.yaml', 'none.yaml',
                     'pipe.yaml', '.', '\0', 'package://verlet_cable/../../../etc/passwd', 'package://', 'package://none_such/a.yaml',
                     'package://verlet_cable', 'x' * 10_000_000):
            answer = load(file)
            self.assertRefused(answer, 'file: ', 'allowed')
            self.assertLess(len(answer.message), 1000)
        self.assertRefused(load(yaml='a: [1, 2'), 'line 1')
        self.assertRefused(load(yaml='- 1'), 'scene')
        self.assertRefused(load(yaml=SCENE.format(name='x', rate='.nan')), 'publish_rate')
        self.assertRefused(load(yaml='#' * 10_000_000), 'yaml: 10000000 bytes')
        self.assertRefused(load(yaml='[' * 100_000), 'levels')
        answer = load(yaml='\n'.join(f'key_{i}: 1' for i in range(10000)))
        self.assertRefused(answer, 'key_0', 'more')
        self.assertLess(len(answer.message), 10000)
        many = SCENE.format(name='many', rate=50).replace('segments: 10', 'segments: 2000')
        self.assertRefused(load(yaml=many), 'limits.segments')
        self.assertRefused(load(yaml=many + 'limits: {segments: 5000}\n'), 'limits.segments = 1000')
        self.assertEqual(contents(self.node.state()), contents(before))
        self.assertTrue(self.node.pause(False).success)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'load_scene', LoadSceneTest, sys.argv)
