"""rviz on a display of its own with a launch file, under a clock that goes on when it is told to: what a picture shows does not depend on
how fast the machine is.

Needs the workspace's setup sourced, Xvfb, xdotool and ImageMagick; ROS_MASTER_URI names the port of the master that is started.
"""
import contextlib
import os
import pathlib
import signal
import subprocess
import tempfile
import time
from urllib.parse import urlsplit

import rosgraph
import rospy
import yaml
from rosgraph_msgs.msg import Clock
from verlet_cable.msg import CableArray

PACKAGE = pathlib.Path(__file__).resolve().parents[2]
DISPLAY = ':79'
TICK = 0.01      # [s] of the clock
PACE = 2.0       # times as long it takes, unless a picture shows how fast time goes
LATE = 0.12      # [s] that what is shown may be behind the clock: tf_latency and a few periods of publishing
DRAWING = 0.3    # [s] until rviz has drawn what it received
STARTING = 6.0   # [s] until rviz has drawn its window
PATIENCE = 90.0  # [s] for a master, or a state, to come


@contextlib.contextmanager
def running(*command, **environment):
    process = subprocess.Popen(command, env={**os.environ, **environment}, start_new_session=True, stdout=subprocess.DEVNULL,
                               stderr=subprocess.DEVNULL)
    try:
        yield
    finally:
        os.killpg(process.pid, signal.SIGINT)
        try:
            process.wait(15)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def wait_until(done, what):
    deadline = time.monotonic() + PATIENCE
    while not done():
        if time.monotonic() > deadline:
            raise RuntimeError(f'no {what} in {PATIENCE:g} s')
        time.sleep(0.02)


def configuration(file, size, panels=False, **view):
    """The text of an rviz configuration for a window of a size, with or without its panels, and what it looks at."""
    config = yaml.safe_load((PACKAGE / file).read_text())
    config['Visualization Manager']['Views']['Current'].update(view)
    config['Window Geometry'].update({'Width': size[0], 'Height': size[1], 'X': 0, 'Y': 0})
    config['Panels'] = [panel for panel in config['Panels'] if panels and panel['Class'] != 'rviz/Displays']
    return yaml.safe_dump(config)


def inside(size):
    """Of a window of that size without panels: what is within rviz's menus and edges."""
    return f'{size[0] - 34}x{size[1] - 105}+17+65'


def keep(file, geometry=None):
    """What the display shows now, or a part of it."""
    crop = ['-crop', geometry, '+repage'] if geometry else []
    subprocess.run(['import', '-display', DISPLAY, '-window', 'root', *crop, '-colors', '128', f'PNG8:{file}'], check=True)


class SlowClock:
    """ROS time, and the stamp of the cables that are shown."""

    def __init__(self, pace):
        self._pace = pace
        self._due = 0.0  # [s] of the monotonic clock: the next tick
        self._now = 1.0
        self._shown = 0.0
        self._publisher = rospy.Publisher('clock', Clock, queue_size=10)
        rospy.Subscriber('cable/state', CableArray, self._see)

    def _see(self, state):
        if state.cables or state.nets or state.particles:
            self._shown = state.header.stamp.to_sec()

    def _tick(self):
        self._now += TICK
        self._publisher.publish(Clock(rospy.Time.from_sec(self._now)))
        self._due = max(self._due + self._pace * TICK, time.monotonic())  # it does not catch up on where it stood
        time.sleep(max(self._due - time.monotonic(), 0))

    def wait_for_cables(self):
        wait_until(lambda: self._tick() or self._shown > 0, 'cables')

    def go_on(self, seconds):
        """Until it is so much later, and the cables are simulated and drawn."""
        end = self._now + seconds
        while self._now < end - TICK / 2:
            self._tick()
        wait_until(lambda: self._shown >= self._now - LATE, 'cables of now')
        time.sleep(DRAWING)


@contextlib.contextmanager
def stage(size, config, launch, pace=PACE):
    """The clock, when the cables are there; `launch` is a launch file of the package, or the path of another, and arguments. One a process:
    it is a ROS node."""
    package = [] if os.path.isabs(launch[0]) else ['verlet_cable']
    port = str(urlsplit(os.environ['ROS_MASTER_URI']).port)
    with tempfile.NamedTemporaryFile('w', suffix='.rviz') as file, \
            running('Xvfb', DISPLAY, '-screen', '0', f'{size[0]}x{size[1]}x24', '-nolisten', 'tcp'), running('roscore', '-p', port):
        file.write(config)
        file.flush()
        wait_until(rosgraph.is_master_online, 'master')
        rosgraph.Master('/rviz_stage').setParam('/use_sim_time', True)
        rospy.init_node('rviz_stage', disable_signals=True)
        with running('rviz', '-d', file.name, DISPLAY=DISPLAY):
            time.sleep(STARTING)
            with running('roslaunch', *package, *launch, 'rviz:=false'):
                clock = SlowClock(pace)
                clock.wait_for_cables()
                yield clock
        rospy.signal_shutdown('the picture is taken')
