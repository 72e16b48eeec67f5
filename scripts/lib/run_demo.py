#!/usr/bin/env python3
"""Runs demo.launch with a ROS master of its own, until it is ended or for a time.

Usage: run_demo.py RVIZ [SECONDS]    (RVIZ: true or false)

With SECONDS, the exit status is 0 only if cable markers, cable points and cable state came for that time.
"""
import math
import os
import signal
import socket
import subprocess
import sys
import time
from urllib.parse import urlsplit

DEFAULT_PORT = 11311
START_LIMIT = 30.0  # [s] from the start to the first message
STOP_LIMIT = 20.0  # [s] for roslaunch to end its nodes
LOOK_EVERY = 10  # messages


class Stream:
    """Counts the messages of a topic, and looks into some: decoding all in Python is slower than they come."""

    def __init__(self, topic, kind, shows_cable):
        self.topic = topic
        self.kind = kind
        self.shows_cable = shows_cable
        self.messages = 0
        self.with_cable = 0
        self.stamps = set()

    def receive(self, raw):
        if self.messages % LOOK_EVERY == 0:
            message = self.kind().deserialize(raw._buff)
            self.with_cable += self.shows_cable(message)
            self.stamps.update(part.header.stamp for part in getattr(message, 'markers', [message]))
        self.messages += 1


def port_is_used(port):
    try:
        socket.create_connection(('localhost', port), 1.0).close()
        return True
    except OSError:
        return False


def free_port():
    """The port of ROS_MASTER_URI, or the first free one after it: a master that runs there already is left alone."""
    wanted = urlsplit(os.environ.get('ROS_MASTER_URI', '')).port or DEFAULT_PORT
    port = wanted
    while port_is_used(port):
        port += 1
    if port != wanted:
        print(f'Port {wanted} is in use, perhaps by a ROS master of yours: the demo runs its own on port {port}.')
    return port


def markers_show_cable(message):
    return any(marker.action == marker.ADD and len(marker.points) > 1 for marker in message.markers)


def points_show_cable(message):
    return message.width * message.height > 1 and len(message.data) == message.row_step * message.height


def state_shows_cable(message):
    finite = all(math.isfinite(p.x + p.y + p.z) for cable in message.cables for p in cable.positions)
    return finite and any(len(cable.positions) > 1 for cable in message.cables)


def subscribe():
    import rospy
    from sensor_msgs.msg import PointCloud2
    from verlet_cable.msg import CableArray
    from visualization_msgs.msg import MarkerArray

    rospy.init_node('demo_watch', anonymous=True, disable_signals=True)
    streams = [Stream('/cable/markers', MarkerArray, markers_show_cable),
               Stream('/cable/points', PointCloud2, points_show_cable),
               Stream('/cable/state', CableArray, state_shows_cable)]
    for stream in streams:
        rospy.Subscriber(stream.topic, rospy.AnyMsg, stream.receive)
    return streams


def watch(launch, port, seconds):
    """Counts for some seconds, from when every topic has shown a cable; returns what is wrong, as a list."""
    start = time.monotonic()

    def wait_until(condition, limit):
        while not condition() and launch.poll() is None and time.monotonic() < limit:
            time.sleep(0.05)

    wait_until(lambda: port_is_used(port), start + START_LIMIT)
    if launch.poll() is not None or not port_is_used(port):
        return ['roslaunch did not start']
    streams = subscribe()
    wait_until(lambda: all(stream.with_cable for stream in streams), start + START_LIMIT)
    before = [stream.messages for stream in streams]
    begin = time.monotonic()
    if all(stream.with_cable for stream in streams):
        wait_until(lambda: False, begin + seconds)
    duration = time.monotonic() - begin
    wrong = []
    print(f'{"topic":<16} {"messages":>8} {"rate [Hz]":>10}')
    for stream, first in zip(streams, before):
        count = stream.messages - first
        print(f'{stream.topic:<16} {count:8d} {count / duration if duration > 0 else 0:10.1f}')
        if count == 0 or not stream.with_cable:
            wrong.append(f'{stream.topic}: {stream.messages} messages, none with a cable in those looked at')
        elif len(stream.stamps) < 2:
            wrong.append(f'{stream.topic}: the time in its header stands still')
    if launch.poll() is not None:
        wrong.append(f'roslaunch ended by itself, with exit status {launch.returncode}')
    return wrong


def stop(launch):
    for ending in (signal.SIGINT, signal.SIGTERM, signal.SIGKILL):
        if launch.poll() is None:
            launch.send_signal(ending)
            try:
                launch.wait(STOP_LIMIT)
            except subprocess.TimeoutExpired:
                pass


def main():
    rviz = sys.argv[1]
    seconds = float(sys.argv[2]) if len(sys.argv) > 2 else None
    port = free_port()
    os.environ['ROS_MASTER_URI'] = f'http://localhost:{port}'
    print(f'ROS_MASTER_URI={os.environ["ROS_MASTER_URI"]}' + ('' if seconds else '; Ctrl-C ends the demo'))
    for ending in (signal.SIGINT, signal.SIGTERM):
        signal.signal(ending, signal.default_int_handler)
    launch = subprocess.Popen(['roslaunch', '-p', str(port), 'verlet_cable', 'demo.launch', f'rviz:={rviz}'],
                              start_new_session=True)
    try:
        if seconds is None:
            return launch.wait()
        wrong = watch(launch, port, seconds)
    except KeyboardInterrupt:
        return 130
    finally:
        stop(launch)
    for line in wrong:
        print(f'scripts/demo: {line}', file=sys.stderr)
    if not wrong:
        print('The demo published cable markers, points and state.')
    return 1 if wrong else 0


if __name__ == '__main__':
    sys.exit(main())
