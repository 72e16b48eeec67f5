"""The clock and tf, both unreliable."""
import math
import threading
import time

import rospy
from rosgraph_msgs.msg import Clock
from tf2_msgs.msg import TFMessage

from cable_client import transform
from values import NUMBERS


class Frames:
    """ROS time, which jumps, and the frame `hand` on tf, which falls silent, comes late, teleports and is not a number."""

    def __init__(self, choice):
        self._choice = choice
        self._time = 1000.0
        self._silent_until = 0.0
        self._clock = rospy.Publisher('/clock', Clock, queue_size=100)
        self._tf = rospy.Publisher('/tf', TFMessage, queue_size=100)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self.jumps = self.silences = self.sent = 0

    def start(self):
        self._thread.start()

    def stop(self):
        self._stop.set()
        self._thread.join()

    def _run(self):
        while not self._stop.wait(self._choice.choice([0.002, 0.01, 0.01, 0.02])):
            self._advance()
            self._clock.publish(rospy.Time.from_sec(self._time))
            if time.monotonic() >= self._silent_until:
                self._tf.publish(self._transforms())
                self.sent += 1

    def _advance(self):
        draw = self._choice.random()
        if draw < 0.0005:
            self._time = max(1.0, self._time + self._choice.choice([-7200, -30, -1, -0.01, 2, 100, 7200]))
            self.jumps += 1
        elif draw < 0.0025:
            self._silent_until = time.monotonic() + self._choice.choice([0.1, 0.4, 1.0])
            self.silences += 1
        self._time += self._choice.choice([0, 0.001, 0.01, 0.01, 0.01, 0.02])

    def _transforms(self):
        draw = self._choice.random()
        stamp = max(0.001, self._time - self._choice.choice([0, 0, 0, 0, 0.02, 0.3]))
        position = (0.6 + 0.2 * math.sin(self._time), 0.2 * math.cos(3 * self._time), 0.1)
        rotation = (0, 0, math.sin(0.2 * self._time), math.cos(0.2 * self._time))
        if draw < 0.005:
            position = (self._choice.choice(NUMBERS), 0, 0)
        elif draw < 0.01:
            rotation = self._choice.choice([(0, 0, 0, 0), (0, 0, 0, 5), (float('nan'), 0, 0, 1)])
        elif draw < 0.015:  # a jump for longer than a step
            position = (0.6, self._choice.uniform(-1, 1), self._choice.uniform(-1, 1))
        transforms = [transform('hand', stamp, position, rotation)]
        if draw > 0.99:
            strange = self._choice.choice([('hand', 'hand'), ('a', 'b'), ('b', 'a'), ('', 'world'), ('world', 'hand'), ('/c', 'world'),
                                           ('x' * 100000, 'world'), ('plug', 'world')])
            transforms.append(transform(strange[0], self._choice.choice([stamp, 0, 1e9]), parent=strange[1]))
        return transforms
