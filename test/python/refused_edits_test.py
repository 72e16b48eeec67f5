"""Copies of edited worlds have the same bytes, and edits that are refused change nothing."""
import copy
import threading

import pytest
from worlds import IDENTITY, world_of

from verlet_cable.sim import SceneError


def edit_everything(world):
    world.pin('second', node=3, frame_id='hand', keep_offset=True)
    world.set_obstacle('ball', type='sphere', radius=0.1, pose=[0.5, 0, -0.4, 0, 0, 0])
    world.step(20)
    world.cut('first', node=6)
    world.set_frame('hand', [0, 0.01, 0], IDENTITY)
    world.set_length('second', True, 1.2, 0.5)
    world.step(20)
    world.tune(gravity=[0, 0, -5])
    world.remove_obstacle('ball')
    world.move_attachment('left', [0, 0, 0.01, *IDENTITY])
    world.step(20)


def test_copies_go_on_with_the_same_bytes(ropes):
    world = world_of(ropes)
    world.step(7)
    others = [world.copy(), copy.copy(world), copy.deepcopy(world), world_of(ropes)]
    others[-1].step(7)
    edit_everything(world)
    again = world.copy()
    for other in others:
        edit_everything(other)
        assert other.state_hash == world.state_hash
        assert other.events()[-2:] == world.copy().events()[-2:]
    world.step(30)
    again.step(30)
    assert again.state_hash == world.state_hash


