#!/usr/bin/env python3
"""Whatever times and values tf, the clock, actions and handles say, the node answers, stays finite and goes on with good ones."""
import sys
import time
import unittest

import rospy
import rostest
from actionlib_msgs.msg import GoalID
from geometry_msgs.msg import TransformStamped
from rosgraph_msgs.msg import Clock, Log
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerUpdate, Marker, MarkerArray

from cable_client import CableClient, Messages, all_finite, cable, distance, node_at, transform
from verlet_cable.msg import RolloutActionGoal, RolloutActionResult

LAST = 2**32 - 1
TIMES = [(0, 0), (0, 1), (1, 10**9), (2**31 - 1, 999999999), (2**31, 0), (LAST - 60, 0), (LAST - 59, 0), (LAST, 0),
         (LAST, 999999999), (LAST, LAST), (100, LAST)]
NAN, INF = float('nan'), float('inf')


def stamp(secs, nsecs):
    """As it stands, also where a message from ROS would never say so."""
    result = rospy.Time()
    result.secs, result.nsecs = secs, nsecs
    return result


def stamped(frame, at, parent='world', position=(0, 0, 0), rotation=(0, 0, 0, 1)):
    message = transform(frame, 0, position, rotation, parent)
    message.header.stamp = stamp(*at)
    return message


class StampsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.tf = rospy.Publisher('/tf', TFMessage, queue_size=1000)
        cls.static = rospy.Publisher('/tf_static', TFMessage, queue_size=1000)
        cls.clock = rospy.Publisher('/clock', Clock, queue_size=1000)
        cls.node = CableClient('/cable')
        deadline = time.monotonic() + 5
        while 0 in (p.get_num_connections() for p in (cls.tf, cls.static, cls.clock)) and time.monotonic() < deadline:
            time.sleep(0.01)

    def goes_on(self, start):
        """Runs for two seconds of ROS time from `start` on, and expects what a healthy node shows, also when the hand was lost before and
        is approached."""
        with self.node.states() as states:
            for i in range(200):
                t = start + 0.01 * i
                self.tf.publish([transform('hand', t, (0.1, 0.2, 1))])
                self.clock.publish(rospy.Time.from_sec(t))
                time.sleep(0.005)
            state = states.wait_for(lambda s: start + 1.5 < s.header.stamp.to_sec() < start + 2 and cable(s, 'rope'), 'rope')
            self.assertTrue(all(all_finite(s) for s in states.all()))
            self.assertLess(distance(cable(state, 'rope').positions[0], (0.1, 0.2, 1)), 1e-9)
        answer = self.node.reset()
        self.assertTrue(answer.success, answer.message)

    def answers(self):
        begin = time.monotonic()
        self.node.reset()
        self.node.unpin('nothing')
        self.assertLess(time.monotonic() - begin, 2)

    def test_transforms_at_the_ends_of_time(self):
        self.goes_on(1000)
        for at in TIMES:
            for publisher in (self.tf, self.static):
                publisher.publish([stamped('hand' if publisher is self.tf else 'pole', at), stamped('other', at, 'hand')])
            self.answers()
        self.goes_on(1002)

    def test_transforms_that_are_none(self):
        self.goes_on(2000)
        for frame, parent in (('', 'world'), ('hand', ''), ('hand', 'hand'), ('/', '/'), ('/hand', 'world'), ('a', 'b'), ('b', 'c'),
                              ('c', 'a'), ('x' * 10**6, 'world'), ('hand', 'y' * 10**6), ('h\0and', 'wo\nrld')):
            self.tf.publish([stamped(frame, (2002, 0), parent)])
        for bad in (NAN, INF, 1e308):
            self.tf.publish([stamped('hand', (2002, 1), position=(bad, 0, 0)), stamped('hand', (2002, 2), rotation=(0, 0, 0, bad))])
        self.tf.publish([stamped('hand', (2002, 3), rotation=(0, 0, 0, 0))])
        self.tf.publish([TransformStamped()] * 10000)
        self.tf.publish([stamped(f'f{i}', (2002, 0), f'p{i}') for i in range(12000)])
        self.answers()
        # a second parent holds from its stamp on, and the first again
        self.goes_on(2100)

    def test_frames_that_are_too_far_away_stay_and_are_named(self):
        self.goes_on(2500)
        with Messages('/rosout', Log) as log, self.node.states() as states:
            for i in range(50):
                t = (2502, 10**7 * i)
                # each is allowed, but not their sum
                self.tf.publish([stamped('arm', t, position=(9e8, 0, 0)), stamped('hand', t, 'arm', position=(9e8, 0, 0))])
                self.clock.publish(stamp(*t))
                time.sleep(0.01)
            warning = log.wait_for(lambda m: 'is not followed there' in m.msg, 'warning')
            self.assertIn('frame "hand" is at (1.8e+09, 0, 0)', warning.msg)
            self.assertIn('allowed: finite numbers [m] (from -1e+09 to 1e+09)', warning.msg)
            state = states.wait_for(lambda s: s.header.stamp.to_sec() > 2502.2, 'state')
            self.assertLess(distance(cable(state, 'rope').positions[0], (0.1, 0.2, 1)), 1e-9)
        self.assertEqual(len([m for m in log.all() if 'is not followed there' in m.msg]), 1)
        self.goes_on(2600)

    def test_the_clock_at_the_ends_of_time_and_back(self):
        viewer = rospy.Subscriber('/cable/hands/update', InteractiveMarkerUpdate, lambda _: None)
        self.goes_on(3000)
        for at in TIMES:
            for clock in ((3002, 0), at, at, (at[0], at[1] // 2)):
                self.clock.publish(stamp(*clock))
                self.tf.publish([stamped('hand', clock)])
                time.sleep(0.05)
                self.answers()
            self.node.pause(True)
            self.node.step(10)
            self.node.save_state(name='there')
            self.node.restore_state(name='there')
            self.node.pause(False)
        viewer.unregister()
        self.goes_on(3100)

    def test_goals_and_cancels_with_absurd_stamps(self):
        self.goes_on(4000)
        goals = rospy.Publisher('/cable/rollout/goal', RolloutActionGoal, queue_size=100)
        cancels = rospy.Publisher('/cable/rollout/cancel', GoalID, queue_size=100)
        with Messages('/cable/rollout/result', RolloutActionResult) as results:
            time.sleep(0.3)
            for number, at in enumerate(TIMES):
                cancels.publish(GoalID(stamp=stamp(*at), id=''))
                cancels.publish(GoalID(stamp=stamp(*at), id=f'nobody{number}'))
                for duration, rate, motion in ((NAN, 1, []), (1, INF, []), (1e300, 1e-300, []), (-1, 10, []), (1e9, 1e9, []),
                                               (0.05, 100, [stamped('hand', at), stamped('hand', at, position=(NAN, 0, 0))])):
                    goal = RolloutActionGoal()
                    goal.goal_id.id = f'bad{number}{duration}{rate}'
                    goal.goal_id.stamp = stamp(*at)
                    goal.goal.duration, goal.goal.rate, goal.goal.motion = duration, rate, motion
                    goals.publish(goal)
                self.answers()
            good = RolloutActionGoal()
            good.goal_id.id = 'good'
            good.goal_id.stamp = rospy.Time(4001)
            good.goal.duration, good.goal.rate = 0.05, 100
            goals.publish(good)
            result = results.wait_for(lambda r: r.status.goal_id.id == 'good', 'result')
            self.assertTrue(result.result.success, result.result.message)
        self.goes_on(4002)

    def test_handles_obstacles_and_numbers(self):
        self.goes_on(5000)
        feedback = rospy.Publisher('/cable/hands/feedback', InteractiveMarkerFeedback, queue_size=100)
        obstacles = rospy.Publisher('/cable/obstacles', MarkerArray, queue_size=100)
        viewer = rospy.Subscriber('/cable/hands/update', InteractiveMarkerUpdate, lambda _: None)
        time.sleep(0.5)
        for bad in (NAN, INF, 1e308, -1):
            message = InteractiveMarkerFeedback(marker_name='rope/5', event_type=InteractiveMarkerFeedback.POSE_UPDATE, client_id='me')
            message.pose.position.x = bad
            message.header.stamp = stamp(LAST, LAST)
            feedback.publish(message)
            marker = Marker(ns='bad', type=Marker.SPHERE)
            marker.header.stamp = stamp(LAST, LAST)
            marker.header.frame_id = 'world'
            marker.lifetime = rospy.Duration(-2**31, 0)
            marker.pose.position.x = marker.scale.x = bad
            obstacles.publish([marker])
            self.assertFalse(self.node.set_length('rope', False, bad, 0.1, 0).success)
            self.assertFalse(self.node.set_length('rope', False, 1.0, NAN, 0).success)
            if bad != -1:
                self.assertFalse(self.node.pin(node_at('rope', 3), position=(bad, 0, 0)).success)
        self.assertFalse(self.node.pin(node_at('rope', 3), name='n' * 10**6).success)
        self.assertFalse(self.node.unpin('n' * 10**6).success)
        self.assertFalse(self.node.step(4 * 10**9).success)
        viewer.unregister()
        self.goes_on(5002)


if __name__ == '__main__':
    rospy.init_node('stamps_test', disable_rostime=True)
    rostest.rosrun('verlet_cable', 'stamps', StampsTest, sys.argv)
