#!/usr/bin/env python3
"""Nodes in simulated time: a clock that was never there, runs, stands, goes back, creeps and races."""
import math
import os
import re
import signal
import subprocess
import sys
import tempfile
import time
import unittest

import rospy
import rostest
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import MarkerArray

from cable_client import CableClient, Messages, all_finite, cable, distance, node_at, transform
from verlet_cable.msg import CableArray, CableEvent

SPEED = 4  # of the clock, times real time, where nothing else is said


def positions(state):
    return [(p.x, p.y, p.z) for p in cable(state, 'rope').positions]


class SimTimeTest(unittest.TestCase):
    def setUp(self):
        self.clock = rospy.Publisher('/clock', Clock, queue_size=100)
        self.tf = rospy.Publisher('/tf', TFMessage, queue_size=100)
        self.resetting, self.keeping = CableClient('/resetting'), CableClient('/keeping')

    def play(self, start, seconds, speed=SPEED):
        """A frame that moves with the time since `start`, every 10 ms of simulated time, and the clock, about every 10 ms of real
        time where it races.

        tf and the clock come by two connections: at the beginning tf is ahead.
        """
        frames_a_tick = max(1, round(speed))
        for i in range(round(seconds * 100) + 1):
            t = i / 100
            self.tf.publish([transform('hand', start + t, (0.1 * math.sin(5 * t), 0, 1))])
            if i % frames_a_tick:
                continue
            time.sleep(0.05 if i == 0 else frames_a_tick * 0.01 / speed)
            self.clock.publish(rospy.Time.from_sec(start + t))

    def test_a_clock_that_never_comes(self):
        """Another node, for which another topic is the clock: that of this one may have run before."""
        command = ['rosrun', 'verlet_cable', 'cable_node', '__name:=timeless', '/clock:=/no_clock']
        with tempfile.TemporaryFile('w+') as log:
            process = subprocess.Popen(command, stdout=log, stderr=subprocess.STDOUT)
            try:
                timeless = CableClient('/timeless')
                for answer in (timeless.pin(node_at('rope', 3), name='third'), timeless.cut(node_at('rope', 3))):
                    self.assertFalse(answer.success)
                    self.assertIn('no ROS time', answer.message)
                self.assertTrue(timeless.pause(True).success)
                deadline = time.monotonic() + 60
                while (text := os.pread(log.fileno(), 1 << 20, 0).decode()).count('WARN') < 2 and time.monotonic() < deadline:
                    time.sleep(0.1)
                self.assertEqual(len(re.findall('WARN.*nothing publishes /clock', text)), 2, text)
            finally:
                process.send_signal(signal.SIGINT)
                process.wait(20)

    def test_a_scene_that_takes_long_is_built_aside(self):
        """When the node starts, and when the clock goes back; services answer meanwhile, and say so."""
        process = subprocess.Popen(['rosrun', 'verlet_cable', 'cable_node', '__name:=slow', '/clock:=/slow_clock'])
        try:
            slow = CableClient('/slow')
            clock = rospy.Publisher('/slow_clock', Clock, queue_size=100)
            for start in (100, 50):
                begin, slowest, refused = time.monotonic(), 0, 0
                while True:
                    asked = time.monotonic()
                    self.assertLess(asked, begin + 100, 'the scene is not built')
                    clock.publish(rospy.Time.from_sec(start + asked - begin))
                    answer = slow.reset()  # the last takes as long as the scene takes to build
                    if 'the simulation has not started: its scene is being built' in answer.message:
                        slowest = max(slowest, time.monotonic() - asked)
                        refused += 1
                    elif refused:
                        break
                    time.sleep(0.01)
                took = time.monotonic() - begin
                rospy.loginfo('built in %.1f s, %d resets refused meanwhile, slowest answer %.0f ms', took, refused, 1e3 * slowest)
                self.assertTrue(answer.success, answer.message)
                self.assertLess(slowest, 0.5 * took)
        finally:
            process.kill()
            process.wait()

    def test_the_life_of_a_clock(self):
        with self.resetting.states() as resetting, self.keeping.states() as keeping, \
                self.resetting.events() as resets, self.keeping.events() as keeps:
            time.sleep(0.3)
            self.assertEqual(resetting.all(), [], 'no time, no messages')
            answer = self.resetting.reset()
            self.assertFalse(answer.success)
            self.assertIn('no ROS time', answer.message)

            # of a program that does not know of simulated time: the clock shows that it is a mistake
            self.tf.publish([transform('hand', 1e9, (5, 5, 5))])
            self.play(100, 1)
            last = resetting.wait_for(lambda s: s.header.stamp.to_sec() >= 100.94, 'state of the last tick')
            # the last tick before the end of the clock less tf_latency, 100.95
            self.assertAlmostEqual(last.header.stamp.to_sec(), 100.94, delta=1e-6)
            first_run = resetting.all()
            self.assertEqual(first_run[0].header.stamp, rospy.Time(100), 'from the first pose of the frame on')

            # the clock stands: so does everything, but a paused simulation can be stepped, and its messages go on
            resetting.clear()
            time.sleep(0.2)
            self.assertEqual(resetting.all(), [], 'no tick while the clock stands')
            # who comes now sees how things stand, soon; nothing else has changed
            for topic, kind in (('state', CableArray), ('markers', MarkerArray), ('points', PointCloud2)):
                with Messages(f'/resetting/{topic}', kind) as late:
                    begin = time.monotonic()
                    first = late.next()
                    header = first.markers[0].header if kind is MarkerArray else first.header
                    rospy.loginfo('%s after %.2f s', topic, time.monotonic() - begin)
                    self.assertLess(time.monotonic() - begin, 2)
                    self.assertEqual(header.stamp.to_nsec(), int(100.95e9))
            self.assertEqual({s.header.stamp.to_nsec() for s in resetting.all()}, {int(100.95e9)})
            self.assertFalse(self.resetting.step(1).success)
            self.assertTrue(self.resetting.pause(True).success)
            resetting.next(3)
            standing = {s.header.stamp.to_nsec() for s in resetting.all()}
            # it stands at the last step, between two ticks
            self.assertEqual(standing, {int(100.95e9)})
            answer = self.resetting.step(200)  # beyond what tf knows, too
            self.assertTrue(answer.success, answer.message)
            self.assertAlmostEqual(answer.time, 101.15, delta=1e-9)
            stepped = resetting.wait_for(lambda s: s.header.stamp.to_nsec() == int(101.15e9), 'stepped state')
            self.assertTrue(all_finite(stepped))
            self.assertLess(distance(cable(stepped, 'rope').positions[0], (0.1 * math.sin(5), 0, 1)), 1e-9)
            self.assertTrue(self.resetting.pause(False).success)

            # it goes back
            before = keeping.all()[-1]
            resetting.clear(), keeping.clear()
            self.play(50, 1)
            for log in (resets, keeps):
                log.wait_for(lambda e: e.type == CableEvent.TIME_JUMP, 'TIME_JUMP')
            resetting.wait_for(lambda s: s.header.stamp.to_sec() >= 50.94, 'last tick after the jump')
            second_run = resetting.all()
            self.assertEqual(second_run[0].header.stamp, rospy.Time(50))
            self.assertTrue(all(50 <= s.header.stamp.to_sec() < 51 for s in second_run))
            # the same motion of the frame gives the same motion of the rope, to the rounding of times and interpolation
            times = {round(s.header.stamp.to_sec() - 100, 3): s for s in first_run}
            both = [(times[t], s) for s in second_run for t in [round(s.header.stamp.to_sec() - 50, 3)] if t in times]
            self.assertGreater(len(both), 40)
            for one, other in both:
                for p, q in zip(positions(one), positions(other)):
                    self.assertLess(math.dist(p, q), 1e-6)
            # kept: the free end has not left the swing it was in for the horizontal start
            kept = keeping.all()[0]
            self.assertLess(kept.header.stamp.to_sec(), 51)
            self.assertLess(math.dist(positions(before)[-1], positions(kept)[-1]), 0.2)
            self.assertGreater(math.dist(positions(second_run[0])[-1], positions(kept)[-1]), 0.2)

    def test_the_speed_of_the_clock_changes_nothing(self):
        runs = []
        with self.resetting.states() as states, self.resetting.events() as events:
            for speed in (1, 0.1, 10):
                events.clear(), states.clear()
                self.play(20, 0.6, speed)
                states.wait_for(lambda s: 20.54 <= s.header.stamp.to_sec() < 21, 'last tick')
                runs.append({s.header.stamp.to_nsec(): positions(s) for s in states.all() if 20 <= s.header.stamp.to_sec() < 21})
        self.assertEqual(sorted(runs[0]), [int(20e9) + 20_000_000 * i for i in range(28)])
        for run in runs[1:]:
            self.assertEqual(run, runs[0])


if __name__ == '__main__':
    rospy.init_node('sim_time_test', disable_rostime=True)
    rostest.rosrun('verlet_cable', 'sim_time', SimTimeTest, sys.argv)