NAN = float('nan')
REFUSED = [
    ('pin', {'cable': 'rope', 'node': 1}, KeyError, 'cable: "rope"; allowed: first, second, plug'),
    ('pin', {'cable': '', 'node': 1}, KeyError, 'cable: ""'),
    ('pin', {'cable': 'second'}, ValueError, 'node, arc_length, point: 0 of them given; allowed: exactly one'),
    ('pin', {'cable': 'second', 'node': 1, 'point': [0, 0, 0]}, ValueError, '2 of them given'),
    ('pin', {'cable': 'second', 'node': 11}, ValueError, 'node: 11; allowed: 0 to 10'),
    ('pin', {'cable': 'second', 'node': -1}, ValueError, 'node: -1; allowed: 0 to 10'),
    ('pin', {'cable': 'second', 'node': 1.5}, TypeError, ''),
    ('pin', {'cable': 'second', 'arc_length': NAN}, ValueError, 'arc_length: nan; allowed: 0 to 1 m'),
    ('pin', {'cable': 'second', 'arc_length': 1.1}, ValueError, 'arc_length: 1.1; allowed: 0 to 1 m'),
    ('pin', {'point': [0, 0]}, ValueError, 'point: shape \\(2,\\); allowed: \\(3,\\)'),
    ('pin', {'point': [0, NAN, 0]}, ValueError, '^point: \\(0, nan, 0\\)'),
    ('pin', {'point': [0, 0, 0], 'point_frame': 'moon'}, KeyError, 'point_frame: "moon"'),
    ('pin', {'cable': 'second', 'node': 1, 'point_frame': 'world'}, ValueError, 'point_frame: "world" without a point'),
    ('pin', {'cable': 'second', 'node': 1, 'frame_id': '/hand'}, ValueError, 'frame_id: "/hand"'),
    ('pin', {'cable': 'second', 'node': 1, 'frame_id': 'a b'}, ValueError, 'frame_id: "a b"'),
    ('pin', {'cable': 'second', 'node': 1, 'name': '1st'}, ValueError, 'name: "1st"'),
    ('pin', {'cable': 'second', 'node': 1, 'name': 'left'}, ValueError, 'name: "left"; allowed: names that no attachment has'),
    ('pin', {'cable': 'first', 'node': 0, 'frame_id': 'hand'}, ValueError, 'node 0 of cable "first" is held by'),
    ('pin', {'cable': 'first', 'node': 5, 'frame_id': 'hand', 'offset': [3, 0, 0, 0, 0, 0, 1]}, ValueError, 'offset.position'),
    ('pin', {'cable': 'second', 'node': 5, 'offset': [0, 0, 0, 0, 0, 0, 2]}, ValueError, 'offset.orientation'),
    ('pin', {'cable': 'second', 'node': 5, 'offset': [0, 0, NAN, 0, 0, 0, 1]}, ValueError, 'offset.position'),
    ('pin', {'cable': 'second', 'node': 5, 'offset': [0, 0, 0, 1]}, ValueError, 'offset: shape \\(4,\\); allowed: \\(7,\\)'),
    ('pin', {'cable': 'rope', 'node': 1, 'name': '1st'}, ValueError, 'cable: "rope".*; name: "1st"'),
    ('pin', {'cable': 'second', 'node': 5, 'frame_id': 'plug', 'clamp': True, 'keep_offset': True}, ValueError, 'by a hinge'),
    ('pin', {'cable': 'first', 'node': 0, 'frame_id': 'hand'}, ValueError, '^node: '),
    ('pin', {'cable': 'plug', 'arc_length': 0.1}, ValueError, 'arc_length for body "plug"; allowed: node$'),
    ('pin', {'cable': '\ud800', 'node': 1}, ValueError, r"cable: '\\ud800'; allowed: text"),
    ('pin', {'cable': 'second', 'node': 1, 'frame_id': '\ud800'}, ValueError, r"frame_id: '\\ud800'; allowed: text"),
    ('unpin', {'name': '\ud800'}, ValueError, 'name: '),
    ('cut', {'point': [0, 0, 0], 'point_frame': '\ud800'}, ValueError, 'point_frame: '),
    ('set_obstacle', {'name': '\ud800', 'type': 'plane'}, ValueError, 'name: '),
    ('set_obstacle', {'name': 'ball', 'type': 'mesh', 'uri': 'x', 'directory': 'a\0b'}, ValueError, 'directory: '),
    ('unpin', {'name': 'grip'}, KeyError, 'name: "grip" is no attachment; allowed: left'),
    ('cut', {'cable': 'rope', 'node': 1}, KeyError, 'cable: "rope"; allowed: first, second'),
    ('cut', {'cable': 'plug', 'node': 0}, KeyError, 'cable: "plug"; allowed: first, second'),
    ('cut', {'cable': 'first', 'node': 0}, ValueError, 'so that each piece keeps one'),
    ('cut', {'cable': 'first', 'arc_length': 1.0}, ValueError, 'so that each piece keeps one'),
    ('cut', {'cable': 'first'}, ValueError, '0 of them given'),
    ('join', {'first': 'rope', 'first_at_end': True, 'second': 'second', 'second_at_end': False}, KeyError, 'first: "rope"'),
    ('join', {'first': 'first', 'first_at_end': True, 'second': 'rope', 'second_at_end': False}, KeyError, 'second: "rope"'),
    ('join', {'first': 'first', 'first_at_end': True, 'second': 'first', 'second_at_end': True}, ValueError, ''),
    ('join', {'first': 'first', 'first_at_end': NAN, 'second': 'second', 'second_at_end': False}, TypeError, 'first_at_end: nan; allowed: True or False'),
    ('pin', {'cable': 'first', 'node': 5, 'clamp': NAN}, TypeError, 'clamp: nan; allowed: True or False'),
    ('set_length', {'cable': 'first', 'at_end': NAN, 'length': 1.5, 'speed': 1}, TypeError, 'at_end: nan; allowed: True or False'),
    ('set_length', {'cable': 'rope', 'at_end': True, 'length': 1, 'speed': 1}, KeyError, 'cable: "rope"; allowed: first, second'),
    ('set_length', {'cable': 'first', 'at_end': True, 'length': NAN, 'speed': 1}, ValueError, 'length: nan'),
    ('set_length', {'cable': 'first', 'at_end': True, 'length': 1e9, 'speed': 1}, ValueError, 'length'),
    ('set_length', {'cable': 'first', 'at_end': True, 'length': 1.5, 'speed': 0}, ValueError, 'speed: 0'),
    ('set_length', {'cable': 'first', 'at_end': False, 'length': 1.5, 'speed': 1, 'max_tension': -1}, ValueError, 'max_tension: -1'),
    ('set_tension', {'cable': 'rope', 'at_end': True, 'tension': 1, 'max_speed': 1, 'min_length': 0.1, 'max_length': 2}, KeyError,
     'cable: "rope"; allowed: first, second'),
    ('set_tension', {'cable': 'first', 'at_end': False, 'tension': -1, 'max_speed': NAN, 'min_length': 3, 'max_length': 2}, ValueError,
     '(?s)tension: -1.*max_speed: nan.*max_length: 2'),
    ('move_attachment', {'name': 'grip', 'offset': [0, 0, 0, 0, 0, 0, 1]}, KeyError, 'name: "grip"'),
    ('move_attachment', {'name': 'left', 'offset': [0, 0, NAN, 0, 0, 0, 1]}, ValueError, 'offset.position'),
    ('move_attachment', {'name': 'left', 'offset': [0, 0, 0, 1]}, ValueError, 'offset: shape'),
    ('add_frame', {'name': 'world', 'position': [0, 0, 0], 'quaternion_xyzw': IDENTITY}, ValueError, 'name: "world"'),
    ('add_frame', {'name': 'plug', 'position': [0, 0, 0], 'quaternion_xyzw': IDENTITY}, ValueError, 'name: "plug"'),
    ('add_frame', {'name': '/hand', 'position': [0, 0, 0], 'quaternion_xyzw': IDENTITY}, ValueError, 'name: "/hand"'),
    ('add_frame', {'name': 'hand', 'position': [0, NAN, 0], 'quaternion_xyzw': IDENTITY}, ValueError, 'position'),
    ('set_obstacle', {'name': 'ball', 'type': 'sphere'}, SceneError, '^radius: missing'),
    ('set_obstacle', {'name': 'ball', 'type': 'sphere', 'radius': -1, 'friction': NAN, 'frame': '/x'}, SceneError,
     '(?s)friction: ".nan".*frame: "/x".*radius: -1'),
    ('set_obstacle', {'name': 'ball', 'type': 'ball'}, SceneError, 'type: "?ball"?; allowed: plane'),
    ('set_obstacle', {'name': 'ball', 'type': 'sphere', 'radius': 1, 'colour': 1, 'frame': 'new'}, SceneError, 'colour'),
    ('set_obstacle', {'name': '1', 'type': 'sphere', 'radius': 1, 'frame': 'new'}, SceneError, 'name: "1"'),
    ('set_obstacle', {'name': 'ball', 'type': 'sphere', 'radius': object(), 'frame': b'x'}, SceneError,
     "(?s)radius: <class 'object'>; allowed: .*frame: <class 'bytes'>"),
    ('set_obstacle', {'name': 'ball', 'type': 'mesh', 'uri': 'file:///none.stl', 'frame': 'new'}, SceneError, 'uri'),
    ('remove_obstacle', {'name': 'ball'}, KeyError, 'name: "ball"; allowed: floor'),
    ('tune', {'gravity': [0, 0]}, ValueError, 'gravity: shape'),
    ('tune', {'gravity': [0, 0, NAN], 'wind': [1e10, 0, 0]}, SceneError, '(?s)tuning.gravity_z: nan.*tuning.wind_x: 1e\\+10'),
    ('tune', {'contact_friction': 0.1}, SceneError, 'contact_friction'),
    ('tune', {'gravity': [0, 0, 1], 'materials': {'rope': {'friction': 1}}}, KeyError, 'materials: "rope"; allowed: wire'),
    ('tune', {'gravity': [0, 0, 1], 'materials': {'wire': {'friction': -1}}}, SceneError, 'tuning.wire_friction: -1'),
    ('tune', {'materials': {'wire': {'axial_stiffness': 100}}}, SceneError, 'tuning.wire_axial_stiffness: 100; allowed: .inf'),
    ('tune', {'materials': {'wire': {'friction': [1, 2]}}}, ValueError, 'shape \\(2,\\); allowed: a number'),
]


