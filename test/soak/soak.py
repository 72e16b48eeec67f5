#!/usr/bin/env python3
"""A node under everything at once, for hours. scripts/soak builds it with sanitizers and runs this; doc/sanitizers_and_soak.md.

Ends with a summary in text, JSON and a picture in the directory of the output, and status 0 only if nothing was found.
"""
import argparse
import os
import random
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import rosgraph
import rospy
import yaml

import load
import summary
from checks import Calls, Findings, Memory, Watch, live_heap, resident
from clients import Victims, Visitors, be_a_victim
from frames import Frames
from master import Master

SCENE = Path(__file__).with_name('scene.yaml')
CALLERS = 3
SAMPLE_PERIOD = 5.0  # [s]
ENDING = 30.0  # [s] that the node has to end by itself
RESIDENT_GROWTH = 0.05  # of the median, at most
LIVE_GROWTH = 1.0  # [MB] at most
MASTER_PERIOD = (120.0, 600.0)  # [s] between its deaths


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument('--seconds', type=float, default=1800)
    parser.add_argument('--seed', type=int, default=1)
    parser.add_argument('--node', help='the program')
    parser.add_argument('--live-heap', help='the library that is to tell what is in use, of a node with AddressSanitizer')
    parser.add_argument('--build', help='how it was built, for the summary')
    parser.add_argument('--output', type=Path, help='a directory for logs and results')
    parser.add_argument('--reports', type=Path, help='the directory where sanitizers write')
    parser.add_argument('--port', type=int, default=11399, help='of the master')
    parser.add_argument('--bound', type=float, default=30.0, help='[s] in which a call has to be answered')
    parser.add_argument('--victim', action='store_true', help='be a client that will be killed')
    return parser.parse_args(rospy.myargv()[1:])


class Soak:
    """The node, its master, and all that is done to them."""

    def __init__(self, options):
        self._options = options
        self._choice = random.Random(options.seed)
        options.output.mkdir(parents=True, exist_ok=True)
        self._log = open(options.output / 'clients.log', 'w')
        self._master = Master(options.port, self._log)
        rospy.set_param('/use_sim_time', True)
        rospy.set_param('/cable', yaml.safe_load(SCENE.read_text()))
        rospy.init_node('soak', disable_rostime=True, disable_signals=True)
        self._frames = Frames(random.Random(options.seed + 1))
        self._frames.start()
        live_file, environment = options.output / 'live_heap', dict(os.environ)
        if options.live_heap:
            environment.update(LD_PRELOAD=options.live_heap, LIVE_HEAP_FILE=str(live_file))
        with open(options.output / 'node.log', 'w') as log:
            self._node = subprocess.Popen([options.node, '__name:=cable'], stdout=log, stderr=subprocess.STDOUT, env=environment)
        self._findings = Findings()
        self._calls = Calls(self._findings, self._master, options.bound)
        self._memory = [Memory('resident', resident(self._node.pid), lambda median: RESIDENT_GROWTH * median)]
        if options.live_heap:
            self._memory.append(Memory('in use', live_heap(live_file), lambda _: LIVE_GROWTH))

    def run(self):
        options, stop = self._options, threading.Event()
        self._watch = Watch(self._findings)
        scene = SCENE.read_text()
        callers = [load.Caller(options.seed + 10 * (k + 1), scene, self._calls) for k in range(CALLERS)]
        self._sender = load.Sender(options.seed + 2)
        self._visitors, self._victims = Visitors(options.seed + 3), Victims(options.seed + 4, self._log)
        self._tuner = load.Tuner(options.seed + 5, self._calls)
        workers = load.start(callers + [self._sender, self._tuner, self._visitors, self._victims], stop)
        begin = time.monotonic()
        try:
            self._wait(workers, begin, begin + options.seconds)
        except KeyboardInterrupt:
            print('interrupted', flush=True)
        except (OSError, rosgraph.MasterException) as error:
            self._findings.add('the soak itself failed', f'no master: {error}')
        self._seconds = time.monotonic() - begin
        stop.set()
        for worker in workers:
            worker.join(2 * options.bound)
        self._end_node()
        self._frames.stop()
        for memory in self._memory:
            memory.check(self._findings)
        self._calls.check_closed()
        if self._watch.messages['/cable/state'] == 0 or self._watch.steps == 0:
            self._findings.add('nothing was published', '')

    def _wait(self, workers, begin, end):
        next_death = begin + self._choice.uniform(*MASTER_PERIOD)
        while time.monotonic() < end:
            time.sleep(min(SAMPLE_PERIOD, max(0.0, end - time.monotonic())))
            if self._node.poll() is not None or any(self._options.reports.iterdir()):
                return
            for memory in self._memory:
                memory.sample(time.monotonic() - begin)
            if not all(worker.is_alive() for worker in workers):
                self._findings.add('the soak itself failed', 'a thread ended, see its output')
                return
            if not self._calls.check_open():
                return
            if time.monotonic() > next_death:
                self._master.restart(self._choice.uniform(0.5, 5))
                next_death = time.monotonic() + self._choice.uniform(*MASTER_PERIOD)

    def _end_node(self):
        if self._node.poll() is None:
            self._node.send_signal(signal.SIGINT)
            try:
                self._node.wait(ENDING)
            except subprocess.TimeoutExpired:
                self._findings.add('the node did not end', f'within {ENDING:.0f} s')
        if self._node.poll() not in (None, 0):
            self._findings.add('the node ended with an error', f'status {self._node.returncode}')
        for report in sorted(self._options.reports.iterdir()):
            self._findings.add('a report of the sanitizer', f'{report}\n{report.read_text(errors="replace")[:2000]}')

    def summarize(self):
        others = {'sent': {**self._sender.sent, 'floods of tuning': self._tuner.floods},
                  'clients': {'subscriptions': self._visitors.visits, 'messages': self._visitors.messages,
                              'killed': self._victims.killed, 'of these in a call': self._victims.killed_in_calls,
                              'stopped': self._victims.stopped, 'master restarts': self._master.restarts},
                  'frames': {'transforms': self._frames.sent, 'time jumps': self._frames.jumps, 'silences': self._frames.silences}}
        options = self._options
        result = summary.summarize(self._seconds, options.seed, options.build, self._findings, self._calls, self._watch, self._memory,
                                   others)
        summary.write(result, self._memory, options.output)
        print(summary.text(result), flush=True)
        return 1 if result['findings'] else 0

    def close(self):
        """Whatever happened, nothing that this has started goes on."""
        if self._node.poll() is None:
            self._node.kill()
            self._node.wait()
        self._master.kill()


def main():
    options = arguments()
    if options.victim:
        stop = threading.Event()
        workers = load.start(be_a_victim(options.seed, SCENE.read_text(), stop), stop)
        return workers[0].join()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    soak = Soak(options)
    try:
        soak.run()
        status = soak.summarize()
    finally:
        soak.close()
    # Threads of rospy may still wait for what is gone.
    sys.stdout.flush()
    os._exit(status)


if __name__ == '__main__':
    main()
