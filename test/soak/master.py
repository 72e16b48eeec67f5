"""A ROS master that is killed and comes back."""
import subprocess
import time
import xmlrpc.client

import rosgraph

STARTING = 120.0  # [s] of wall time, on a busy machine


class Master:
    """Without rosout. What it knew of the nodes it is told again after a restart, as nodes of roscpp do not."""

    def __init__(self, port, log):
        self._port, self._log = port, log
        self.up = True  # False from before it is killed until all is registered again
        self.restarts = 0
        self._start()

    def _start(self):
        self._process = subprocess.Popen(['rosmaster', '--core', '-p', str(self._port)], stdout=self._log, stderr=subprocess.STDOUT)
        deadline = time.monotonic() + STARTING
        while True:
            try:
                return rosgraph.Master('/soak').getPid()
            except (OSError, rosgraph.MasterException):
                if time.monotonic() > deadline:
                    raise
                time.sleep(0.1)

    def kill(self):
        self._process.kill()
        self._process.wait()

    def restart(self, pause):
        """Killed without a warning, away for `pause` [s]."""
        master = rosgraph.Master('/soak')
        parameters = master.getParam('/')
        publishers, subscribers, services = master.getSystemState()
        types = dict(master.getTopicTypes())
        nodes = {node: master.lookupNode(node) for _, users in publishers + subscribers + services for node in users
                 if node in ('/cable', '/soak')}
        addresses = {name: master.lookupService(name) for name, users in services if set(users) & set(nodes)}
        self.up = False
        self.kill()
        time.sleep(pause)
        self._start()
        for key, value in parameters.items():
            master.setParam('/' + key, value)
        handle = xmlrpc.client.ServerProxy(master.master_uri)
        for topic, users in publishers:
            for node in set(users) & set(nodes):
                handle.registerPublisher(node, topic, types[topic], nodes[node])
        for topic, users in subscribers:
            for node in set(users) & set(nodes):
                handle.registerSubscriber(node, topic, types.get(topic, '*'), nodes[node])
        for name, users in services:
            for node in set(users) & set(nodes):
                handle.registerService(node, name, addresses[name], nodes[node])
        self.restarts += 1
        self.up = True