@pytest.mark.parametrize('call, arguments, error, message', REFUSED)
def test_what_is_refused_changes_nothing(ropes, call, arguments, error, message):
    world = world_of(ropes)
    world.step(3)
    same = world.copy()
    names = ('cable_names', 'attachment_names', 'frame_names', 'body_names', 'obstacle_names')
    with pytest.raises(error, match=message) as raised:
        getattr(world, call)(**arguments)
    assert raised.type is error or error is not ValueError
    assert world.state_hash == same.state_hash and world.events() == []
    assert [getattr(world, name) for name in names] == [getattr(same, name) for name in names]
    world.step(3)
    same.step(3)
    assert world.state_hash == same.state_hash


def test_names_are_those_that_there_are(ropes):
    world = world_of(ropes)
    assert (world.cable_names, world.attachment_names, world.frame_names) == (['first', 'second'], ['left'], [])
    assert (world.body_names, world.obstacle_names) == (['plug'], ['floor'])
    assert (world.net_names, world.particle_names, world.guide_names) == ([], [], [])
    edit_everything(world)
    assert (world.cable_names, world.attachment_names) == (['first', 'second', 'first_2'], ['left', 'pin1'])
    assert world.frame_names == ['hand']
    assert world.obstacle_names == ['floor']


def test_a_world_that_another_thread_steps_is_not_edited(ropes):
    world = world_of(ropes)
    same = world.copy()
    calls = [lambda: world.pin('second', node=0, keep_offset=True), lambda: world.cut('first', node=3), world.events,
             lambda: world.set_obstacle('ball', type='sphere', radius=0.1), lambda: world.tune(gravity=[0, 0, 0]),
             lambda: world.remove_obstacle('floor'), lambda: world.frame_names, lambda: world.obstacle_names]
    thread = threading.Thread(target=world.step, args=(20000,))
    thread.start()
    while True:
        try:
            world.cable_names
            if not thread.is_alive():
                return  # this one did not run meanwhile: the machine is busy
        except RuntimeError:
            break
    for call in calls:
        try:
            call()
        except RuntimeError as error:
            assert 'in use by another thread' in str(error)
        else:
            return thread.join()  # it had ended
    thread.join()
    same.step(20000)
    assert world.state_hash == same.state_hash
