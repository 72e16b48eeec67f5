#!/usr/bin/env python3
"""How long `reset` takes while a node is attacked, and at the same time on a node that is left alone. Needs a master; not a test:

    roscore & test/ros/reset_latency.py [SECONDS] [ATTACK...]

prints a row for each attack: calls, median, 99th percentile and longest [ms], and how many were refused, of `reset` of both nodes, each asked 100
times a second; and of `unpin` of nothing on the attacked node, which takes no time itself: how long requests wait for others.
"""
import os
import shutil
import subprocess
import sys
import tempfile
import threading
import time

import roslib.packages
import rospy
from geometry_msgs.msg import Vector3
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger
from tf2_msgs.msg import TFMessage
from visualization_msgs.msg import Marker, MarkerArray

sys.path.insert(0, os.path.dirname(os.path.realpath(__file__)))
from bad_meshes import bad_files
from cable_client import CableClient, node_at, transform
from verlet_cable.srv import Unpin

PERIOD = 0.01  # [s] of the calls
LAST = 2**32 - 1  # [s] of ROS time
ROPE = 'materials: {rope: {linear_density: 0.1, radius: 0.005, drag: 0.2}}\n'
SCENE = ROPE + 'cables: [{name: rope, length: 1.0, segments: 50, material: rope, attachments: [{name: left, at: start}]}]\n'
LONGEST_TEXT = 2**20 - 1
CABLE = '  - {{name: r{0}, length: 1.0, segments: 10, material: rope, attachments: [{{name: a{0}, at: start, offset: [{0}, 0, 0]}}]}}\n'


def stamp(seconds):
    """As it stands, also where rospy would refuse to make it."""
    result = rospy.Time()
    result.secs = seconds
    return result


def late_tf(_):
    publisher = rospy.Publisher('/tf', TFMessage, queue_size=1000)
    number = 0
    while True:
        messages = [transform(f'hand{number % 50}', 0, (0, 0, 1)) for _ in range(20)]
        for i, message in enumerate(messages):
            message.header.stamp = stamp(LAST - 60 + i)
        publisher.publish(messages)
        number += 1
        yield 0.001


def late_clock(_):
    clock = rospy.Publisher('/clock', Clock, queue_size=1000)
    tf = rospy.Publisher('/tf', TFMessage, queue_size=1000)
    number = 0
    while True:
        for at in (100 + number, LAST - 60, LAST, 2**31):
            clock.publish(stamp(at))
            message = transform('hand', 0)
            message.header.stamp = stamp(at)
            tf.publish([message])
            yield 0.005
        number += 1


def marker(number, **fields):
    message = Marker(ns='seen', id=number, type=Marker.SPHERE, **fields)
    message.header.frame_id = 'world'
    message.pose.orientation.w = 1
    message.pose.position.z = -5
    message.scale = Vector3(0.1, 0.1, 0.1)
    return message


def meshes(directory):
    publisher = rospy.Publisher('/attacked/obstacles', MarkerArray, queue_size=1000)
    for name, content in bad_files().items():
        with open(os.path.join(directory, name), 'wb') as file:
            file.write(content)
    while True:
        for number, name in enumerate(bad_files()):
            mesh = marker(number, mesh_resource=f'file://{directory}/{name}')
            mesh.type = Marker.MESH_RESOURCE
            publisher.publish([mesh])
        yield 0.5


def load(texts):
    node = CableClient('/attacked')
    said = set()
    while True:
        for text in texts:
            begin = time.monotonic()
            answer = node.load_scene(yaml=text)
            if answer.message[:40] not in said:  # that the attack is what it should be
                said.add(answer.message[:40])
                print(f'    {len(text)} bytes, {time.monotonic() - begin:.2f} s: {answer.message[:100]}', file=sys.stderr)
            yield 0


def robots(directory):
    link = '<link name="l{0}"/><joint name="j{0}" type="fixed"><parent link="l{0}"/><child link="l{1}"/></joint>'
    links = ''.join(link.format(i, i + 1) for i in range(20000))
    bombs = {
        'chain': f'<robot name="r">{links}<link name="l20000"/></robot>',
        'nested': '<robot name="r">' + '<a>' * 100000 + '</a>' * 100000 + '</robot>',
        'entities': '<!DOCTYPE r [<!ENTITY a "aaaaaaaaaa">' + ''.join(
            f'<!ENTITY {chr(98 + i)} "{("&" + chr(97 + i) + ";") * 10}">' for i in range(10)) + ']><robot name="r">&k;</robot>',
    }
    for name, text in bombs.items():
        with open(os.path.join(directory, name + '.urdf'), 'w') as file:
            file.write(text)
    yield from load([SCENE + f'robot: {{file: "{directory}/{name}.urdf"}}\n' for name in bombs])


