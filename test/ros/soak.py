#!/usr/bin/env python3
"""Random valid and invalid calls, frames that fail and a clock that jumps, for minutes: no death, no NaN, no growing memory.

Usage, with a master that has use_sim_time set, beside a node /cable of soak.yaml's scene:
  soak.py [--minutes M] [--seed N] [--pid PID of the node]
Ends with a line of counts, and exit status 1 if something was found. scripts/soak runs it with sanitizers.
"""
import argparse
import math
import random
import sys
import threading
import time

import actionlib
import rospy
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerFeedback, InteractiveMarkerUpdate, Marker, MarkerArray

from cable_client import CableClient, all_finite, arc_length_at, nearest_to, node_at, transform
from verlet_cable.msg import CableArray, RolloutAction, RolloutGoal

NUMBERS = [0, 1, -1, 0.3, 0.7, 1e-9, 1e9, 1e300, float('nan'), float('inf'), -float('inf')]
WORDS = ['', 'rope', 'line', 'rope_2', 'line_2', 'flag', 'figure', 'ball', 'upper', 'hand', 'left', 'right', 'pin1', 'world', 'nowhere', 'a b', '/hand', 'x' * 100000]
SCENES = ['', 'cables: []', 'a: [1', '{materials: {m: {linear_density: .nan}}}', '[' * 1000, '#' * 2000000]
HANDLES = ['attachment/left', 'attachment/right', 'attachment/pin1', 'rope/0', 'rope/10', 'line/3', 'rope_2/1', 'attachment/upper', 'nobody', '']
LARGEST_GROWTH = 1.3  # of the node's memory after the first quarter


class World:
    """The clock and tf, both unreliable."""

    def __init__(self, choice):
        self.choice = choice
        self.time = 1000.0
        self.clock = rospy.Publisher('/clock', Clock, queue_size=100)
        self.tf = rospy.Publisher('/tf', TFMessage, queue_size=100)
        self.silent_until = 0.0
        self.stop = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while not self.stop.wait(0.01):
            draw = self.choice.random()
            if draw < 0.001:
                self.time = max(1.0, self.time + self.choice.choice([-30, -1, 2, 100]))
            elif draw < 0.004:
                self.silent_until = time.monotonic() + self.choice.choice([0.1, 1.0])
            self.time += self.choice.choice([0.001, 0.01, 0.01, 0.01, 0.02])
            self.clock.publish(rospy.Time.from_sec(self.time))
            if time.monotonic() < self.silent_until:
                continue
            stamp = max(0.001, self.time - self.choice.choice([0, 0, 0, 0.02, 0.3]))
            position = (0.6 + 0.2 * math.sin(self.time), 0.2 * math.cos(3 * self.time), 0.1)
            if draw > 0.99:
                position = (self.choice.choice(NUMBERS), 0, 0)
            self.tf.publish([transform('hand', stamp, position, self.choice.choice([(0, 0, 0, 1)] * 50 + [(0, 0, 0, 0)]))])


