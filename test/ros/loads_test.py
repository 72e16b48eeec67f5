#!/usr/bin/env python3
"""The service apply_wrench and the topics apply/BODY: what they do to bodies and cables, how long, and what is refused."""
import math
import sys
import time
import unittest

import actionlib
import rospy
import rostest
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import Point, Vector3, Wrench, WrenchStamped
from std_msgs.msg import Header
from visualization_msgs.msg import MarkerArray

from cable_client import CableClient, Messages, contents, node_at
from verlet_cable.msg import CableEvent, RolloutAction, RolloutGoal, RolloutLoad
from verlet_cable.srv import ApplyWrench, ApplyWrenchRequest

MASS = 2.0
NAN = float('nan')


def wrench(force=(0, 0, 0), torque=(0, 0, 0)):
    return Wrench(Vector3(*force), Vector3(*torque))


def velocity(state):
    twist = state.bodies[0].twist.linear
    return twist.x, twist.y, twist.z


class LoadsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('loads_test')
        cls.node = CableClient('/cable')
        rospy.wait_for_service('/cable/apply_wrench')
        cls.service = rospy.ServiceProxy('/cable/apply_wrench', ApplyWrench)
        with cls.node.states() as states:
            states.next()

    def setUp(self):
        self.assertTrue(self.node.reset().success)

    def apply(self, on, node=0, **fields):
        return self.service(ApplyWrenchRequest(location=node_at(on, node), **fields))

    def near(self, found, expected, delta=1e-9):
        self.assertLess(math.dist(found, expected), delta, f'{found} instead of {expected}')

    def test_a_force_for_a_time_is_an_impulse(self):
        self.assertTrue(self.node.pause(True).success)
        answer = self.apply('vehicle', wrench=wrench((4, 0, 0), (0, 0, 0.5)), duration=0.1)
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.name, 'vehicle')
        with self.node.events() as events:
            self.assertTrue(self.node.step(200).success)
            event = events.wait_for(lambda e: e.type == CableEvent.LOAD_ENDED, 'end of the load')
        self.assertEqual((event.cable, event.attachment), ('vehicle', 'vehicle'))
        state = self.node.state()
        # The body's own point is its origin, where its center of mass is, too.
        self.near(velocity(state), (4 * 0.1 / MASS, 0, 0))
        self.assertAlmostEqual(state.bodies[0].twist.angular.z, 0.5 * 0.1 / 0.25, delta=1e-6)
        self.assertTrue(self.node.pause(False).success)

    def test_forces_turn_with_the_body_or_with_nothing(self):
        self.assertTrue(self.node.pause(True).success)
        for frame, expected in (('', (1, 0, 0)), ('vehicle', (0, 1, 0)), ('world', (1, 0, 0))):
            self.assertTrue(self.node.reset().success)
            answer = self.apply('vehicle', frame_id=frame, wrench=wrench((1, 0, 0)), name='thrust')
            self.assertTrue(answer.success, answer.message)
            self.assertEqual(answer.name, 'thrust')
            self.assertTrue(self.node.step(100).success)
            self.near(velocity(self.node.state()), [0.1 / MASS * x for x in expected])
        # At a point beside the center of mass it turns the body, too.
        self.apply('vehicle', point=Point(0.5, 0, 0), wrench=wrench((1, 0, 0)), name='thrust')
        self.assertTrue(self.node.step(10).success)
        self.assertGreater(abs(self.node.state().bodies[0].twist.angular.z), 1e-3)
        self.assertTrue(self.node.pause(False).success)

    def test_a_node_is_drawn_until_the_force_ends(self):
        answer = self.apply('rope', node=10, wrench=wrench((1, 0, 0)))
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(answer.name, 'rope[10]')
        with self.node.states() as states, Messages('/cable/wrench/left', WrenchStamped) as wrenches, \
                Messages('/cable/markers', MarkerArray) as markers:
            states.wait_for(lambda s: s.cables[0].positions[10].x > 0.99, 'rope that is drawn aside', 20)
            wrenches.wait_for(lambda w: abs(w.wrench.force.x - 1) < 0.05, 'force at its holder', 20)
            arrow = markers.wait_for(lambda m: any(marker.ns == 'loads' for marker in m.markers), 'arrow')
            arrow = next(marker for marker in arrow.markers if marker.ns == 'loads')
            self.assertGreater(arrow.points[1].x, arrow.points[0].x)
            self.assertTrue(self.apply('rope', node=10, wrench=wrench()).success)
            markers.clear()
            gone = markers.wait_for(lambda m: not any(marker.ns == 'loads' and marker.action == marker.ADD for marker in m.markers),
                                    'markers without the arrow')
            self.assertTrue(gone)

    def test_a_topic_holds_its_body_no_longer_than_the_timeout(self):
        publisher = rospy.Publisher('/cable/apply/vehicle', WrenchStamped, queue_size=1000)
        deadline = time.monotonic() + 5
        while publisher.get_num_connections() == 0:
            self.assertLess(time.monotonic(), deadline, 'subscription')
            time.sleep(0.01)
        with self.node.events() as events, self.node.states() as states:
            before = velocity(states.next())
            message = WrenchStamped(wrench=wrench((0, 2, 0)))
            begin = rospy.get_time()
            while rospy.get_time() < begin + 1:
                publisher.publish(message)
                time.sleep(0.002)
            ended = events.wait_for(lambda e: e.type == CableEvent.LOAD_ENDED, 'end of what the topic applied')
            self.assertEqual((ended.cable, ended.attachment), ('vehicle', 'apply/vehicle'))
            duration = rospy.get_time() - begin
            state = states.wait_for(lambda s: s.header.stamp >= ended.header.stamp, 'state after it')
            gained = velocity(state)[1] - before[1]
            # A second of it, and the timeout; no gap between the messages is longer than that.
            self.assertAlmostEqual(gained, 2 / MASS * 1.2, delta=0.1)
            self.assertLess(duration, 3)
            later = states.next(5)
            self.near(velocity(later), velocity(state))
            self.assertEqual(len([e for e in events.all() if e.type == CableEvent.LOAD_ENDED]), 1)

    def test_a_topic_may_be_in_the_axes_of_its_body(self):
        publisher = rospy.Publisher('/cable/apply/vehicle', WrenchStamped, queue_size=10)
        deadline = time.monotonic() + 5
        while publisher.get_num_connections() == 0:
            self.assertLess(time.monotonic(), deadline, 'subscription')
            time.sleep(0.01)
        with self.node.states() as states:
            for force, frame in ((NAN, 'vehicle'), (1, 'nowhere')):
                publisher.publish(WrenchStamped(header=Header(frame_id=frame), wrench=wrench((force, 0, 0))))
            self.near(velocity(states.next(5)), (0, 0, 0))
            publisher.publish(WrenchStamped(header=Header(frame_id='vehicle'), wrench=wrench((1, 0, 0))))
            # 0.2 s of 1 N along its x, which is the world's y.
            state = states.wait_for(lambda s: velocity(s)[1] > 0.0999, 'vehicle that moves')
            self.near(velocity(states.next(20)), (0, 0.2 / MASS, 0))
            self.assertTrue(state)

    def test_snapshots_keep_loads(self):
        self.assertTrue(self.node.pause(True).success)
        self.assertTrue(self.apply('vehicle', wrench=wrench((1, 0, 0)), duration=0.05).success)
        self.assertTrue(self.node.step(10).success)
        self.assertTrue(self.node.save_state(name='pushed').success)
        states = []
        for _ in range(2):
            self.assertTrue(self.node.step(100).success)
            states.append(contents(self.node.state()))
            self.assertTrue(self.node.restore_state(name='pushed').success)
        self.assertEqual(states[0], states[1])
        self.near(velocity(self.node.state()), (0.01 / MASS, 0, 0))
        self.assertTrue(self.node.reset().success)
        self.assertTrue(self.node.step(10).success)
        self.near(velocity(self.node.state()), (0, 0, 0))
        self.assertTrue(self.node.pause(False).success)

    def roll_out(self, **fields):
        client = actionlib.SimpleActionClient('/cable/rollout', RolloutAction)
        self.assertTrue(client.wait_for_server(rospy.Duration(5)))
        client.send_goal(RolloutGoal(**fields))
        self.assertTrue(client.wait_for_result(rospy.Duration(20)))
        return client.get_result()

    def test_rollouts_have_loads_of_their_own(self):
        self.assertTrue(self.node.pause(True).success)
        loads = [RolloutLoad(location=node_at('vehicle', 0), frame_id='vehicle', wrench=wrench((1, 0, 0)), start=0.1, duration=0.2),
                 RolloutLoad(location=node_at('rope', 10), wrench=wrench((1, 0, 0)), name='pull')]
        result = self.roll_out(duration=0.5, rate=10, loads=loads)
        self.assertTrue(result.success, result.message)
        speeds = [velocity(state)[1] for state in result.states]
        for found, expected in zip(speeds, (0, 0, 0.1, 0.2, 0.2, 0.2)):
            self.assertAlmostEqual(found, expected / MASS, delta=1e-9)
        self.assertGreater(result.states[-1].cables[0].positions[10].x, 0.1)
        self.near(velocity(self.node.state()), (0, 0, 0))
        result = self.roll_out(duration=0.5, rate=10, loads=[RolloutLoad(location=node_at('ship', 0), start=-1)])
        self.assertFalse(result.success)
        self.assertIn('loads[0].location.cable: "ship"', result.message)
        self.assertIn('loads[0].start: -1; allowed: 0 or more [s]', result.message)
        self.assertTrue(self.node.pause(False).success)

    def test_what_cannot_be_applied_is_refused_and_changes_nothing(self):
        self.assertTrue(self.node.pause(True).success)
        before = self.node.state()
        for request, part in (
                (dict(on='ship'), 'location.cable: "ship"; allowed: rope, vehicle'),
                (dict(on='rope', node=11), 'location.node: 11; allowed: 0 to 10'),
                (dict(on='vehicle', node=1), 'location.node: 1'),
                (dict(on='vehicle', wrench=wrench((NAN, 0, 0))), 'wrench.force: (nan, 0, 0); allowed: finite numbers [N]'),
                (dict(on='vehicle', wrench=wrench((0, 0, 0), (0, math.inf, 0))), 'wrench.torque: (0, inf, 0)'),
                (dict(on='rope', node=3, wrench=wrench((0, 0, 1), (0, 0, 1))), 'wrench.torque: (0, 0, 1) on node 3'),
                (dict(on='rope', node=3, point=Point(0, 1, 0), wrench=wrench((0, 0, 1))), 'point: (0, 1, 0) on node 3'),
                (dict(on='vehicle', point=Point(0, NAN, 0)), 'point: (0, nan, 0)'),
                (dict(on='vehicle', frame_id='nowhere'), 'frame_id: "nowhere"'),
                (dict(on='vehicle', duration=-1), 'duration: -1; allowed: 0 or more [s]'),
                (dict(on='vehicle', duration=NAN), 'duration: nan')):
            answer = self.apply(**request)
            self.assertFalse(answer.success, part)
            self.assertIn(part, answer.message)
        answer = self.service(ApplyWrenchRequest(location=node_at('vehicle', 0), name='a/b'))
        self.assertIn('name: "a/b"; allowed: at most 1000 letters', answer.message)
        self.assertTrue(self.node.step(1).success)
        self.assertEqual(self.node.state().bodies[0].twist, before.bodies[0].twist)
        self.assertTrue(self.node.pause(False).success)

    def test_diagnostics_list_what_acts(self):
        self.assertTrue(self.apply('rope', node=10, wrench=wrench((0, 0, 0.1))).success)
        with Messages('/diagnostics', DiagnosticArray) as messages:
            def lists(array):
                return any(value.key == 'loads' and value.value == 'rope[10]' for status in array.status for value in status.values)
            messages.wait_for(lists, 'list of loads')


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'loads', LoadsTest, sys.argv)
