#!/usr/bin/env python3
"""The README's first scene and what it tells to type; and what a new user types wrong."""
import glob
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from tf2_msgs.msg import TFMessage

from cable_client import CableClient, Messages, all_finite, cable, transform
from verlet_cable.msg import CableArray

PACKAGE = sys.argv[0].partition('/test/ros/')[0]
PATIENCE = 60  # [s] for a program that ends by itself


def blocks(kind):
    """The code blocks of the README, those of a kind."""
    with open(f'{PACKAGE}/README.md', encoding='utf-8') as file:
        parts = re.split(r'^```(.*)\n', file.read(), flags=re.MULTILINE)
    # text, kind, block, '', text, kind, block, '', text
    return [block for k, block in zip(parts[1::4], parts[2::4]) if k == kind]


def typed(start):
    """The lines in code blocks that start so, without what follows as a comment or sends them into the background."""
    lines = [line for block in blocks('') for line in block.splitlines() if line.startswith(start)]
    if not lines:
        raise AssertionError(f'README.md: no line to type that starts with {start}')
    return [re.sub(r'\s+(#.*|&)$', '', line) for line in lines]


class Program:
    """What runs in a terminal of its own."""

    def __init__(self, line, directory, environment):
        self._log = tempfile.TemporaryFile()
        self._process = subprocess.Popen(['bash', '-c', 'exec ' + line], cwd=directory, env=environment, stdout=self._log,
                                         stderr=subprocess.STDOUT)

    def stop(self):
        self._process.send_signal(signal.SIGINT)
        self._process.wait(PATIENCE)
        self._log.close()

    def text(self):
        return os.pread(self._log.fileno(), 1 << 20, 0).decode()

    def wait_for_lines(self, part, count=1):
        """The first lines that contain a text."""
        deadline = time.monotonic() + PATIENCE
        while time.monotonic() < deadline:
            lines = [line for line in self.text().splitlines(keepends=True) if part in line and line.endswith('\n')]
            if len(lines) >= count:
                return lines[:count]
            time.sleep(0.1)
        raise AssertionError(f'not {count} lines with {part!r} in {PATIENCE} s, but:\n{self.text()}')


class ReadmeTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('readme_test')

    def setUp(self):
        """As in a checkout, but what is written goes elsewhere."""
        self.directory = tempfile.mkdtemp()
        self.addCleanup(shutil.rmtree, self.directory)
        os.symlink(f'{PACKAGE}/config', f'{self.directory}/config')
        self.environment = {**os.environ, 'PWD': self.directory}

    def start(self, line):
        """Until the end of the test."""
        program = Program(line, self.directory, self.environment)
        self.addCleanup(program.stop)
        return program

    def run_to_end(self, line):
        return subprocess.run(line, shell=True, executable='/bin/bash', cwd=self.directory, env=self.environment, timeout=PATIENCE,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)

    def start_hose(self):
        line = typed('roslaunch verlet_cable cable.launch scene:=config/hose.yaml rviz:=true')[0]
        program = self.start(line.replace('rviz:=true', 'rviz:=false'))
        program.wait_for_lines('stays at its initial_pose', 2)
        return program, CableClient('/cable')

    def write_waiting_hose(self):
        """Without initial poses."""
        with open(f'{self.directory}/waiting.yaml', 'w', encoding='utf-8') as file:
            file.write(re.sub(r' initial_pose: \[.*?\],', '', blocks('yaml')[0]))

    def start_waiting_hose(self):
        self.write_waiting_hose()
        program = self.start('roslaunch verlet_cable cable.launch scene:=waiting.yaml')
        program.wait_for_lines('not shown yet')
        return program, CableClient('/cable')

    def test_the_scene_is_the_one_that_ships(self):
        with open(f'{PACKAGE}/config/hose.yaml', encoding='utf-8') as file:
            self.assertEqual(blocks('yaml')[0], file.read())

    def test_the_hose_is_there_before_its_frames(self):
        program, node = self.start_hose()
        ends = cable(node.state(), 'hose').positions[0], cable(node.state(), 'hose').positions[-1]
        self.assertEqual([(round(p.x, 6), p.y, p.z) for p in ends], [(-0.35, 0, 1), (0.35, 0, 1)])
        for line in typed('rosrun tf2_ros static_transform_publisher'):
            self.start(line)
        with node.states() as states:
            states.wait_for(lambda s: [round(cable(s, 'hose').positions[i].x, 6) for i in (0, -1)] == [-0.35, 0.35], 'hose in its frames')
        self.assertNotIn('WARN', program.text())

    def test_a_hose_without_poses_asks_for_its_frames_and_follows_them(self):
        program, node = self.start_waiting_hose()
        with Messages('/diagnostics', DiagnosticArray) as diagnostics:
            warning, = program.wait_for_lines('WARN')
            self.assertIn('"hose"', warning)
            self.assertIn('from "world" to "left_gripper" and "right_gripper"', warning)
            for command in ('0 0 1 0 0 0 world left_gripper', '0.84 0 1 0 0 0 world right_gripper'):
                program.wait_for_lines(f'  rosrun tf2_ros static_transform_publisher {command} &', 1)
            self.assertEqual(node.state().cables, [])
            for answer in (node.set_length('hose', False, 1.0, 0.1, 0), node.join('hose', True, 'hose', False)):
                self.assertFalse(answer.success)
                self.assertIn('"hose" waits for its tf frames', answer.message)
            diagnostics.wait_for(lambda a: any(v.key == 'waiting_cables' and v.value == 'hose' for s in a.status for v in s.values),
                                 'hose among waiting_cables')
        with node.states() as states:
            for line in typed('rosrun tf2_ros static_transform_publisher'):
                self.start(line)
            program.wait_for_lines('has appeared on tf', 2)
            state = states.wait_for(lambda s: cable(s, 'hose'), 'hose')
            self.assertTrue(all_finite(state))
            ends = cable(state, 'hose').positions[0], cable(state, 'hose').positions[-1]
            self.assertEqual([(round(p.x, 6), p.y, p.z) for p in ends], [(-0.35, 0, 1), (0.35, 0, 1)])

    def test_frames_that_come_with_the_node_are_not_asked_for(self):
        frames = rospy.Publisher('/tf_static', TFMessage, queue_size=1, latch=True)
        self.addCleanup(frames.unregister)
        self.write_waiting_hose()
        program = self.start('roslaunch verlet_cable cable.launch scene:=waiting.yaml')
        # It no longer waits for them to start.
        self.assertEqual(rospy.wait_for_message('/cable/state', CableArray, PATIENCE).cables, [])
        frames.publish([transform('left_gripper', 1, (-0.35, 0, 1)), transform('right_gripper', 1, (0.35, 0, 1))])
        program.wait_for_lines('has appeared on tf', 2)
        self.assertNotIn('WARN', program.text())

    def test_the_hose_follows_moving_frames(self):
        line, = typed('rosrun verlet_cable play_motion.py')
        program, node = self.start_hose()
        self.start(line).wait_for_lines('plays config/hose_motion.csv, 8 s, goes back, resets the cables')
        program.wait_for_lines('has appeared on tf', 2)
        with node.states() as states:
            start = cable(states.wait_for(lambda s: cable(s, 'hose'), 'hose'), 'hose').positions[0]
            states.clear()
            states.wait_for(lambda s: abs(cable(s, 'hose').positions[0].y - start.y) > 0.05, 'hose that moves')

    def test_the_services_are_called(self):
        program, node = self.start_hose()
        for line in typed('rosrun tf2_ros static_transform_publisher'):
            self.start(line)
        program.wait_for_lines('has appeared on tf', 2)
        with node.states() as states:
            states.wait_for(lambda s: cable(s, 'hose'), 'hose')
        lines = typed('rosservice call /cable/')
        self.assertEqual([line.split()[2] for line in lines], ['/cable/pin', '/cable/unpin', '/cable/set_length', '/cable/cut'])
        for line in lines:
            self.assertIn('success: True', self.run_to_end(line).stdout)
        self.assertEqual(len(node.state().cables), 2)

    def test_the_warning_comes_again(self):
        program, _ = self.start_waiting_hose()
        first, second = (float(re.search(r'\[(\d+\.\d+)\]', line)[1]) for line in program.wait_for_lines('not shown yet', 2))
        self.assertAlmostEqual(second - first, 10, delta=2)

    def test_offline(self):
        line, = typed('rosrun verlet_cable cable_sim')
        done = self.run_to_end(line)
        self.assertEqual(done.returncode, 0, done.stdout)
        for file in ('rows.csv', 'summary.json'):
            self.assertGreater(os.path.getsize(f'{self.directory}/{file}'), 100)

    def test_the_recording_is_replayed(self):
        line = typed('roslaunch verlet_cable replay.launch')[0]
        program = self.start(line + ' rviz:=false loop:=false')
        result, = program.wait_for_lines('mean error')
        self.assertLess(float(re.search(r'mean error ([\d.]+) cm over 250 frames', result)[1]), 0.2)  # noise alone is 0.08

    def test_the_files_it_names_are_there(self):
        named = {name for block in blocks('') for name in re.findall(r'config/[\w/.*]+', block)}
        self.assertGreater(len(named), 3)
        for name in named:
            self.assertTrue(glob.glob(f'{PACKAGE}/{name}'), name)

    def test_a_scene_that_is_not_there(self):
        done = self.run_to_end('roslaunch verlet_cable cable.launch scene:=hoose.yaml')
        self.assertNotEqual(done.returncode, 0)
        self.assertIn(f'file does not exist [{self.directory}/hoose.yaml]', done.stdout)

    def test_names_of_scenes(self):
        for launch, allowed in (('scene', 'pole, pile, table, knot, crossed, flat_cable, coiled_cable, moored_buoy, dress_pack'), ('lecture', 'box, planet, oscillator')):
            done = self.run_to_end(f'roslaunch verlet_cable {launch}.launch scene:=knott rviz:=false')
            self.assertIn(f'{launch}.launch: scene: "knott"; allowed: {allowed}', done.stdout)
            self.assertNotIn('Traceback', done.stdout)
            self.assertNotIn('[play_motion', done.stdout)

    def test_a_node_without_a_scene(self):
        done = self.run_to_end('rosrun verlet_cable cable_node __name:=alone')
        self.assertEqual(done.returncode, 2)
        self.assertIn('roslaunch verlet_cable cable.launch scene:=', done.stdout)

    def test_arguments_are_answered_without_a_master(self):
        self.environment['ROS_MASTER_URI'] = 'http://localhost:9'
        for argument, status, part in (('--help', 0, ''), ('hose.yaml', 2, '"hose.yaml"'), ('--halp', 2, '"--halp"')):
            done = self.run_to_end('rosrun verlet_cable cable_node ' + argument)
            self.assertEqual(done.returncode, status, done.stdout)
            self.assertIn(part, done.stdout)
            self.assertIn('usage: cable_node', done.stdout)

    def test_a_node_without_a_master(self):
        self.environment['ROS_MASTER_URI'] = 'http://localhost:9'
        node = self.start('rosrun verlet_cable cable_node')
        line, = node.wait_for_lines('no ROS master')
        self.assertIn('no ROS master at http://localhost:9: start roscore, or use roslaunch', line)
        time.sleep(1)
        self.assertEqual(node.text().count('\n'), 1, node.text())

    def test_a_motion_without_a_master(self):
        self.environment['ROS_MASTER_URI'] = 'http://localhost:9'
        done = self.run_to_end(typed('rosrun verlet_cable play_motion.py')[0])
        self.assertEqual(done.returncode, 1)
        self.assertIn('play_motion: no ROS master at http://localhost:9: start roscore, or use roslaunch', done.stdout)
        self.assertNotIn('Traceback', done.stdout)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'readme', ReadmeTest, sys.argv)
