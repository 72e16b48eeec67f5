#!/usr/bin/env python3
"""Master and user on one host, the node on another: two network namespaces with a cable between them."""
import os
import shutil
import subprocess
import sys
import time
import unittest

import rosgraph
import rostest

NEAR, FAR = '10.213.57.1', '10.213.57.2'
PORT = 11497
PATIENCE = 20.0  # [s] for a roscore and a node to start on a busy machine
SCENE = """
materials: {rope: {linear_density: 0.1, radius: 0.005}}
cables: [{name: rope, length: 1.0, segments: 10, material: rope, attachments: [{name: left, at: start}]}]
"""
USER = """
import rospy
from std_srvs.srv import Trigger
from verlet_cable.msg import CableArray
rospy.init_node('user')
for _ in range(10):
    assert rospy.wait_for_message('/far/cable/state', CableArray, 10).cables[0].name == 'rope'
rospy.wait_for_service('/far/cable/reset', 10)
assert rospy.ServiceProxy('/far/cable/reset', Trigger)().success
"""


def network_of(process):
    return f'/proc/{process}/ns/net'


class TwoHostsTest(unittest.TestCase):
    def setUp(self):
        problem = self.make_hosts()
        if problem:
            print('two_hosts_test is skipped, network namespaces cannot be made here:', problem)
            self.skipTest(problem)

    def make_hosts(self):
        """Why there can be no two hosts here, or None. The far one is the network of a process: a name for it (`ip netns add`)
        would need mounts, which are not to be had everywhere."""
        if not shutil.which('ip'):
            return 'there is no program ip'
        far = subprocess.Popen(['unshare', '--net', 'sleep', 'infinity'], stderr=subprocess.PIPE, text=True)
        self.addCleanup(far.stderr.close)
        self.addCleanup(far.wait)
        self.addCleanup(far.kill)
        while os.readlink(network_of(far.pid)) == os.readlink(network_of('self')):
            if far.poll() is not None:
                return far.stderr.read().strip()
            time.sleep(0.01)
        self.far = ['nsenter', f'--net={network_of(far.pid)}']
        for command in (['ip', 'link', 'add', 'cable_near', 'type', 'veth', 'peer', 'name', 'cable_far'],
                        ['ip', 'link', 'set', 'cable_far', 'netns', str(far.pid)],
                        ['ip', 'addr', 'add', NEAR + '/24', 'dev', 'cable_near'], ['ip', 'link', 'set', 'cable_near', 'up'],
                        [*self.far, 'ip', 'addr', 'add', FAR + '/24', 'dev', 'cable_far'],
                        [*self.far, 'ip', 'link', 'set', 'cable_far', 'up'], [*self.far, 'ip', 'link', 'set', 'lo', 'up']):
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            if done.returncode != 0:
                return done.stdout.strip()
            if 'add' in command and 'veth' in command:
                self.addCleanup(subprocess.run, ['ip', 'link', 'delete', 'cable_near'])
        return None

    def start(self, command, host):
        environment = dict(os.environ, ROS_MASTER_URI=f'http://{NEAR}:{PORT}', ROS_IP=host)
        environment.pop('ROS_HOSTNAME', None)
        process = subprocess.Popen(command, env=environment)

        def end():
            process.terminate()
            process.wait()
        self.addCleanup(end)
        return process

    def test_topics_and_services_cross_the_hosts(self):
        self.start(['roscore', '-p', str(PORT)], NEAR)
        master = rosgraph.Master('/two_hosts_test', f'http://{NEAR}:{PORT}')
        deadline = time.monotonic() + PATIENCE
        while not master.is_online():
            self.assertLess(time.monotonic(), deadline, 'roscore that starts')
            time.sleep(0.1)
        self.assertEqual(self.start(['rosparam', 'set', '/far/cable', SCENE], NEAR).wait(PATIENCE), 0)
        self.start([*self.far, 'rosrun', 'verlet_cable', 'cable_node', '__name:=cable', '__ns:=/far'], FAR)
        self.assertEqual(self.start([sys.executable, '-c', USER], NEAR).wait(2 * PATIENCE), 0)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'two_hosts', TwoHostsTest, sys.argv)
