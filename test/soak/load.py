"""Random requests: services, obstacles, rollouts, the mouse, live tuning."""
import random
import threading
import time

import actionlib
import rospy
import yaml
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from geometry_msgs.msg import Point, Pose, Quaternion, Vector3
from visualization_msgs.msg import InteractiveMarkerFeedback, Marker, MarkerArray

from cable_client import CableClient, arc_length_at, nearest_to, node_at, transform
from values import ATTACHMENTS, BAD_SCENES, CABLES, FRAMES, HANDLES, NUMBERS, PLACES, SHIPPED_SCENES, SNAPSHOTS, WORDS
from verlet_cable.msg import RolloutAction, RolloutGoal


class FixedNames:
    """What requests name: what the scene of scripts/soak has and may get."""

    cables, places, attachments, frames, handles = CABLES, PLACES, ATTACHMENTS, FRAMES, HANDLES


class LiveNames:
    """What requests name: what a scene began with, and what `watch` saw last."""

    frames = ['', 'world', 'hand']

    def __init__(self, text, watch):
        keys, self._watch = yaml.safe_load(text), watch
        self._cables = [cable['name'] for cable in keys['cables']]
        self._bodies = [body['name'] for body in keys['bodies']]
        self._attachments = [held['name'] for cable in keys['cables'] for held in cable.get('attachments', [])]

    @property
    def cables(self):
        state = self._watch.state
        return self._cables + [cable.name for cable in state.cables] if state else self._cables

    @property
    def places(self):
        return self.cables + self._bodies

    @property
    def attachments(self):
        state = self._watch.state
        return self._attachments + [name for cable in state.cables for name in cable.attachments] if state else self._attachments

    @property
    def handles(self):
        return [f'attachment/{name}' for name in self.attachments] + [f'{name}/1' for name in self.cables]


class Draws:
    """Random values of requests."""

    def __init__(self, seed, names=FixedNames()):
        self.choice, self.names = random.Random(seed), names

    def chance(self, probability):
        return self.choice.random() < probability

    def one_of(self, *values):
        return self.choice.choice(values)

    def number(self):
        return self.choice.choice(NUMBERS) if self.chance(0.2) else self.choice.uniform(0, 2)

    def word(self, sound):
        """One of those that mean something, mostly."""
        return self.choice.choice(sound if self.chance(0.9) else WORDS)

    def location(self, names=None):
        name, number = self.word(names or self.names.places), self.number()
        return self.one_of(lambda: node_at(name, self.one_of(0, 1, 5, 10, 20, 4294967295)), lambda: arc_length_at(name, number),
                           lambda: nearest_to(name, (number, 0, 0), self.word(self.names.frames)))()

    def pose(self):
        rotation = self.one_of((0, 0, 0, 1), (0, 0, 0, 1), (0, 0, 0, 1), (0, 0, 0, 0), (self.number(), 0, 0, 1))
        return Pose(Point(self.number(), self.number(), self.number()), Quaternion(*rotation))


class Caller:
    """Calls services one after the other, for as long as `run` is let. `calls` records each."""

    def __init__(self, seed, scene, calls, names=FixedNames()):
        self._draws, self._scene, self._calls = Draws(seed, names), scene, calls
        self._node = CableClient('/cable')
        self._tune = rospy.ServiceProxy('/cable/tuning/set_parameters', Reconfigure)
        self._tunable = []

    def run(self, stop):
        while not stop.is_set():
            name, request = self._request()
            answer = self._calls.made(name, request)
            if name == 'tune' and answer:
                self._tunable = [parameter.name for parameter in answer.config.doubles]

    def _request(self):
        d, node = self._draws, self._node
        requests = {
            'pin': lambda: node.pin(d.location(), (d.number(), 0, 0), name=d.one_of('', '', d.word(d.names.attachments)),
                                    frame_id=d.word(d.names.frames), clamp=d.chance(0.5), keep_offset=d.chance(0.7)),
            'unpin': lambda: node.unpin(d.word(d.names.attachments)),
            'cut': lambda: node.cut(d.location(d.names.cables)),
            'join': lambda: node.join(d.word(d.names.cables), d.chance(0.5), d.word(d.names.cables), d.chance(0.5)),
            'set_length': lambda: node.set_length(d.word(d.names.cables), d.chance(0.5), d.number(), d.number(),
                                                  d.number() if d.chance(0.3) else 0),
            'set_tension': lambda: node.set_tension(d.word(d.names.cables), d.chance(0.5), d.number(), d.number(), d.number(),
                                                    d.number()),
            'save_state': lambda: node.save_state(name=d.word(SNAPSHOTS)),
            'restore_state': lambda: node.restore_state(name=d.word(SNAPSHOTS)),
            'load_scene': self._load_scene,
            'pause': lambda: node.pause(d.chance(0.3)),
            'step': lambda: node.step(d.one_of(0, 1, 50, 4294967295)),
            'reset': node.reset,
            'tune': self._tune_something,
        }
        weights = [{'reset': 1, 'load_scene': 1, 'pause': 3}.get(name, 5) for name in requests]
        name = d.choice.choices(list(requests), weights)[0]
        return name, requests[name]

    def _load_scene(self):
        d = self._draws
        if d.chance(0.5):
            return self._node.load_scene(yaml=self._scene)
        if d.chance(0.5):
            return self._node.load_scene(file='package://verlet_cable/config/' + d.one_of(*SHIPPED_SCENES))
        return self._node.load_scene(file=d.one_of('', '/etc/passwd', 'package://verlet_cable/../../etc/passwd', d.word(WORDS)),
                                     yaml=d.one_of(*BAD_SCENES))

    def _tune_something(self):
        d = self._draws
        names = [d.one_of(*self._tunable)] if self._tunable and d.chance(0.8) else [d.word(WORDS)] * d.choice.randrange(3)
        return self._tune(Config(doubles=[DoubleParameter(name, d.number()) for name in names]))


