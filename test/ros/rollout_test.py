#!/usr/bin/env python3
"""Rollouts: many at once beside the live cable, which they never touch; cancelled and refused ones."""
import sys
import time
import unittest

import actionlib
import rospy
import rostest
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

from cable_client import CableClient, Messages, cable, contents, distance, transform
from verlet_cable.msg import RolloutAction, RolloutGoal

NAN = float('nan')


def hand(*rows):
    return [transform('hand', t, position) for t, position in rows]


class RolloutTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('rollout_test')
        cls.node = CableClient('/cable')
        with cls.node.states() as states:
            states.next()
        cls.actions = actionlib.ActionClient('/cable/rollout', RolloutAction)
        assert cls.actions.wait_for_server(rospy.Duration(5))

    def finish(self, goal):
        deadline = time.monotonic() + 30
        while goal.get_comm_state() != actionlib.CommState.DONE:
            self.assertLess(time.monotonic(), deadline, 'rollout that ends')
            time.sleep(0.01)
        return goal.get_terminal_state(), goal.get_result()

    def roll_out(self, **fields):
        return self.finish(self.actions.send_goal(RolloutGoal(**fields)))

    def test_a_rollout_follows_its_motion_and_is_the_same_every_time(self):
        self.assertTrue(self.node.save_state(name='here').success)
        goal = dict(snapshot='here', motion=hand((0, (0.6, 0, 0)), (1, (0.6, 0.2, 0.1))), duration=1.5, rate=20)
        state, result = self.roll_out(**goal)
        self.assertEqual(state, GoalStatus.SUCCEEDED, result.message)
        self.assertTrue(result.success)
        self.assertEqual([round(s.header.stamp.to_sec() * 20) for s in result.states], list(range(31)))
        self.assertLess(distance(cable(result.states[0], 'rope').positions[100], (0.6, 0, 0)), 1e-9)
        self.assertLess(distance(cable(result.states[30], 'rope').positions[100], (0.6, 0.2, 0.1)), 1e-9)
        self.assertEqual(self.roll_out(**goal)[1], result)

    def test_eight_at_once_leave_the_live_cable_its_rate(self):
        with self.node.states() as states:
            states.next(5)
            states.clear()
            begin = time.monotonic()
            progress = []
            goals = [self.actions.send_goal(RolloutGoal(duration=5, rate=10), feedback_cb=lambda _, f: progress.append(f.progress))
                     for _ in range(8)]
            took = []
            for goal in goals:
                state, result = self.finish(goal)
                self.assertEqual(state, GoalStatus.SUCCEEDED)
                self.assertEqual(len(result.states), 51)
                took.append(time.monotonic() - begin)
            states.next(5)
            stamps = [s.header.stamp.to_nsec() for s in states.all()]
            gaps = {later - earlier for earlier, later in zip(stamps, stamps[1:])}
            rospy.loginfo('8 rollouts of 5 s took %.2f s, %.2f s each; %d live states', took[-1], took[-1] / 8, len(stamps))
            self.assertEqual(gaps, {20000000}, 'every tick of 50 Hz is there')
        self.assertTrue(progress)
        self.assertTrue(all(0 < p <= 1 for p in progress))

    def test_a_cancelled_one_ends(self):
        goal = self.actions.send_goal(RolloutGoal(duration=1000, rate=1))
        while goal.get_comm_state() != actionlib.CommState.ACTIVE:
            time.sleep(0.01)
        goal.cancel()
        state, result = self.finish(goal)
        self.assertEqual(state, GoalStatus.PREEMPTED)
        self.assertFalse(result.success)
        self.assertIn('cancelled', result.message)

    def test_a_cancel_of_what_is_no_goal_is_forgotten(self):
        def is_listed(status):
            return 'nobody' in [goal.goal_id.id for goal in status.status_list]
        cancels = rospy.Publisher('/cable/rollout/cancel', GoalID, queue_size=1, latch=True)
        with Messages('/cable/rollout/status', GoalStatusArray) as status:
            cancels.publish(GoalID(id='nobody'))
            status.wait_for(is_listed, 'cancel')
            status.clear()
            status.wait_for(lambda message: not is_listed(message), 'status without it', 30)

    def test_bad_goals_are_refused_and_change_nothing(self):
        self.assertTrue(self.node.pause(True).success)
        self.addCleanup(self.node.pause, False)
        before = self.node.state()
        good = dict(duration=1, rate=10)
        for fields, part in ((dict(duration=NAN, rate=1), 'duration: nan'), (dict(duration=-1, rate=1), 'duration: -1'),
                             (dict(duration=float('inf'), rate=1), 'duration: inf'), (dict(duration=1, rate=0), 'rate: 0'),
                             (dict(duration=1, rate=1e6), 'rate: 1e+06'), (dict(duration=3600, rate=1000), 'nodes'),
                             (dict(good, snapshot='none'), 'snapshot: "none"'), (dict(good, snapshot='x' * 10_000_000), 'snapshot'),
                             (dict(good, motion=[transform('nowhere', 0)]), 'child_frame_id: "nowhere"'),
                             (dict(good, motion=[transform('nowhere', 0)] * 200001), 'motion: 200001 transforms'),
                             (dict(good, motion=[transform('hand', 0, parent='hand')]), 'header.frame_id: "hand"'),
                             (dict(good, motion=hand((0, (NAN, 0, 0)))), 'motion[0]: translation'),
                             (dict(good, motion=[transform('hand', 0, rotation=(0, 0, 0, 0))]), 'rotation'),
                             (dict(good, motion=hand((1, (0.6, 0, 0)), (1, (0.5, 0, 0)))), 'motion[1].header.stamp')):
            state, result = self.roll_out(**fields)
            self.assertEqual(state, GoalStatus.REJECTED, fields.keys())
            self.assertFalse(result.success)
            self.assertIn(part, result.message)
            self.assertLess(len(result.message), 5000)
        many = [self.actions.send_goal(RolloutGoal(duration=1000, rate=1)) for _ in range(9)]
        state, result = self.finish(many[8])
        self.assertEqual(state, GoalStatus.REJECTED)
        self.assertIn('limits.rollouts: 8', result.message)
        state, result = self.roll_out(duration=NAN, motion=[transform('nowhere', 0)])
        self.assertIn('limits.rollouts: 8', result.message)  # it is not even read
        for goal in many[:8]:
            goal.cancel()
            self.finish(goal)
        self.assertEqual(contents(self.node.state()), contents(before))


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'rollout', RolloutTest, sys.argv)
