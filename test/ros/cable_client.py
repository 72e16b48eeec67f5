"""What the tests of a running node share: frames that are sent on tf, messages that are collected, services that are called."""
import math
import threading
import time
import xmlrpc.client

import rosgraph
import rospy
from geometry_msgs.msg import Point, Quaternion, TransformStamped, Vector3
from std_srvs.srv import SetBool, Trigger
from tf2_msgs.msg import TFMessage

from verlet_cable.msg import CableArray, CableEvent, CableLocation
from verlet_cable.srv import Cut, Join, LoadScene, Pin, PinRequest, RestoreState, SaveState, SetLength, SetTension, Step, Unpin

STARTING = 30.0  # [s] of wall time in which a node that is just started has its services
PATIENCE = 5.0  # [s] of wall time, far more than anything here takes on a busy machine


def transform(frame, stamp, position=(0, 0, 0), rotation=(0, 0, 0, 1), parent='world'):
    """`stamp`: a time, or seconds."""
    message = TransformStamped()
    message.header.frame_id = parent
    message.header.stamp = stamp if isinstance(stamp, rospy.Time) else rospy.Time.from_sec(stamp)
    message.child_frame_id = frame
    message.transform.translation = Vector3(*position)
    message.transform.rotation = Quaternion(*rotation)
    return message


class Frames:
    """Sends frames on tf at 100 Hz of ROS time, as functions of time that give a position or (position, rotation)."""

    def __init__(self, **motions):
        self.motions = motions
        self._publisher = rospy.Publisher('/tf', TFMessage, queue_size=100)
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._stop.set()
        self._thread.join()

    def _run(self):
        while not self._stop.wait(0.01):
            now = rospy.get_time()
            transforms = []
            for frame, motion in list(self.motions.items()):
                pose = motion(now)
                position, rotation = pose if len(pose) == 2 else (pose, (0, 0, 0, 1))
                transforms.append(transform(frame, now, position, rotation))
            if transforms:
                self._publisher.publish(transforms)


class Messages:
    """Everything that comes on a topic, from when it is connected: `with Messages(...) as messages`."""

    def __init__(self, topic, kind):
        self._new = threading.Condition()
        self._messages = []
        self._subscriber = rospy.Subscriber(topic, kind, self._receive, queue_size=1000)

    def __enter__(self):
        deadline = time.monotonic() + PATIENCE
        while self._subscriber.get_num_connections() == 0:
            if time.monotonic() > deadline:
                raise AssertionError(f'{self._subscriber.name}: nobody publishes it')
            time.sleep(0.01)
        return self

    def __exit__(self, *_):
        self._subscriber.unregister()

    def _receive(self, message):
        with self._new:
            self._messages.append(message)
            self._new.notify_all()

    def all(self):
        with self._new:
            return list(self._messages)

    def clear(self):
        with self._new:
            self._messages.clear()

    def wait_for(self, wanted, what, patience=PATIENCE):
        """The first message, of those that are there and those to come, for which `wanted` is true."""
        deadline = time.monotonic() + patience
        checked = 0
        with self._new:
            while True:
                for message in self._messages[checked:]:
                    if wanted(message):
                        return message
                checked = len(self._messages)
                left = deadline - time.monotonic()
                if left <= 0 or not self._new.wait(left):
                    raise AssertionError(f'{self._subscriber.name}: no {what} in {patience} s, of {checked} messages')

    def next(self, count=1):
        """The `count`th message from now on."""
        with self._new:
            number = len(self._messages) + count
        self.wait_for(lambda _: len(self._messages) >= number, f'{count} messages')
        return self.all()[number - 1]


class CableClient:
    """Topics and services of one node."""

    def __init__(self, name):
        self.name = name

        def service(topic, kind):
            rospy.wait_for_service(f'{name}/{topic}', STARTING)
            return rospy.ServiceProxy(f'{name}/{topic}', kind)

        self.reset = service('reset', Trigger)
        self.pause = service('pause', SetBool)
        self.step = service('step', Step)
        self.unpin = service('unpin', Unpin)
        self.set_length = service('set_length', SetLength)
        self.set_tension = service('set_tension', SetTension)
        self.join = service('join', Join)
        self.save_state = service('save_state', SaveState)
        self.restore_state = service('restore_state', RestoreState)
        self._load_scene = service('load_scene', LoadScene)
        self._cut = service('cut', Cut)
        self._pin = service('pin', Pin)

    def pin(self, location, position=(0, 0, 0), orientation=(0, 0, 0, 0), **fields):
        request = PinRequest(location=location, **fields)
        request.offset.position = Point(*position)
        request.offset.orientation = Quaternion(*orientation)
        return self._pin(request)

    def cut(self, location):
        return self._cut(location)

    def load_scene(self, file='', yaml=''):
        return self._load_scene(file, yaml)

    def states(self):
        return Messages(f'{self.name}/state', CableArray)

    def events(self):
        return Messages(f'{self.name}/events', CableEvent)

    def state(self):
        with self.states() as states:
            return states.next()


def process_of(node):
    """Its id."""
    caller = rospy.get_name()
    return xmlrpc.client.ServerProxy(rosgraph.Master(caller).lookupNode(node)).getPid(caller)[2]


class Processor:
    """What part of the time since then the node's main thread was not kept waiting for a processor that others had."""

    def __init__(self, node):
        self._file = f'/proc/{process_of(node)}/schedstat'
        self._begin, self._waited = time.monotonic(), self._waiting()

    def _waiting(self):
        with open(self._file) as file:
            return 1e-9 * int(file.read().split()[1])

    def share(self):
        return 1 - (self._waiting() - self._waited) / (time.monotonic() - self._begin)


def node_at(cable, node):
    return CableLocation(cable=cable, mode=CableLocation.NODE, node=node)


def arc_length_at(cable, arc_length):
    return CableLocation(cable=cable, mode=CableLocation.ARC_LENGTH, arc_length=arc_length)


def nearest_to(cable, position, frame=''):
    location = CableLocation(cable=cable, mode=CableLocation.NEAREST)
    location.point.header.frame_id = frame
    location.point.point = Point(*position)
    return location


def cable(state, name):
    """The cable of that name of a state, or None."""
    return next((c for c in state.cables if c.name == name), None)


def contents(state):
    """What a state says, without the number that the connection gave it."""
    return state.header.stamp, state.header.frame_id, state.cables, state.nets, state.particles, state.bodies


def distance(point, position):
    return math.dist((point.x, point.y, point.z), position)


def all_finite(state):
    shapes = state.cables + state.nets
    vectors = [v for s in shapes for v in s.positions + s.velocities]
    vectors += [v for p in state.particles for v in (p.position, p.velocity)]
    vectors += [v for b in state.bodies for v in (b.pose.position, b.twist.linear, b.twist.angular)]
    return all(math.isfinite(x) for v in vectors for x in (v.x, v.y, v.z)) and all(math.isfinite(x) for s in shapes for x in s.tension)
