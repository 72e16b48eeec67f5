#!/usr/bin/env python3
"""An overloaded node answers, says that it is overloaded and slows down evenly; tf late, in bursts, out of order and disputed."""
import math
import statistics
import struct
import subprocess
import sys
import time
import unittest

import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from rosgraph_msgs.msg import Log
from tf2_msgs.msg import TFMessage

from cable_client import CableClient, Frames, Messages, all_finite, cable, distance, transform

SWING = 0.1  # [m/s] of the hand


def first_stamp(raw):
    """[ns] Of the first marker of a MarkerArray: to read all of it takes Python longer than the next one takes to come."""
    count, _, seconds, nanoseconds = struct.unpack_from('<4I', raw._buff)
    assert count > 0
    return seconds * 10**9 + nanoseconds


def hand(t):
    return 0.3 + SWING * (t % 2 if t % 4 < 2 else 2 - t % 2), 0, 1


def shaking(phase):
    """A hand that shakes by 3 cm at 16 Hz: 300 m/s^2."""
    return lambda t: (0.1 * math.cos(phase) + 0.03 * math.sin(107 * t + phase), 0.1 * math.sin(2 * phase) + 0.03 * math.sin(89 * t),
                      0.03 * math.cos(97 * t + 2 * phase))


class OverloadTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('overload_test')
        cls.busy, cls.idle, cls.shaken = CableClient('/busy'), CableClient('/idle'), CableClient('/shaken')

    def test_services_answer_and_time_slows_evenly(self):
        with Frames(busy_hand=hand), Messages('/diagnostics', DiagnosticArray) as diagnostics, self.busy.states() as states:
            states.wait_for(lambda s: cable(s, 'rope'), 'rope')
            diagnostics.wait_for(lambda a: any(s.name == 'busy: simulation' and 'overloaded' in s.message for s in a.status),
                                 'overloaded node that says so')
            states.clear()
            answers, idle_answers = [], []
            for _ in range(100):
                for node, times in ((self.busy, answers), (self.idle, idle_answers)):
                    begin = time.monotonic()
                    node.unpin('nothing')
                    times.append(time.monotonic() - begin)
            median, idle = statistics.median(answers), statistics.median(idle_answers)
            rospy.loginfo('overloaded: services answer in %.1f ms, 99 %%: %.1f ms; of an idle node in %.1f ms', 1e3 * median,
                          1e3 * sorted(answers)[98], 1e3 * idle)
            # what an idle node takes is the machine, and the way there
            self.assertLess(median - idle, 0.05)
            states.next(10)
            moved = [(s.header.stamp.to_sec(), cable(s, 'rope').positions[0].x) for s in states.all()]
            for (t, a), (u, b) in zip(moved, moved[1:]):
                self.assertGreater(u, t)
                # the hand is where it is at the stamp: nothing is followed in leaps
                self.assertLess(abs(b - a), SWING * (u - t) * 1.1 + 1e-6)
            self.assertTrue(all(all_finite(s) for s in states.all()))

    def test_services_answer_where_steps_take_too_much_work(self):
        hands = {frame: shaking(i) for i, frame in enumerate('abcdefgh')}
        with Frames(**hands), Messages('/diagnostics', DiagnosticArray) as diagnostics, self.shaken.states() as states:
            states.wait_for(lambda s: cable(s, 'one'), 'cable')
            diagnostics.wait_for(lambda a: any(s.name == 'shaken: simulation' and 'too much work' in s.message for s in a.status),
                                 'node that says that steps take too much work', 30)
            answers = []
            for _ in range(200):
                begin = time.monotonic()
                self.shaken.unpin('nothing')
                answers.append(time.monotonic() - begin)
            answers.sort()
            rospy.loginfo('shaken: services answer in %.1f ms, 99 %%: %.1f ms', 1e3 * answers[100], 1e3 * answers[198])
            # a step of 20 ms, and what a busy machine adds; without a budget steps took seconds
            self.assertLess(answers[100], 0.2)
            self.assertTrue(all(all_finite(s) for s in states.all()))

    def test_time_is_dropped_rather_than_late_for_good_and_the_log_says_so(self):
        # small messages, which come at once
        with Frames(busy_hand=hand), Messages('/rosout', Log) as log, Messages('/busy/wrench/left', WrenchStamped) as wrenches:
            warnings = [log.wait_for(lambda m: m.name == '/busy' and 'cannot keep up' in m.msg, 'warning of an overload', 30)]
            self.assertRegex(warnings[0].msg, r'the cables move at 0\.\d+ of real time \([\d.]+ s dropped\)')
            self.assertEqual(warnings[0].level, Log.WARN)
            log.wait_for(lambda m: m.name == '/busy' and 'cannot keep up' in m.msg and m is not warnings[0], 'second warning', 30)
            wrenches.clear()
            late = [rospy.get_time() - wrenches.next().header.stamp.to_sec() for _ in range(20)]
            rospy.loginfo('overloaded: %.2f s late at most, %s', max(late), warnings[0].msg)
            # 2.2 s before, with this scene on an idle machine
            self.assertLess(statistics.median(late), 1.2)

    def test_bursts_and_disorder_of_tf_cost_nothing(self):
        publisher = rospy.Publisher('/tf', TFMessage, queue_size=100)
        sent = []
        with self.idle.states() as states:
            for burst in range(15):
                now = rospy.get_time()
                stamps = [now - 0.2 + 0.01 * i for i in range(20)]
                for stamp in stamps[::-1] if burst % 2 else stamps:
                    publisher.publish([transform('hand', stamp, hand(stamp))])
                sent.append(rospy.get_time())
                rospy.sleep(0.2)
            # 0.2 s, and what a busy machine adds: so long the node knows of nothing new
            gap = max(b - a for a, b in zip(sent, sent[1:]))
            followed = [s for s in states.all() if cable(s, 'rope')][10:]
            self.assertGreater(len(followed), 50)
            for state in followed:
                t = state.header.stamp.to_sec()
                self.assertLess(distance(cable(state, 'rope').positions[0], hand(t)), SWING * (gap + 0.1))
                self.assertTrue(all_finite(state))

    def test_two_sources_that_disagree_are_reported(self):
        other = subprocess.Popen([sys.executable, __file__, '--other-source'])
        try:
            with Frames(hand=lambda t: (0.3, 0, 1)), Messages('/diagnostics', DiagnosticArray) as diagnostics, \
                    self.idle.states() as states:
                diagnostics.wait_for(lambda a: any(s.name == 'idle: frames' and 'comes from 2 nodes' in s.message for s in a.status),
                                     'report of two sources')
                states.next(10)
                self.assertTrue(all(all_finite(s) for s in states.all()))
        finally:
            other.terminate()
            other.wait()

    def test_latency_from_tf_to_markers(self):
        publisher = rospy.Publisher('/tf', TFMessage, queue_size=100)
        latencies = []
        with Messages('/idle/markers', rospy.AnyMsg):
            sent = {}
            arrived = {}
            receive = rospy.Subscriber('/idle/markers', rospy.AnyMsg, lambda m: arrived.setdefault(first_stamp(m), time.monotonic()))
            for _ in range(300):
                now = rospy.get_time()
                publisher.publish([transform('hand', now, (0.3, 0, 1))])
                sent[now] = time.monotonic()
                time.sleep(0.01)
            receive.unregister()
            for stamp, arrival in sorted(arrived.items()):
                # the first transform from which the poses at the stamp were known
                known = [t for s, t in sent.items() if s >= stamp * 1e-9]
                if known:
                    latencies.append(arrival - min(known))
        self.assertGreater(len(latencies), 100)
        latencies.sort()
        median, most = statistics.median(latencies), latencies[int(0.99 * len(latencies))]
        rospy.loginfo('tf to marker: median %.1f ms, 99 %%: %.1f ms', 1e3 * median, 1e3 * most)
        # tf_latency of 50 ms is waited for, and a tick of 20 ms; the rest is scheduling
        self.assertLess(median, 0.1)


def send_elsewhere():
    rospy.init_node('other_source')
    with Frames(hand=lambda t: (0.5, 0, 1)):
        rospy.spin()


if __name__ == '__main__':
    if '--other-source' in sys.argv:
        send_elsewhere()
    else:
        rostest.rosrun('verlet_cable', 'overload', OverloadTest, sys.argv)
