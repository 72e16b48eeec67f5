"""Frames that move as hands do: smoothly, from one place to the next."""
import math

import numpy as np


def turned(a, b):
    """The quaternion (x, y, z, w) of b and then a."""
    (ax, ay, az, aw), (bx, by, bz, bw) = a, b
    return np.array([aw * bx + ax * bw + ay * bz - az * by, aw * by - ax * bz + ay * bw + az * bx,
                     aw * bz + ax * by - ay * bx + az * bw, aw * bw - ax * bx - ay * by - az * bz])


def about(axis, angle):
    """The quaternion that turns by an angle [rad] about a unit vector."""
    return np.array([*(math.sin(0.5 * angle) * np.asarray(axis)), math.cos(0.5 * angle)])


def eased(part):
    """From 0 to 1 with no velocity and no acceleration at either end."""
    part = min(max(part, 0.0), 1.0)
    return part ** 3 * (10 - 15 * part + 6 * part * part)


class Hand:
    """Where a frame is at any time: it stands at its start, goes from place to place, and stands again."""

    def __init__(self, start):
        self._legs = []  # (begin, duration, from, to, orientation before, axis, angle)
        self.place = np.asarray(start, dtype=float)
        self.orientation = np.array([0, 0, 0, 1.0])

    def go(self, begin, duration, to, axis=(1, 0, 0), angle=0.0):
        """A leg that begins [s] after the ones before it have ended; it turns about an axis of the hand's own."""
        to = np.asarray(to, dtype=float)
        self._legs.append((begin, duration, self.place, to, self.orientation, axis, angle))
        self.place, self.orientation = to, turned(self.orientation, about(axis, angle))

    def pose(self, time):
        """Place [m] and quaternion at a time [s]."""
        place, orientation = (self._legs[0][2], self._legs[0][4]) if self._legs else (self.place, self.orientation)
        for begin, duration, start, to, before, axis, angle in self._legs:
            if time < begin:
                break
            part = eased((time - begin) / duration)
            place, orientation = start + part * (to - start), turned(before, about(axis, part * angle))
        return place, orientation


GREATEST_ACCELERATION = 10.0  # [m/s^2] at the middle of a leg's first half
GREATEST_TURN = 4.0  # [rad/s]


def shortest(distance, angle, speed):
    """[s] For a leg: at about a speed [m/s], and no more abruptly than arms do."""
    return max(1.9 * distance / speed, math.sqrt(5.8 * distance / GREATEST_ACCELERATION), 1.9 * abs(angle) / GREATEST_TURN, 0.1)


def wander(random, hand, until, reach, allowed=lambda place: True, turns=0.0, roll=(1, 0, 0)):
    """Has a hand go to places within a `reach` [m] of where it is, by straight ways on which all places are `allowed`, with pauses,
    until it stands [s]. `turns`: how far it turns on a leg about the axis `roll` of its own, and a tenth of that about others [rad]."""
    time = random.uniform(0.02, 0.15) * until
    while time < until:
        for _ in range(100):
            way = random.normal(size=3)
            way *= random.uniform(0.2, 1) * reach / np.linalg.norm(way)
            if all(allowed(hand.place + part * way) for part in np.linspace(0.1, 1, 10)):
                break
        else:
            way = np.zeros(3)
        axis, angle = roll, 0.0
        if turns > 0 and random.random() < 0.5:
            angle = random.uniform(-1, 1) * turns
            if random.random() < 0.4:
                axis, angle = (0, 1, 0), 0.1 * angle
        duration = shortest(np.linalg.norm(way), angle, 10 ** random.uniform(-1.0, 0.0))
        if time + duration > until:  # as far as the time allows
            part = min((until - time) / duration, 1.0) ** 2
            way, angle = part * way, part * angle
            duration = until - time
            if duration < 0.05:
                break
        hand.go(time, duration, hand.place + way, axis, angle)
        time += duration
        if random.random() < 0.4:
            time += random.uniform(0.05, 0.3)
