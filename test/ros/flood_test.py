#!/usr/bin/env python3
"""Thousands of bad requests and messages a second: all answered, nothing changed, states still come, memory stays."""
import subprocess
import sys
import time
import unittest

import actionlib
import rospy
import rostest
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerUpdate, Marker, MarkerArray

from cable_client import CableClient, Messages, process_of
from verlet_cable.msg import CableArray, RolloutAction, RolloutGoal
from verlet_cable.srv import Cut, CutRequest, Pin, PinRequest, Unpin, UnpinRequest

FLOODS = 2
SECONDS = 5
GIVEN_BACK = 12  # [s] what was freed is given back every 5 s, and actionlib forgets results after 5 s
NAN = float('nan')


def flood():
    """Calls over connections that stay open; prints the number of answers."""
    rospy.init_node('flood', anonymous=True)
    services = [(rospy.ServiceProxy(f'/cable/{name}', kind, persistent=True), request) for name, kind, request in
                (('unpin', Unpin, UnpinRequest('nobody')), ('pin', Pin, PinRequest()), ('cut', Cut, CutRequest()))]
    obstacles = rospy.Publisher('/cable/obstacles', MarkerArray, queue_size=1000)
    bad = Marker(ns='bad', type=Marker.SPHERE)
    bad.pose.position.x = NAN
    answers = 0
    end = time.monotonic() + SECONDS
    while time.monotonic() < end:
        for call, request in services:
            if call(request).success:
                raise AssertionError(f'{call.resolved_name} did what it was not asked for')
            answers += 1
        bad.id = answers
        obstacles.publish([bad])
    print(answers, flush=True)


def memory_of(node):
    """Resident, in MB."""
    with open(f'/proc/{process_of(node)}/status') as status:
        return next(int(line.split()[1]) / 1e3 for line in status if line.startswith('VmRSS'))


class FloodTest(unittest.TestCase):
    def flood(self):
        floods = [subprocess.Popen([sys.executable, __file__, '--flood'], stdout=subprocess.PIPE, text=True) for _ in range(FLOODS)]
        outputs = [process.communicate(timeout=60)[0] for process in floods]
        for process in floods:
            self.assertEqual(process.returncode, 0)
        return sum(int(output) for output in outputs)

    def test_a_flood_changes_nothing(self):
        node = CableClient('/cable')
        with Messages('/cable/state', CableArray) as states:
            states.next(5)
            self.flood()  # whatever is allocated once
            before = memory_of('/cable')
            states.clear()
            begin = time.monotonic()
            answers = self.flood()
            elapsed = time.monotonic() - begin
            seen = states.all()
            grown = memory_of('/cable') - before
            last = states.next()
        rospy.loginfo('%d requests a second refused, %.1f states a second meanwhile, %.1f MB more', answers / SECONDS,
                      len(seen) / elapsed, grown)
        self.assertGreater(answers / SECONDS, 1000)
        self.assertGreater(len(seen) / elapsed, 25)
        self.assertLess(grown, 5)
        self.assertEqual([c.name for c in last.cables], ['rope'])
        self.assertEqual(len(last.cables[0].positions), 51)
        self.assertTrue(node.unpin('left').success, 'what is asked for properly is still done')

    def test_what_a_large_rollout_takes_is_given_back(self):
        node, actions = CableClient('/cable'), actionlib.SimpleActionClient('/cable/rollout', RolloutAction)
        self.assertTrue(actions.wait_for_server(rospy.Duration(5)))

        def roll_out(segments):
            answer = node.load_scene(yaml=f'{{cables: [{{name: rope, length: 1.0, segments: {segments}, material: rope}}], '
                                          'materials: {rope: {linear_density: 0.1, radius: 0.005}}}')
            self.assertTrue(answer.success, answer.message)
            for _ in range(5):  # on each of its threads
                actions.send_goal_and_wait(RolloutGoal(duration=0.002, rate=500), rospy.Duration(30))
                self.assertTrue(actions.get_result().success)
            return memory_of('/cable')

        def memory_after_a_while():
            time.sleep(GIVEN_BACK)
            return memory_of('/cable')

        roll_out(50)
        before = memory_after_a_while()
        during = roll_out(10000)
        roll_out(50)
        after = memory_after_a_while()
        rospy.loginfo('%.1f MB before, %.1f MB with 10000 segments, %.1f MB after', before, during, after)
        self.assertGreater(during - before, 20)
        self.assertLess(after - before, 10)

    def test_the_endless_name_of_a_client_is_not_kept(self):
        self.assertTrue(CableClient('/cable').reset().success)
        with Messages('/cable/hands/update', InteractiveMarkerUpdate) as shown:
            handle = shown.wait_for(lambda update: update.markers, 'handles').markers[0].name
            mouse = rospy.Publisher('/cable/hands/feedback', InteractiveMarkerFeedback, queue_size=1)
            while mouse.get_num_connections() == 0:
                time.sleep(0.01)
            before = memory_of('/cable')
            mouse.publish(InteractiveMarkerFeedback(client_id='x' * 40_000_000, marker_name=handle,
                                                    event_type=InteractiveMarkerFeedback.MOUSE_DOWN))
            time.sleep(GIVEN_BACK)
            self.assertLess(memory_of('/cable') - before, 20)


if __name__ == '__main__':
    if '--flood' in sys.argv:
        flood()
    else:
        rospy.init_node('flood_test')
        rostest.rosrun('verlet_cable', 'flood_requests', FloodTest, sys.argv)
