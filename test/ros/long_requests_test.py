#!/usr/bin/env python3
"""While a request takes long the others are answered, and each ends as it says."""
import contextlib
import signal
import subprocess
import sys
import threading
import time
import unittest

import rospy
import rostest
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

from cable_client import CableClient, Messages, cable, node_at, transform
from verlet_cable.msg import CableEvent
from verlet_cable.srv import Unpin

ROPE = 'materials: {rope: {linear_density: 0.1, radius: 0.005, drag: 0.2, bending_stiffness: 1.0e-3}}\n'


def rope(name, segments, frame='world'):
    return (f'  - {{name: {name}, length: 1.0, segments: {segments}, material: rope, attachments: [{{name: a_{name}, at: start, '
            f'frame: {frame}, type: clamp}}]}}\n')


# Takes seconds to build, as it starts in equilibrium.
SLOW = (ROPE.replace('1.0e-3', '1.0') + 'cables:\n' +
        rope('slow', 30000).replace('material: rope', 'material: rope, initial: {type: settled}'))


class Aside:
    """A call in a thread of its own."""

    def __init__(self, call, *arguments, **named):
        self.answer = None
        self._thread = threading.Thread(target=lambda: setattr(self, 'answer', call(*arguments, **named)), daemon=True)
        self._thread.start()

    def runs(self):
        return self._thread.is_alive()

    def result(self):
        self._thread.join(60)
        return self.answer


class LongRequestsTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        rospy.init_node('long_requests_test')
        cls.node = CableClient('/cable')
        cls.node.state()
        # Over a connection that stays open: otherwise the master is asked each time, which many new topics keep busy.
        cls.unpin = rospy.ServiceProxy('/cable/unpin', Unpin, persistent=True)

    def setUp(self):
        self.node.pause(False)
        self.assertTrue(self.node.load_scene(yaml=ROPE + 'cables:\n' + rope('rope', 50)).success)

    def slowest(self, request, during, what):
        """Of the answers to a request that is repeated, 100 times a second, as long as another runs; as a part of that time."""
        slowest, count = 0, 0
        start = time.monotonic()
        while during.runs():
            begin = time.monotonic()
            request()
            slowest = max(slowest, time.monotonic() - begin)
            count += 1
            time.sleep(0.01)
        took = time.monotonic() - start
        rospy.loginfo('%s: %.1f s, %d requests meanwhile, slowest answer %.0f ms', what, took, count, 1e3 * slowest)
        self.assertGreater(count, 3)
        return slowest / took

    def test_steps_let_others_through(self):
        self.assertTrue(self.node.pause(True).success)
        before = self.node.state().header.stamp.to_sec()
        steps = Aside(self.node.step, 30000)
        # however busy the machine is
        self.assertLess(self.slowest(lambda: self.unpin('nothing'), steps, 'step of 30000'), 0.3)
        answer = steps.result()
        self.assertTrue(answer.success, answer.message)
        self.assertAlmostEqual(answer.time, before + 30, places=6)
        self.assertAlmostEqual(self.node.state().header.stamp.to_sec(), answer.time, places=6)

    def test_edits_are_applied_between_steps_and_steps_go_on(self):
        self.node.pause(True)
        steps = Aside(self.node.step, 20000)
        time.sleep(0.02)
        pinned = self.node.pin(node_at('rope', 50), name='tip', keep_offset=True)
        self.assertTrue(pinned.success, pinned.message)
        self.assertTrue(steps.runs())
        self.assertTrue(steps.result().success)
        self.assertIn('tip', cable(self.node.state(), 'rope').attachments)

    def test_what_interrupts_steps_says_so(self):
        other = ROPE + 'cables:\n' + rope('other', 20)
        for interrupt, reason in ((self.node.reset, 'reset'), (lambda: self.node.pause(False), 'the pause has ended'),
                                  (lambda: self.node.load_scene(yaml=other), 'the scene is replaced')):
            self.node.pause(True)
            steps = Aside(self.node.step, 10**6)
            second = Aside(self.node.step, 10)
            time.sleep(0.3)
            self.assertTrue(steps.runs() or second.runs())
            answer = interrupt()
            self.assertTrue(answer.success, answer.message)
            answers = [steps.result(), second.result()]
            interrupted = next(a for a in answers if 'interrupted' in a.message)
            self.assertFalse(interrupted.success)
            self.assertIn(reason, interrupted.message)
            self.assertIn('of 1000000 steps', interrupted.message)

    def test_scenes_are_read_and_built_aside(self):
        names = [f'r{i}' for i in range(1500)]
        text = ROPE + 'cables:\n' + ''.join(rope(name, 10) for name in names)
        self.assertLess(len(text), 2**20)
        loading = Aside(self.node.load_scene, yaml=text)
        # not reset, which the last time is that of the new scene
        self.assertLess(self.slowest(lambda: self.unpin('nothing'), loading, f'load_scene of {len(text)} bytes'), 0.5)
        answer = loading.result()
        self.assertTrue(answer.success, answer.message)
        self.assertEqual(len(self.node.state().cables), len(names))

    def test_a_reset_that_is_overtaken_is_not_waited_for(self):
        text = ROPE + 'cables:\n' + ''.join(rope(f'r{i}', 400) for i in range(60))
        self.assertTrue(self.node.load_scene(yaml=text).success)
        self.node.pause(True)
        self.node.save_state(name='there')
        begin = time.monotonic()
        self.assertTrue(self.node.reset().success)
        took = time.monotonic() - begin
        answer = None
        for _ in range(20):  # the reset may come too late, or be done already
            resetting = Aside(self.node.reset)
            time.sleep(took / 10)
            begin = time.monotonic()
            self.assertTrue(self.node.restore_state(name='there').success)
            restored = time.monotonic() - begin
            answer = resetting.result()
            self.assertTrue(answer.success)
            if 'restored the snapshot "there" since' in answer.message:
                break
        self.assertIn('restored the snapshot "there" since', answer.message)
        rospy.loginfo('a reset takes %.0f ms, a state that is restored meanwhile %.0f ms', 1e3 * took, 1e3 * restored)
        self.assertLess(restored, took / 2)

    def test_resets_that_come_together_are_one(self):
        self.assertTrue(self.node.load_scene(yaml=SLOW.replace('30000', '15000')).success)
        with Messages('/cable/events', CableEvent) as events:
            resets = [Aside(self.node.reset) for _ in range(4)]
            self.assertTrue(all(reset.result().success for reset in resets))
            events.wait_for(lambda event: event.type == CableEvent.RESET, 'RESET')
            # the last may have come when the first was done
            self.assertLessEqual(len([event for event in events.all() if event.type == CableEvent.RESET]), 2)

    # Runs last: its steps are ahead of the clock, and nothing is published until that has caught up.
    def test_wrong_steps_are_refused_while_others_are_done(self):
        self.node.pause(True)
        steps = Aside(self.node.step, 10**6)
        time.sleep(0.3)
        answer = self.node.step(0)
        self.assertIn('allowed: 1 to', answer.message)
        self.assertTrue(steps.runs())
        self.node.pause(False)
        self.assertIn('interrupted', steps.result().message)

    def test_a_bad_scene_changes_nothing(self):
        loading = Aside(self.node.load_scene, yaml=ROPE + 'cables:\n' + rope('rope', 50).replace('1.0', '-1.0') * 3000)
        self.slowest(self.node.reset, loading, 'bad scene')
        answer = loading.result()
        self.assertFalse(answer.success)
        self.assertIn('cables[0].length', answer.message)
        self.assertEqual([c.name for c in self.node.state().cables], ['rope'])

    def test_a_bad_scene_does_not_wait_for_another_one(self):
        loading = Aside(self.node.load_scene, yaml=SLOW)
        time.sleep(0.5)
        answer = self.node.load_scene(yaml='5')
        self.assertFalse(answer.success)
        self.assertTrue(loading.runs(), answer.message)

    def test_a_scene_does_not_wait_for_those_that_it_replaces(self):
        loading = [Aside(self.node.load_scene, yaml=SLOW) for _ in range(2)]
        time.sleep(0.5)
        self.assertTrue(all(each.runs() for each in loading))
        self.assertTrue(self.node.load_scene(yaml=ROPE + 'cables:\n' + rope('second', 20)).success)
        for each in loading:
            answer = each.result()
            self.assertTrue(answer.success, answer.message)
            self.assertIn('loaded, and the scene is replaced by one of 1 cables since', answer.message)
        self.assertEqual([c.name for c in self.node.state().cables], ['second'])

    def test_pins_share_the_limit_of_frames(self):
        static = rospy.Publisher('/tf_static', TFMessage, queue_size=10, latch=True)
        static.publish([transform(f'peg{i}', 1, (0, 0, 0)) for i in range(2100)])
        obstacles = rospy.Publisher('/cable/obstacles', MarkerArray, queue_size=10)
        with Messages('/cable/markers', MarkerArray) as shown:
            for first in (0, 900):
                spheres = [Marker(ns='ball', id=i, type=Marker.SPHERE) for i in range(900)]
                for i, sphere in enumerate(spheres):
                    sphere.header.frame_id = f'peg{first + i}'
                    sphere.scale.x = sphere.scale.y = sphere.scale.z = 0.01
                    sphere.pose.position.z = 5
                while obstacles.get_num_connections() == 0:
                    time.sleep(0.01)
                obstacles.publish(spheres)
                shown.wait_for(lambda m: len(m.markers) > 900, 'obstacles', 20)
                obstacles.publish([Marker(action=Marker.DELETEALL)])
                shown.clear()
                shown.wait_for(lambda m: len(m.markers) < 900, 'their end', 20)
                shown.clear()
        pinned, refusal = 1800, None
        while refusal is None and pinned < 2100:
            answer = self.node.pin(node_at('rope', 25), name='peg', frame_id=f'peg{pinned}', keep_offset=True)
            if answer.success:
                pinned += 1
                self.assertTrue(self.node.unpin('peg').success)
            elif 'used' in answer.message:
                refusal = answer.message
        self.assertIn('frame_id: "peg1999"; allowed: one of the 2000', refusal)
        self.assertEqual(pinned, 1999)  # and the fixed frame
        self.assertTrue(self.node.reset().success)
        self.assertTrue(self.node.pin(node_at('rope', 25), name='peg', frame_id='peg2000', keep_offset=True).success)

    def test_the_node_ends_in_the_middle(self):
        process = subprocess.Popen(['rosrun', 'verlet_cable', 'cable_node', '__name:=victim'])
        try:
            victim = CableClient('/victim')
            victim.state()
            victim.pause(True)

            def call(service, *arguments):
                try:
                    return service(*arguments)
                except rospy.ServiceException as error:
                    return error

            steps = [Aside(call, victim.step, 10**6) for _ in range(3)]
            time.sleep(0.5)
            self.assertTrue(all(s.runs() for s in steps))
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(20), 0)
            for s in steps:
                self.assertFalse(getattr(s.result(), 'success', False))
        finally:
            process.kill()
            process.wait()

    def test_a_node_that_builds_a_scene_ends_at_once(self):
        process = subprocess.Popen(['rosrun', 'verlet_cable', 'cable_node', '__name:=victim'])
        try:
            victim = CableClient('/victim')
            victim.state()

            def load():
                with contextlib.suppress(rospy.ServiceException):
                    victim.load_scene(yaml=SLOW.replace('30000', '90000'))

            loading = Aside(load)
            time.sleep(2)
            self.assertTrue(loading.runs())
            begin = time.monotonic()
            process.send_signal(signal.SIGINT)
            self.assertEqual(process.wait(20), 0)
            rospy.loginfo('a node that builds a scene ended in %.1f s', time.monotonic() - begin)
        finally:
            process.kill()
            process.wait()


if __name__ == '__main__':
    rostest.rosrun('verlet_cable', 'long_requests', LongRequestsTest, sys.argv)
