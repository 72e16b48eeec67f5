#!/usr/bin/env python3
"""The README's first scene and what it tells to type; and what a new user types wrong."""
import os
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from rosgraph_msgs.msg import Log

from cable_client import CableClient, Messages, all_finite, cable

PACKAGE = sys.argv[0].partition('/test/ros/')[0]
PATIENCE = 60  # [s] for a program that ends by itself


def blocks(kind):
    """The code blocks of the README, those of a kind."""
    with open(f'{PACKAGE}/README.md', encoding='utf-8') as file:
        return re.findall(rf'^```{kind}\n(.*?)^```$', file.read(), re.MULTILINE | re.DOTALL)


def typed(start):
    """The lines in code blocks that start so, without what follows as a comment or sends them into the background."""
    lines = [line for block in blocks('') for line in block.splitlines() if line.startswith(start)]
    if not lines:
        raise AssertionError(f'README.md: no line to type that starts with {start}')
    return [re.sub(r'\s+(#.*|&)$', '', line) for line in lines]


def waits(log):
    return log.level == Log.WARN and 'hose' in log.msg and 'left_gripper' in log.msg


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
        """Until the end of the test, or until the function that it returns is called."""
        process = subprocess.Popen(['bash', '-c', 'exec ' + line], cwd=self.directory, env=self.environment)

        def stop():
            process.send_signal(signal.SIGINT)
            process.wait(PATIENCE)

        self.addCleanup(stop)
        return stop

    def run_to_end(self, line):
        return subprocess.run(line, shell=True, executable='/bin/bash', cwd=self.directory, env=self.environment, timeout=PATIENCE,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, universal_newlines=True)

    def start_hose(self):
        line = typed('roslaunch verlet_cable cable.launch scene:=config/hose.yaml rviz:=true')[0]
        self.start(line.replace('rviz:=true', 'rviz:=false'))
        return CableClient('/cable')

    def test_the_scene_is_the_one_that_ships(self):
        with open(f'{PACKAGE}/config/hose.yaml', encoding='utf-8') as file:
            self.assertEqual(blocks('yaml')[0], file.read())

    def test_the_hose_asks_for_its_frames_and_follows_them(self):
        with Messages('/rosout_agg', Log) as logs, Messages('/diagnostics', DiagnosticArray) as diagnostics:
            node = self.start_hose()
            warning = logs.wait_for(waits, 'warning that the hose waits')
            self.assertIn('"left_gripper" and "right_gripper"', warning.msg)
            suggested = re.search(r'rosrun tf2_ros static_transform_publisher .* world left_gripper$', warning.msg)
            self.assertTrue(suggested, warning.msg)
            self.assertEqual(node.state().cables, [])
            diagnostics.wait_for(lambda a: any(v.key == 'waiting_cables' and v.value == 'hose' for s in a.status for v in s.values),
                                 'hose among waiting_cables')
        with node.states() as states:
            for line in typed('rosrun tf2_ros static_transform_publisher'):
                self.start(line)
            state = states.wait_for(lambda s: cable(s, 'hose'), 'hose')
            self.assertTrue(all_finite(state))
            ends = cable(state, 'hose').positions[0], cable(state, 'hose').positions[-1]
            self.assertEqual([(round(p.x, 6), p.y, p.z) for p in ends], [(-0.4, 0, 1), (0.4, 0, 1)])

    def test_the_hose_follows_moving_frames(self):
        line, = typed('rosrun verlet_cable play_motion.py')
        node = self.start_hose()
        self.start(line)
        with node.states() as states:
            start = cable(states.wait_for(lambda s: cable(s, 'hose'), 'hose'), 'hose').positions[0]
            states.wait_for(lambda s: abs(cable(s, 'hose').positions[0].y - start.y) > 0.05, 'hose that moves')

    def test_the_warning_comes_again(self):
        with Messages('/rosout_agg', Log) as logs:
            self.start_hose()
            first = logs.wait_for(waits, 'warning')
            deadline = rospy.get_time() + PATIENCE
            while sum(waits(log) for log in logs.all()) < 2 and rospy.get_time() < deadline:
                rospy.sleep(0.1)
            second = [log for log in logs.all() if waits(log)][1]
            self.assertAlmostEqual((second.header.stamp - first.header.stamp).to_sec(), 10, delta=2)

    def test_offline(self):
        line, = typed('rosrun verlet_cable cable_sim')
        done = self.run_to_end(line)
        self.assertEqual(done.returncode, 0, done.stdout)
        for file in ('rows.csv', 'summary.json'):
            self.assertGreater(os.path.getsize(f'{self.directory}/{file}'), 100)

    def test_a_scene_that_is_not_there(self):
        done = self.run_to_end('roslaunch verlet_cable cable.launch scene:=hoose.yaml')
        self.assertNotEqual(done.returncode, 0)
        self.assertIn(f'file does not exist [{self.directory}/hoose.yaml]', done.stdout)

    def test_names_of_scenes(self):
        for launch, allowed in (('scene', 'pole, pile, table, knot, crossed, dress_pack'), ('lecture', 'box, planet, oscillator')):
            done = self.run_to_end(f'roslaunch verlet_cable {launch}.launch scene:=knott rviz:=false')
            self.assertIn(f'{launch}.launch: scene: "knott"; allowed: {allowed}', done.stdout)

    def test_a_node_without_a_scene(self):
        done = self.run_to_end('rosrun verlet_cable cable_node __name:=alone')
        self.assertEqual(done.returncode, 2)
        self.assertIn('roslaunch verlet_cable cable.launch scene:=', done.stdout)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'readme', ReadmeTest, sys.argv)