def long_text(cable):
    """Just below the longest that is taken."""
    text = ROPE + 'cables:\n'
    for i in range(100000):
        line = cable.format(i)
        if len(text) + len(line) > LONGEST_TEXT:
            return text
        text += line


def valid_texts(_):
    # Comments and blanks make it long: the cables, which are simulated afterwards, are as before.
    few = ROPE + 'cables:\n' + ''.join(CABLE.format(i) for i in range(5))
    points = 74001
    long_list = SCENE.replace('cables: [', 'cables: [{name: long, length: 1.0, segments: 5, material: rope, initial: {type: points, points: ['
                              + ','.join('[%.5f,0,0]' % (i / (points - 1)) for i in range(points)) + ']}}, ')
    yield from load([few + '#' * (LONGEST_TEXT - len(few)), few + ' \n' * ((LONGEST_TEXT - len(few)) // 2), long_list])


def many_cables(_):
    """Between two loads the resets are those of a large scene, which take as long as it takes to build."""
    text = ROPE + 'cables:\n' + ''.join(CABLE.format(i) for i in range(1500))
    yield from load([text + '#' * (LONGEST_TEXT - len(text)), SCENE])


def slow_scenes(_):
    """Of one cable that takes seconds to build; in between, scenes that do not wait for it."""
    slow = SCENE.replace('drag: 0.2', 'drag: 0.2, bending_stiffness: 1.0').replace('segments: 50', 'segments: 30000')
    slow = slow.replace('at: start', 'at: start, type: clamp')
    threading.Thread(target=lambda: list(load([slow])), daemon=True).start()
    time.sleep(1)
    for _ in load([SCENE]):
        yield 1


def back_and_forth(_):
    """A clock, and a scene of many cables that is built anew each time it goes back: until then resets are refused."""
    clock = rospy.Publisher('/clock', Clock, queue_size=1000)
    many = ROPE + 'cables:\n' + ''.join(CABLE.format(i) for i in range(1500))
    CableClient('/attacked').load_scene(yaml=many)
    while True:
        for i in range(100):
            message = Clock()
            message.clock = rospy.Time.from_sec(100 + 0.02 * i)
            clock.publish(message)
            yield 0.02


def invalid_texts(_):
    bad = long_text('  - {{name: r{0}, length: -1.0, segments: 10, material: nope, attachments: [{{name: a, at: 7}}]}}\n')
    yield from load([bad, '[' * LONGEST_TEXT, '{a: ' * (LONGEST_TEXT // 4), 'a: &a [' + 'x, ' * 300000 + ']', bad[:-3], '- ' * 500000])


def steps(_):
    node = CableClient('/attacked')
    node.pause(True)
    while True:
        node.step(30000)
        yield 0


def pins(_):
    clients = [CableClient('/attacked') for _ in range(3)]

    def flood(node, name):
        number = 0
        while True:
            number += 1
            node.pin(node_at('rope', 10 + number % 40), name=name, frame_id='world', position=(number % 7, 0, 0))
            node.pin(node_at('rope', 5), name='bad', frame_id=f'nothing{number}')
            node.unpin(name)

    for i, node in enumerate(clients):
        threading.Thread(target=flood, args=(node, f'p{i}'), daemon=True).start()
    while True:
        yield 1


def obstacles(_):
    publisher = rospy.Publisher('/attacked/obstacles', MarkerArray, queue_size=1000)
    batches = [[marker(1000 * k + i) for i in range(1000)] for k in range(5)] + [[marker(0, action=Marker.DELETEALL)]]
    while True:
        for batch in batches:
            publisher.publish(batch)
            yield 0.02


ATTACKS = {f.__name__: f for f in (late_tf, late_clock, meshes, robots, valid_texts, invalid_texts, many_cables, slow_scenes, back_and_forth, steps,
                                  pins, obstacles)}
SIMULATED_TIME = ('late_clock', 'back_and_forth')


def attack(name, directory):
    rospy.init_node('attack', disable_rostime=True)
    for pause in ATTACKS[name](directory):
        time.sleep(pause)


class Calls:
    """Of a service, one after the other over a connection that stays open."""

    def __init__(self, service, kind, seconds, *arguments, expected=True):
        self.durations = []
        self.problems = 0
        rospy.wait_for_service(service, 20)
        proxy = rospy.ServiceProxy(service, kind, persistent=True)
        self._call = lambda: proxy(*arguments).success == expected
        self._thread = threading.Thread(target=self._run, args=(seconds,), daemon=True)
        self._thread.start()

    def _run(self, seconds):
        begin = time.monotonic()
        due = begin
        while due < begin + seconds:
            time.sleep(max(0.0, due - time.monotonic()))
            asked = time.monotonic()
            self.problems += not self._call()
            now = time.monotonic()
            self.durations.append(1e3 * (now - asked))
            due = max(due + PERIOD, now)

    def result(self):
        self._thread.join()
        d = sorted(self.durations)
        over = sum(x > 50 for x in d)
        return f'{len(d):6d} {d[len(d) // 2]:7.1f} {d[int(0.99 * len(d))]:7.1f} {d[-1]:7.1f} {over:5d} {self.problems:5d}'


def node(name, directory):
    clock = ['/clock:=/alone/clock', '/tf:=/alone/tf'] if name == 'alone' else []
    rospy.set_param(f'/{name}', {'materials': {'rope': {'linear_density': 0.1, 'radius': 0.005, 'drag': 0.2}}, 'scene_directory': directory,
                                 'cables': [{'name': 'rope', 'length': 1.0, 'segments': 50, 'material': 'rope',
                                             'attachments': [{'name': 'left', 'at': 'start'}]}]})
    program = roslib.packages.find_node('verlet_cable', 'cable_node')[0]
    return subprocess.Popen([program] + [f'__name:={name}'] + clock,
                            stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)


def end(process):
    process.kill()
    process.wait()


def main():
    seconds = float(sys.argv[1]) if len(sys.argv) > 1 else 10
    rospy.init_node('reset_latency', disable_rostime=True)
    directory = tempfile.mkdtemp()
    columns = f'{"calls":>6s} {"median":>7s} {"99 %":>7s} {"max":>7s} {">50":>5s} {"ref.":>5s}'
    titles = ('reset of the attacked', 'unpin of the attacked', 'reset of the one left alone')
    print(f'{"":14s}' + '  '.join(f'{t:42s}' for t in titles) + f'\n{"":14s}' + '  '.join([columns] * 3), flush=True)
    try:
        for name in sys.argv[2:] or ['nothing', *ATTACKS]:
            measure(name, seconds, directory)
    finally:
        shutil.rmtree(directory)


def measure(name, seconds, directory):
    rospy.set_param('/use_sim_time', name in SIMULATED_TIME)
    nodes = [node(n, directory) for n in ('attacked', 'alone')]
    ticking = rospy.Publisher('/alone/clock', Clock, queue_size=10)
    stop = threading.Event()

    def tick():
        while not stop.wait(0.01):
            ticking.publish(rospy.Time.from_sec(time.time()))

    ticker = threading.Thread(target=tick, daemon=True)
    if name in SIMULATED_TIME:
        ticker.start()
    attacker = None
    try:
        for n in ('attacked', 'alone'):
            rospy.wait_for_service(f'/{n}/reset', 20)
        time.sleep(1)
        if name != 'nothing':
            attacker = subprocess.Popen([sys.executable, os.path.realpath(__file__), '--attack', name, directory])
        time.sleep(1)
        calls = [Calls('/attacked/reset', Trigger, seconds), Calls('/attacked/unpin', Unpin, seconds, 'nothing', expected=False),
                 Calls('/alone/reset', Trigger, seconds)]
        print(f'{name:14s}' + '  '.join(c.result() for c in calls), f'  load {os.getloadavg()[0]:.1f}', flush=True)
        if nodes[0].poll() is not None:
            print(f'{name}: the node has ended: {nodes[0].returncode}')
    finally:
        stop.set()
        for process in [attacker] * (attacker is not None) + nodes:
            end(process)


if __name__ == '__main__':
    if '--attack' in sys.argv:
        attack(*sys.argv[2:4])
    else:
        main()
