#!/usr/bin/env python3
"""Snapshots: what follows them is the same every time, bit for bit; bad requests are refused and change nothing."""
import json
import math
import os
import shutil
import sys
import unittest

import rospy
import rostest

from cable_client import CableClient, Frames, cable, contents, distance, node_at
from verlet_cable.sim import Scene, World

# That of scenes.test.
SCENE = {
    'materials': {'rope': {'linear_density': 0.1, 'radius': 0.005, 'drag': 0.1}},
    'cables': [{'name': 'rope', 'length': 1.0, 'segments': 20, 'material': 'rope',
                'attachments': [{'name': 'left', 'at': 'start'},
                                {'name': 'right', 'at': 'end', 'frame': 'hand', 'initial_pose': [0.6, 0, 0, 0, 0, 0]}],
                'initial': {'type': 'straight', 'from': [0, 0, 0], 'to': [0.99, 0, 0.1]}}]}

# A hose twisted by its clamp, on a floor and on itself, that a winch pays out.
BUSY_SCENE = """
contact: {}
materials: {hose: {linear_density: 0.1, radius: 0.01, bending_stiffness: 0.002, torsional_stiffness: 0.0015, bending_damping: 0.001}}
cables:
  - name: hose
    length: 1.0
    segments: 50
    material: hose
    attachments:
      - {name: reel, at: start, offset: [0, 0, 0.3], type: clamp}
      - {name: nozzle, at: end, frame: nozzle, initial_pose: [0.3, 0, 0.1, 0, 0, 0], type: clamp}
obstacles: [{name: floor, type: plane}]
"""


class SnapshotsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('snapshots_test')
        cls.node = CableClient('/cable')
        with cls.node.states() as states:
            states.next()

    def setUp(self):
        self.assertTrue(self.node.pause(False).success)
        self.assertTrue(self.node.reset().success)

    def assertRefused(self, answer, *parts):
        self.assertFalse(answer.success, answer)
        for part in parts:
            self.assertIn(part, answer.message)

    def run_on(self, steps):
        self.assertTrue(self.node.step(steps).success)
        return self.node.state()

    def test_what_follows_a_snapshot_is_the_same_bit_for_bit(self):
        self.assertTrue(self.node.pause(True).success)
        self.run_on(200)
        self.assertTrue(self.node.pin(node_at('rope', 10), (0.3, 0, -0.2)).success)
        saved = self.run_on(50)  # the pinned node is on its way
        self.assertTrue(self.node.save_state(name='way').success)
        first = self.run_on(1000)
        self.assertTrue(self.node.cut(node_at('rope', 5)).success)
        self.run_on(100)
        self.assertTrue(self.node.restore_state(name='way').success)
        restored = self.node.state()
        self.assertEqual(contents(restored), contents(saved), 'back at the time of the snapshot, too')
        self.assertEqual(contents(self.run_on(1000)), contents(first))

    def test_contacts_twist_and_a_winch_go_on_bit_for_bit(self):
        def turning(t):
            return (0.3, 0, 0.1), (math.sin(t / 2), 0, 0, math.cos(t / 2))  # 1 rad/s: no two times within a step look alike
        with Frames(nozzle=turning):
            self.assertTrue(self.node.load_scene(yaml=BUSY_SCENE).success)
            try:
                self.assertTrue(self.node.set_length('hose', False, 1.8, 0.2, 0).success)
                with self.node.states() as states:
                    states.wait_for(lambda s: cable(s, 'hose') and cable(s, 'hose').rest_length > 1.1 and cable(s, 'hose').contacts,
                                    'a longer hose that touches the floor')
                self.assertTrue(self.node.pause(True).success)
                rospy.sleep(1.3)  # tf has come for what follows
                self.assertTrue(self.node.save_state(name='busy').success)
                saved = cable(self.node.state(), 'hose')
                first = self.run_on(1000)
                self.assertTrue(self.node.restore_state(name='busy').success)
                self.assertEqual(contents(self.run_on(1000)), contents(first))
            finally:
                scene = {key: value for key, value in rospy.get_param('/cable').items() if key != 'tuning'}
                self.assertTrue(self.node.load_scene(yaml=json.dumps(scene)).success)
        later = cable(first, 'hose')
        self.assertGreater(len(saved.contacts), 0)
        self.assertGreater(later.rest_length, saved.rest_length + 0.1)
        self.assertGreater(max(abs(a - b) for a, b in zip(later.twist, saved.twist)), 0.01)

    def test_moving_frames_are_where_they_were(self):
        with Frames(hand=lambda t: (0.6 + 0.1 * (t % 1), 0, 0)):
            with self.node.states() as states:
                states.wait_for(lambda s: cable(s, 'rope').positions[20].x > 0.65, 'hand that moves')
            self.assertTrue(self.node.pause(True).success)
            rospy.sleep(0.5)  # tf has come for what follows
            self.assertTrue(self.node.save_state(name='moving').success)
            first = self.run_on(200)
            self.run_on(50)
            self.assertTrue(self.node.restore_state(name='moving').success)
            self.assertEqual(contents(self.run_on(200)), contents(first))

    def test_restored_while_running_the_stamp_goes_on(self):
        with self.node.states() as states:
            self.assertTrue(self.node.save_state(name='running').success)
            self.assertTrue(self.node.cut(node_at('rope', 10)).success)
            cut = states.wait_for(lambda s: len(s.cables) == 2, 'cut cable')
            self.assertTrue(self.node.restore_state(name='running').success)
            states.clear()
            whole = states.wait_for(lambda s: len(s.cables) == 1, 'whole cable')
            self.assertGreater(whole.header.stamp, cut.header.stamp)
            self.assertLess(distance(cable(whole, 'rope').positions[20], (0.6, 0, 0)), 0.2)

    def test_a_file_goes_on_here_and_in_python(self):
        directory = rospy.get_param('~scene_directory')
        os.makedirs(directory)
        self.addCleanup(shutil.rmtree, directory)
        self.assertTrue(self.node.pause(True).success)
        self.run_on(200)
        self.assertTrue(self.node.cut(node_at('rope', 15)).success)
        saved = self.run_on(50)
        answer = self.node.save_state(file='way.state')
        self.assertTrue(answer.success, answer.message)
        first = self.run_on(300)
        self.assertTrue(self.node.reset().success)
        answer = self.node.restore_state(file=directory + '/way.state')
        self.assertTrue(answer.success, answer.message)
        # But for the stamps: time goes on.
        self.assertEqual(contents(self.node.state())[1:], contents(saved)[1:])
        self.assertEqual(contents(self.run_on(300))[1:], contents(first)[1:])
        with open(directory + '/way.state', 'rb') as file:
            world = World.load(Scene.from_dict(SCENE), file.read())
        self.assertEqual(world.cable_names, [c.name for c in saved.cables])
        world.step(300)
        for shown in first.cables:
            positions = [[p.x, p.y, p.z] for p in shown.positions]
            self.assertLess(abs(world.positions(shown.name) - positions).max(), 1e-6, shown.name)
        world.step(100)
        with open(directory + '/further.state', 'wb') as file:
            file.write(world.save())
        self.assertTrue(self.node.restore_state(file='further.state').success)
        positions = [[p.x, p.y, p.z] for p in cable(self.node.state(), 'rope').positions]
        self.assertLess(abs(world.positions('rope') - positions).max(), 1e-6)
        with open(directory + '/broken.state', 'wb') as file:
            file.write(world.save()[:-1])
        before = self.node.state()
        self.assertRefused(self.node.restore_state(file='broken.state'), 'data: it is cut off or damaged')
        self.assertRefused(self.node.restore_state(file='none.state'), 'file: "none.state"', 'inside scene_directory')
        for file in ('../away.state', '/tmp/away.state', '.', 'no/where.state'):
            self.assertRefused(self.node.save_state(file=file), f'file: "{file}"', 'inside scene_directory')
        self.assertRefused(self.node.save_state(name='a', file='b'), 'name, file: "a" and "b"; allowed: one of them')
        self.assertEqual(contents(self.node.state()), contents(before))

    def test_bad_requests_are_refused(self):
        self.assertTrue(self.node.pause(True).success)
        before = self.node.state()
        self.assertRefused(self.node.restore_state(name='never'), 'name: "never"')
        self.assertRefused(self.node.restore_state(name=''), 'name: ""')
        self.assertRefused(self.node.save_state(name=''), 'name: ""')
        self.assertRefused(self.node.save_state(name='a b'), 'name: "a b"', 'letters')
        answer = self.node.save_state(name='x' * 10_000_000)
        self.assertRefused(answer, 'at most 100')
        self.assertLess(len(answer.message), 1000)
        for name in ('moving', 'running', 'way', 'other'):
            self.node.save_state(name=name)
        self.assertRefused(self.node.save_state(name='one_too_many'), 'limits.snapshots allows 3')
        self.assertEqual(contents(self.node.state()), contents(before))


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'snapshots', SnapshotsTest, sys.argv)
