"""What is held against the node: answers in time, numbers that are finite, memory that stays."""
import math
import threading
import time

import genpy
import numpy as np
import rospy
from diagnostic_msgs.msg import DiagnosticArray
from geometry_msgs.msg import WrenchStamped
from sensor_msgs.msg import PointCloud2
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import InteractiveMarkerUpdate, MarkerArray

from verlet_cable.msg import CableArray, CableEvent, Legend


class Findings:
    """What was found, each kind with its first example."""

    def __init__(self):
        self._lock = threading.Lock()
        self.all = {}

    def add(self, kind, example):
        with self._lock:
            count, first = self.all.get(kind, (0, example))
            self.all[kind] = (count + 1, first)
        if count == 0:
            print(f'found: {kind}: {example}', flush=True)


class Calls:
    """Of all services: how many, how they were answered, and how long that took [s]."""

    CLOSED = 'unable to receive data from sender'  # in rospy's words: the connection ended before the answer
    MOST_CLOSED = 1e-3  # of all calls; roscpp itself closes some, see doc/sanitizers_and_soak.md

    def __init__(self, findings, master, bound):
        self._findings, self._master, self._bound = findings, master, bound
        self._lock = threading.Lock()
        self._open = {}
        self.answered, self.refused, self.closed, self.without_master, self.latencies = {}, {}, {}, {}, {}

    def made(self, name, request):
        """Makes a call; returns its answer, or None."""
        restarts, begin, me = self._master.restarts, time.monotonic(), threading.get_ident()
        with self._lock:
            self._open[me] = (name, begin)
        try:
            answer = request()
        except (rospy.ServiceException, rospy.ROSException, OSError) as error:
            if not self._master.up or self._master.restarts != restarts:
                self._count(self.without_master, name)
            elif self.CLOSED in str(error):
                self._count(self.closed, name)
            else:
                self._findings.add(f'{name}: not answered', error)
            time.sleep(0.1)
            return None
        finally:
            with self._lock:
                del self._open[me]
        self._judge(name, answer, time.monotonic() - begin)
        return answer

    def _judge(self, name, answer, latency):
        succeeded = getattr(answer, 'success', True)
        self._count(self.answered if succeeded else self.refused, name)
        with self._lock:
            self.latencies.setdefault(name, []).append(latency)
        if latency > self._bound:
            self._findings.add(f'{name}: answered late', f'after {latency:.1f} s')
        if not succeeded and not answer.message:
            self._findings.add(f'{name}: refused without a reason', answer)

    def _count(self, counts, name):
        with self._lock:
            counts[name] = counts.get(name, 0) + 1

    def check_closed(self):
        closed = sum(self.closed.values())
        calls = closed + sum(self.answered.values()) + sum(self.refused.values())
        if closed > self.MOST_CLOSED * calls:
            self._findings.add('connections closed without an answer', f'{closed} of {calls}')

    def check_open(self):
        """Whether none waits for far longer than it may."""
        with self._lock:
            late = [(name, time.monotonic() - begin) for name, begin in self._open.values()]
        late = [(name, waited) for name, waited in late if waited > 2 * self._bound]
        for name, waited in late:
            self._findings.add(f'{name}: no answer', f'in {waited:.0f} s')
        return not late


def is_finite(value):
    """Of a message, with all that is in it."""
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, (list, tuple)):
        if value and isinstance(value[0], float):
            return bool(np.isfinite(value).all())
        return not value or isinstance(value[0], (str, int)) or all(is_finite(item) for item in value)
    if isinstance(value, genpy.Message):
        return all(is_finite(getattr(value, field)) for field in value.__slots__)
    return True


def is_finite_cloud(cloud):
    """Of a PointCloud2 whose numbers, colors but for, are of 4 bytes."""
    kinds = {7: '<f4'}
    for field in cloud.fields:
        if field.datatype in kinds and field.name != 'rgb':
            record = np.dtype({'names': ['x'], 'formats': [kinds[field.datatype]], 'offsets': [field.offset],
                               'itemsize': cloud.point_step})
            if not np.isfinite(np.frombuffer(cloud.data, record)['x']).all():
                return False
    return True


