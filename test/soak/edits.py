#!/usr/bin/env python3
"""Eight clients that take a harness apart and put it together at random: scripts/soak --edits builds the node and runs this.

Ends with one line that counts, and status 0 only if nothing was found.
"""
import argparse
import math
import os
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import rospy
import yaml

import load
from cable_client import Frames
from checks import Calls, Findings, Watch
from master import Master

SCENE = Path(__file__).with_name('harness.yaml')
CALLERS = 8
ENDING = 30.0  # [s] that the node has to end by itself


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument('--seconds', type=float, required=True)
    parser.add_argument('--seed', type=int, required=True)
    parser.add_argument('--node', required=True, help='the program')
    parser.add_argument('--output', type=Path, required=True, help='a directory for logs')
    parser.add_argument('--reports', type=Path, required=True, help='the directory where sanitizers write')
    parser.add_argument('--port', type=int, required=True, help='of the master')
    parser.add_argument('--bound', type=float, default=120.0, help='[s] in which a call has to be answered')
    return parser.parse_args(rospy.myargv()[1:])


def hand(now):
    return 0.1 * math.sin(now), 0.1 * math.sin(1.7 * now), 0.05 * math.sin(2.3 * now)


class Edits:
    """The node, its master, and its clients."""

    def __init__(self, options):
        self._options = options
        options.output.mkdir(parents=True, exist_ok=True)
        self._log = open(options.output / 'clients.log', 'w')
        self._master = Master(options.port, self._log)
        rospy.set_param('/cable', yaml.safe_load(SCENE.read_text()))
        rospy.init_node('soak', disable_rostime=True, disable_signals=True)
        with open(options.output / 'node.log', 'w') as log:
            self._node = subprocess.Popen([options.node, '__name:=cable'], stdout=log, stderr=subprocess.STDOUT)
        self._findings = Findings()
        self._calls = Calls(self._findings, self._master, options.bound)

    def run(self):
        options, stop = self._options, threading.Event()
        self._watch = Watch(self._findings)
        scene = SCENE.read_text()
        names = load.LiveNames(scene, self._watch)
        workers = [load.Caller(1000 * options.seed + k, scene, self._calls, names) for k in range(CALLERS)]
        workers.append(load.Sender(1000 * options.seed + CALLERS, names))
        self._sender = workers[-1]
        begin = time.monotonic()
        with Frames(hand=hand):
            threads = load.start(workers, stop)
            try:
                self._wait(begin + options.seconds, threads)
            except KeyboardInterrupt:
                print('interrupted', flush=True)
            self._seconds = time.monotonic() - begin
            stop.set()
            ending = time.monotonic() + options.bound
            for thread in threads:
                thread.join(max(0.0, ending - time.monotonic()))
            self._end_node()
        self._calls.check_closed()
        if self._watch.steps == 0:
            self._findings.add('no steps', '')

    def _wait(self, end, threads):
        while time.monotonic() < end and self._node.poll() is None and not any(self._options.reports.iterdir()):
            time.sleep(min(1.0, max(0.0, end - time.monotonic())))
            if not all(thread.is_alive() for thread in threads):
                return self._findings.add('the soak itself failed', 'a thread ended, see its output')
            if not self._calls.check_open():
                return None
        return None

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
            self._findings.add('a report of the sanitizer', f'{report}\n{report.read_text(errors="replace")[:5000]}')

    def summarize(self):
        calls, found = self._calls, self._findings.all
        counts = {name: sum(values.values()) for name, values in
                  (('true', calls.answered), ('false', calls.refused), ('lost', calls.closed))}
        by_name = ', '.join(f'{name} {calls.answered.get(name, 0)}/{calls.refused.get(name, 0)}'
                            for name in sorted({*calls.answered, *calls.refused}))
        not_finite = sum(count for kind, (count, _) in found.items() if kind.endswith('not finite'))
        print(f'answered true/false: {by_name}')
        print('sent: ' + ', '.join(f'{name} {count}' for name, count in self._sender.sent.items()))
        print('events: ' + ', '.join(f'{name} {count}' for name, count in sorted(self._watch.events.items())))
        for kind, (count, example) in found.items():
            print(f'FOUND {count} times: {kind}: {example}')
        print(f'seed {self._options.seed}: {self._seconds:.0f} s, {sum(counts.values())} calls: {counts["true"]} answered true, '
              f'{counts["false"]} false, {counts["lost"]} lost; {self._watch.steps} steps; '
              f'{sum(1 for _ in self._options.reports.iterdir())} reports of sanitizers, {self._watch.events.get("FAULT", 0)} FAULT events, '
              f'{not_finite} messages with numbers that are not finite, {len(found)} kinds of findings', flush=True)
        return 1 if found else 0

    def close(self):
        """Whatever happened, nothing that this has started goes on."""
        if self._node.poll() is None:
            self._node.kill()
            self._node.wait()
        self._master.kill()


def main():
    options = arguments()
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    print(f'seed {options.seed}, {options.seconds:.0f} s; logs in {options.output}', flush=True)
    edits = Edits(options)
    try:
        edits.run()
        status = edits.summarize()
    finally:
        edits.close()
    # Threads of rospy may still wait for what is gone.
    sys.stdout.flush()
    os._exit(status)


if __name__ == '__main__':
    main()
