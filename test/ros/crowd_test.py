#!/usr/bin/env python3
"""A hundred cables of 50 segments on a moving hand: what is published stays light, even and in time, on whatever machine."""
import math
import statistics
import sys
import time
import unittest

import rospy
import rostest
import yaml
from diagnostic_msgs.msg import DiagnosticArray
from visualization_msgs.msg import MarkerArray

from cable_client import CableClient, Frames, Messages, Processor

CABLES, SEGMENTS = 100, 50
SECONDS = 5


def scene():
    def held(name, at, offset, **frame):
        return {'name': name, 'at': at, 'offset': offset, **frame}

    cables = []
    for i in range(CABLES):
        x, y = 0.3 * (i % 10), 1.2 * (i // 10)
        cables.append({'name': f'rope{i}', 'length': 1.0, 'segments': SEGMENTS, 'material': 'rope', 'attachments': [
            held(f'left{i}', 'start', [x, y, 1]), held(f'right{i}', 'end', [x, y + 0.6, 1], frame='hand')]})
    rope = {'linear_density': 0.1, 'radius': 0.005, 'drag': 0.1, 'bending_stiffness': 1e-3}
    return yaml.safe_dump({'materials': {'rope': rope}, 'cables': cables})


def hand(t):
    return 0.1 * math.sin(2 * t), 0, 0


class CrowdTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('crowd_test')
        cls.node = CableClient('/crowd')

    def test_markers_of_a_crowd(self):
        with Frames(hand=hand), Messages('/crowd/markers', rospy.AnyMsg) as markers, \
                Messages('/diagnostics', DiagnosticArray) as diagnostics:
            answer = self.node.load_scene(yaml=scene())
            self.assertTrue(answer.success, answer.message)
            rospy.sleep(6)  # until it is as late as it gets
            markers.clear()
            diagnostics.clear()
            processor = Processor('/crowd')
            begin = time.monotonic()
            answers = []
            while time.monotonic() < begin + SECONDS:
                asked = time.monotonic()
                self.node.unpin('nothing')
                answers.append(time.monotonic() - asked)
                rospy.sleep(0.05)
            raw = markers.all()
            now = rospy.get_time()
            share = processor.share()
            reports = [{value.key: float(value.value) for value in status.values if value.key in ('real_time_factor', 'dropped_time_s')}
                       for array in diagnostics.all() for status in array.status if status.name == 'crowd: simulation']
        rate = len(raw) / SECONDS
        messages = [MarkerArray().deserialize(m._buff) for m in (raw[0], raw[-1])]
        first, last = (m.markers[0].header.stamp.to_sec() for m in messages)
        rospy.loginfo('markers of %d cables: %.1f Hz of %.3f MB, %.2f s late; services answer in %.1f ms; processor %.0f %% of the time',
                      CABLES, rate, 1e-6 * len(raw[-1]._buff), now - last, 1e3 * statistics.median(answers), 100 * share)
        if reports:
            rospy.loginfo('steps at %.1f times real time; %.2f s dropped', statistics.median(r['real_time_factor'] for r in reports),
                          reports[-1]['dropped_time_s'] - reports[0]['dropped_time_s'])
        self.assertGreater(rate, 20 * share)
        # After a jump of the hand, which a busy machine makes, bends take more corners for a while.
        self.assertLess(statistics.median(len(m._buff) for m in raw), 0.25e6)
        self.assertAlmostEqual(last - first, SECONDS, delta=1)
        self.assertLess(now - last, 3)
        self.assertLess(statistics.median(answers) * share, 0.05)
        shapes = {m.ns: m for m in messages[1].markers if m.ns.startswith('rope')}
        self.assertEqual(len(shapes), CABLES)
        for i in range(CABLES):
            points = shapes[f'rope{i}'].points
            self.assertTrue(all(math.isfinite(v) for p in points for v in (p.x, p.y, p.z)))
            x, y, z = hand(last)
            x, y, z = x + 0.3 * (i % 10), y + 1.2 * (i // 10) + 0.6, z + 1
            # a tube ends a radius beyond the node
            self.assertLess(min(math.dist((p.x, p.y, p.z), (x, y, z)) for p in points), 0.006)


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'crowd', CrowdTest, sys.argv)