class Caller:
    """Random requests."""

    def __init__(self, choice, node):
        self.choice, self.node = choice, node
        self.calls = {}
        self.obstacles = rospy.Publisher('/cable/obstacles', MarkerArray, queue_size=10)
        self.rollouts = actionlib.SimpleActionClient('/cable/rollout', RolloutAction)

    def number(self):
        return self.choice.choice(NUMBERS) if self.choice.random() < 0.3 else self.choice.uniform(0, 2)

    def word(self):
        return self.choice.choice(WORDS)

    def location(self):
        name, number = self.word(), self.number()
        return self.choice.choice([lambda: node_at(name, self.choice.choice([0, 1, 10, 20, 4294967295])),
                                   lambda: arc_length_at(name, number), lambda: nearest_to(name, (number, 0, 0), self.word())])()

    def pose(self):
        rotation = self.choice.choice([(0, 0, 0, 1)] * 4 + [(0, 0, 0, 0), (self.number(), 0, 0, 1)])
        return Pose(Point(self.number(), self.number(), self.number()), Quaternion(*rotation))

    def send_obstacle(self):
        marker = Marker(ns='soak', id=self.choice.randrange(20), type=self.choice.choice([1, 1, 2, 3, 10, 0, 99]),
                        action=self.choice.choice([0] * 20 + [2] * 10 + [3, 7]), pose=self.pose(),
                        mesh_resource=self.choice.choice(['', 'package://none/a.stl', 'file:///etc/passwd']))
        marker.header.frame_id = self.choice.choice(['world', 'world', 'hand', 'nowhere', self.word()])
        size = self.choice.choice([0.1, 0.3, self.number()])
        marker.scale = Vector3(size, size, size)
        self.obstacles.publish([marker])

    def send_rollout(self):
        motion = [transform(self.choice.choice(['hand', 'nowhere', self.word()]), self.choice.choice([0, 0.1, 0.5, 0.5, 1, 1e6]),
                            (self.number(), 0, 0)) for _ in range(self.choice.randrange(4))]
        self.rollouts.send_goal(RolloutGoal(snapshot=self.word(), motion=motion, duration=self.number(), rate=self.number()))
        if self.choice.random() < 0.3:
            self.rollouts.cancel_all_goals()

    def send(self):
        self.choice.choice([self.send_obstacle, self.send_rollout])()

    def call(self):
        node, flag = self.node, self.choice.random() < 0.5
        requests = {
            'pin': lambda: node.pin(self.location(), (self.number(), 0, 0), name=self.word(), frame_id=self.word(), clamp=flag,
                                    keep_offset=self.choice.random() < 0.5),
            'unpin': lambda: node.unpin(self.word()),
            'cut': lambda: node.cut(self.location()),
            'join': lambda: node.join(self.word(), flag, self.word(), self.choice.random() < 0.5),
            'set_length': lambda: node.set_length(self.word(), flag, self.number(), self.number()),
            'save_state': lambda: node.save_state(self.word()),
            'restore_state': lambda: node.restore_state(self.word()),
            'load_scene': lambda: node.load_scene(self.word(), self.choice.choice(SCENES)),
            'pause': lambda: node.pause(self.choice.random() < 0.1),
            'step': lambda: node.step(self.choice.choice([0, 1, 50])),
            'reset': node.reset,
        }
        weights = [1 if name in ('reset', 'load_scene') else 5 for name in requests]
        name = self.choice.choices(list(requests), weights)[0]
        answer = requests[name]()
        done, refused = self.calls.get(name, (0, 0))
        self.calls[name] = (done + answer.success, refused + (not answer.success))
        if not answer.success and not answer.message:
            raise AssertionError(f'{name} was refused without a reason')


class Mouse:
    """Random feedback of interactive markers, some of it as rviz never sends it."""

    def __init__(self, choice):
        self.choice = choice
        self.publisher = rospy.Publisher('/cable/hands/feedback', InteractiveMarkerFeedback, queue_size=100)
        self.updates = rospy.Subscriber('/cable/hands/update', InteractiveMarkerUpdate, self.check)
        self.bad_poses = 0

    def check(self, update):
        for shown in list(update.markers) + list(update.poses):
            p, q = shown.pose.position, shown.pose.orientation
            self.bad_poses += not all(math.isfinite(x) for x in (p.x, p.y, p.z, q.x, q.y, q.z, q.w))

    def number(self):
        return self.choice.choice(NUMBERS) if self.choice.random() < 0.2 else self.choice.uniform(-1, 1)

    def move(self):
        feedback = InteractiveMarkerFeedback(client_id='soak', marker_name=self.choice.choice(HANDLES),
                                             event_type=self.choice.randrange(8), menu_entry_id=self.choice.randrange(6))
        feedback.header.frame_id = self.choice.choice(['', 'world', 'world', 'hand', 'nowhere', 'x' * 100000])
        p, q = feedback.pose.position, feedback.pose.orientation
        p.x, p.y, p.z = (self.number() for _ in range(3))
        q.w = self.choice.choice([1, 1, 1, 0, 0.5, float('nan')])
        self.publisher.publish(feedback)


def memory(pid):
    """[kB] that a process occupies."""
    with open(f'/proc/{pid}/status') as status:
        return next(int(line.split()[1]) for line in status if line.startswith('VmRSS'))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--minutes', type=float, default=2)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--pid', type=int)
    options = parser.parse_args(rospy.myargv()[1:])
    rospy.init_node('soak', disable_rostime=True)
    world = World(random.Random(options.seed))
    node = CableClient('/cable')
    caller = Caller(random.Random(options.seed + 1), node)
    mouse = Mouse(random.Random(options.seed + 2))
    begin, early, states = time.monotonic(), None, [0, 0]

    def check(state):
        states[0] += 1
        states[1] += not all_finite(state)

    rospy.Subscriber('/cable/state', CableArray, check)
    while time.monotonic() - begin < 60 * options.minutes:
        caller.call()
        mouse.move()
        caller.send()
        if options.pid and early is None and time.monotonic() - begin > 15 * options.minutes:
            early = memory(options.pid)
    world.stop.set()
    late = memory(options.pid) if options.pid else 0
    print(f'{states[0]} states, {states[1]} not finite, {mouse.bad_poses} handles not finite; memory {early} -> {late} kB; '
          f'calls (done, refused): {caller.calls}')
    sys.exit(states[0] == 0 or states[1] > 0 or mouse.bad_poses > 0 or (early is not None and late > LARGEST_GROWTH * early))


if __name__ == '__main__':
    main()