class Tuner:
    """Moves the sliders of live tuning as fast as the node answers, again and again."""

    LONGEST = 500  # calls

    def __init__(self, seed, calls):
        self._draws, self._calls = Draws(seed), calls
        self.floods = 0

    def run(self, stop):
        while not stop.wait(self._draws.one_of(1, 5, 20)):
            # Stays connected, also while there is no master.
            tune = rospy.ServiceProxy('/cable/tuning/set_parameters', Reconfigure, persistent=True)
            values = self._calls.made('tune', lambda: tune(Config()))
            if values and values.config.doubles:
                self._flood(tune, [parameter.name for parameter in values.config.doubles], stop)
            tune.close()

    def _flood(self, tune, names, stop):
        self.floods += 1
        for _ in range(self._draws.choice.randrange(self.LONGEST)):
            name = self._draws.one_of(*names)
            if stop.is_set() or not self._calls.made('tune', lambda: tune(self._slider(name))):
                return

    def _slider(self, name):
        return Config(doubles=[DoubleParameter(name, self._draws.number())])


class Sender:
    """Sends what nobody answers: floods of obstacles, rollouts and the mouse."""

    def __init__(self, seed, names=FixedNames()):
        self._draws = Draws(seed, names)
        self._obstacles = rospy.Publisher('/cable/obstacles', MarkerArray, queue_size=10)
        self._mouse = rospy.Publisher('/cable/hands/feedback', InteractiveMarkerFeedback, queue_size=100)
        self._rollouts = actionlib.ActionClient('/cable/rollout', RolloutAction)
        self._goals = []
        self.sent = {'obstacle messages': 0, 'markers': 0, 'mouse events': 0, 'rollouts': 0, 'rollouts ended': 0}

    def run(self, stop):
        while not stop.is_set():
            self._draws.one_of(self._send_obstacles, self._move, self._move, self._roll_out)()
            time.sleep(self._draws.one_of(0, 0.01, 0.05))

    def _send_obstacles(self):
        count = self._draws.one_of(1, 1, 1, 5, 100)
        self._obstacles.publish([self._marker() for _ in range(count)])
        self.sent['obstacle messages'] += 1
        self.sent['markers'] += count

    def _marker(self):
        d = self._draws
        marker = Marker(ns='soak', id=d.choice.randrange(20), type=d.one_of(1, 1, 2, 3, 10, 0, 99),
                        action=d.choice.choice([0] * 10 + [2] * 10 + [3, 7]), pose=d.pose(),
                        mesh_resource=d.one_of('', 'package://none/a.stl', 'file:///etc/passwd', 'http://localhost:1/a.stl'))
        marker.header.frame_id = d.word(d.names.frames)
        size = d.one_of(0.1, 0.3, d.number())
        marker.scale = Vector3(size, size, size)
        return marker

    def _roll_out(self):
        d = self._draws
        motion = [transform(d.word(d.names.frames), d.one_of(0, 0.1, 0.5, 0.5, 1, 1e6), (d.number(), 0, 0))
                  for _ in range(d.choice.randrange(4))]
        goal = RolloutGoal(snapshot=d.word(SNAPSHOTS) if d.chance(0.3) else '', motion=motion, duration=d.number(), rate=d.number())
        self._goals.append(self._rollouts.send_goal(goal))
        self.sent['rollouts'] += 1
        if d.chance(0.3):
            d.one_of(*self._goals).cancel()
        ended = [goal for goal in self._goals if goal.get_comm_state() == actionlib.CommState.DONE]
        self.sent['rollouts ended'] += len(ended)
        self._goals = [goal for goal in self._goals if goal not in ended][-20:]

    def _move(self):
        d = self._draws
        feedback = InteractiveMarkerFeedback(client_id='soak', marker_name=d.one_of(*d.names.handles), event_type=d.choice.randrange(8),
                                             menu_entry_id=d.choice.randrange(6), pose=d.pose())
        feedback.header.frame_id = d.one_of('', 'world', 'world', 'hand', 'nowhere', 'x' * 100000)
        self._mouse.publish(feedback)
        self.sent['mouse events'] += 1


def start(workers, stop):
    threads = [threading.Thread(target=worker.run, args=(stop,), daemon=True) for worker in workers]
    for thread in threads:
        thread.start()
    return threads
