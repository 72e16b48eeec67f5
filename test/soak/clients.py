"""Clients that come and go, some of them by kill -9 in the middle of a call."""
import os
import random
import select
import signal
import subprocess
import sys
import time
import xmlrpc.client

import rosgraph
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
    """Processes that call and subscribe like this one, and are killed: in the middle of a call, where that hits one, or after they
    have read nothing for a while."""

    STARTING = 60.0  # [s] of wall time, of Python with all its messages, on a busy machine
    FORGETTING = 0.5  # [s] in which the node hears from the master that a publisher is gone

    def __init__(self, seed, log):
        self._choice, self._log = random.Random(seed), log
        self.killed = self.killed_in_calls = self.stopped = 0

    def run(self, stop):
        while not stop.is_set():
            command = [sys.executable, sys.argv[0], '--victim', '--seed', str(self._choice.randrange(10**9))]
            process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=self._log)
            select.select([process.stdout], [], [], self.STARTING)  # for its first call
            stop.wait(self._choice.uniform(0.0, 4.0))
            process.send_signal(signal.SIGSTOP)
            if self._choice.random() < 0.2:
                self.stopped += 1
                stop.wait(self._choice.uniform(1.0, 30.0))
            node = f'/{VICTIM}_{process.pid}_'
            unregister(registrations(node))
            time.sleep(self.FORGETTING)
            process.kill()
            calls = process.communicate()[0]
            self.killed += 1
            self.killed_in_calls += calls.count(CALLED) > calls.count(ANSWERED)
            unregister(registrations(node))  # what the master had not heard of yet


def registrations(prefix):
    """The calls that remove nodes from the master, publishers first."""
    master = rosgraph.Master('/soak')
    try:
        publishers, subscribers, services = master.getSystemState()
        calls = []
        for node in {node for _, nodes in publishers + subscribers + services for node in nodes if node.startswith(prefix)}:
            of_node, api = rosgraph.Master(node), master.lookupNode(node)
            calls += [(of_node.unregisterPublisher, topic, api) for topic, nodes in publishers if node in nodes]
            calls += [(of_node.unregisterSubscriber, topic, api) for topic, nodes in subscribers if node in nodes]
            calls += [(of_node.unregisterService, service, master.lookupService(service)) for service, nodes in services if node in nodes]
        return calls
    except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
        return []  # no master at the moment: what it knew of killed clients is not restored


def unregister(calls):
    """As `rosnode cleanup` does, but before they are killed: roscpp tries to connect to a publisher that the master still knows, again and
    again, and keeps 1.7 kB for each attempt."""
    for call, name, api in calls:
        try:
            call(name, api)
        except (OSError, rosgraph.MasterException, xmlrpc.client.Error):
            return


VICTIM = 'victim'
CALLED, ANSWERED = b'\1', b'\2'  # what a victim writes; no log has these


class Written:
    """Of the calls of a process that will be killed: when each begins and ends, for who kills it."""

    def made(self, _, request):
        os.write(sys.stdout.fileno(), CALLED)
        try:
            return request()
        except (rospy.ServiceException, rospy.ROSException, OSError):
            time.sleep(0.1)
        finally:
            os.write(sys.stdout.fileno(), ANSWERED)


def be_a_victim(seed, scene, stop):
    rospy.init_node(VICTIM, anonymous=True, disable_rostime=True, disable_signals=True)
    return [Caller(seed, scene, Written()), Sender(seed + 1), Visitors(seed + 2)]