class Watch:
    """Reads what the node publishes, all of it."""

    TOPICS = {'/cable/state': CableArray, '/cable/points': PointCloud2, '/cable/surface': PointCloud2, '/cable/markers': MarkerArray,
              '/cable/legend': Legend, '/cable/hands/update': InteractiveMarkerUpdate, '/cable/wrench/left': WrenchStamped,
              '/cable/wrench/grip': WrenchStamped, '/tf': TFMessage}

    def __init__(self, findings):
        self._findings = findings
        self.messages = dict.fromkeys(self.TOPICS, 0)
        self.events, self.steps, self.state = {}, 0, None  # the last state
        self._names = {value: name for name, value in vars(CableEvent).items() if name.isupper() and isinstance(value, int)}
        for topic, kind in self.TOPICS.items():
            rospy.Subscriber(topic, kind, self._check, topic, queue_size=1)
        rospy.Subscriber('/cable/events', CableEvent, self._note)
        rospy.Subscriber('/diagnostics', DiagnosticArray, self._count_steps)

    def _check(self, message, topic):
        if topic == '/tf' and message._connection_header['callerid'] != '/cable':
            return
        self.messages[topic] += 1
        if topic == '/cable/state':
            self.state = message
        if not (is_finite_cloud(message) if isinstance(message, PointCloud2) else is_finite(message)):
            self._findings.add(f'{topic}: not finite', str(message)[:2000])

    def _note(self, event):
        name = self._names[event.type]
        self.events[name] = self.events.get(name, 0) + 1
        if event.type == CableEvent.FAULT:
            self._findings.add('fault', event.message)

    def _count_steps(self, array):
        for status in array.status:
            if status.name.endswith('simulation'):
                self.steps += int(next(entry.value for entry in status.values if entry.key == 'steps'))


def resident(pid):
    """Reads what a process occupies [MB]."""
    def read():
        with open(f'/proc/{pid}/status') as status:
            return next((int(line.split()[1]) / 1e3 for line in status if line.startswith('VmRSS')), None)
    return read


def live_heap(file):
    """Reads what live_heap.cpp writes [MB]."""
    def read():
        text = file.read_text() if file.exists() else ''
        return int(text) / 1e6 if text.endswith('\n') else None
    return read


class Memory:
    """A size [MB] of the node, over time [s]."""

    SETTLING = 900.0  # [s] at first: for so long what was in use still grew, on a busy machine, before it stayed
    SHORTEST = 300.0  # [s] after that, of which anything can be said

    def __init__(self, name, read, largest_growth):
        """`largest_growth(median)`: [MB] by a robust line through what comes after the settling."""
        self.name, self.samples = name, []
        self._read, self._largest_growth = read, largest_growth

    def sample(self, time_now):
        size = self._read()
        if size:
            self.samples.append((time_now, size))

    def settled(self):
        """Times and sizes after the settling."""
        samples = np.array([sample for sample in self.samples if sample[0] >= self.SETTLING])
        return samples.reshape(-1, 2).T

    def fit(self):
        """Slope [MB/s] and spread [MB] after Theil and Sen, or None where that was too short."""
        times, sizes = self.settled()
        if len(times) < 10 or times[-1] - times[0] < self.SHORTEST:
            return None
        few = np.linspace(0, len(times) - 1, min(len(times), 1000)).astype(int)
        t, m = times[few], sizes[few]
        first, second = np.triu_indices(len(t), 1)
        slope = float(np.median((m[second] - m[first]) / (t[second] - t[first])))
        rest = m - slope * t
        return slope, float(np.median(np.abs(rest - np.median(rest))))

    def check(self, findings):
        fit = self.fit()
        if fit is None:
            return
        times, sizes = self.settled()
        growth = fit[0] * (times[-1] - times[0])
        if growth > self._largest_growth(np.median(sizes)):
            findings.add(f'memory grows, {self.name}', f'{3600 * fit[0]:.1f} MB an hour, of {np.median(sizes):.1f} MB')
