"""Clients that come and go, some of them by kill -9 in the middle of a call."""
import random
import subprocess
import sys
import time

import rospy

from load import Caller, Sender


class Visitors:
    """Subscribe to topics of the node, anything that it has, and leave again."""

    def __init__(self, seed):
        self._choice = random.Random(seed)
        self.visits = self.messages = 0

    def run(self, stop):
        here = []
        while not stop.wait(self._choice.uniform(0.02, 0.3)):
            if len(here) < 4:
                try:
                    topics = rospy.get_published_topics('/cable')
                except OSError:
                    continue  # no master at the moment
                if topics:
                    here.append(rospy.Subscriber(self._choice.choice(topics)[0], rospy.AnyMsg, self._receive, queue_size=1))
                    self.visits += 1
            elif self._choice.random() < 0.7:
                here.pop(self._choice.randrange(len(here))).unregister()

    def _receive(self, _):
        self.messages += 1


class Victims:
    """Processes that call and subscribe like this one, and are killed."""

    def __init__(self, seed, log):
        self._choice, self._log = random.Random(seed), log
        self.killed = 0

    def run(self, stop):
        while not stop.is_set():
            command = [sys.executable, sys.argv[0], '--victim', '--seed', str(self._choice.randrange(10**9))]
            process = subprocess.Popen(command, stdout=self._log, stderr=subprocess.STDOUT)
            stop.wait(self._choice.uniform(1.0, 6.0))
            process.kill()
            process.wait()
            self.killed += 1


class NoRecord:
    """Of the calls of a process that will be killed."""

    def made(self, _, request):
        try:
            return request()
        except (rospy.ServiceException, rospy.ROSException, OSError):
            time.sleep(0.1)


def be_a_victim(seed, scene, stop):
    rospy.init_node('victim', anonymous=True, disable_rostime=True, disable_signals=True)
    return [Caller(seed, scene, NoRecord()), Sender(seed + 1), Visitors(seed + 2)]
