"""Edits of worlds from Python: what they do, what they refuse, and that they are those of cable_sim and of the node's services."""
import copy
import pickle
import threading

import numpy
import pytest

from verlet_cable.sim import Event, Pieces, Pinned, Scene, SceneError, World

IDENTITY = [0, 0, 0, 1]
WEIGHT = 0.1 * 9.81  # [N] of 1 m of `wire`
TABLE = {'type': 'box', 'pose': [0.3, 0, -0.3, 0, 0, 0], 'size': [1.0, 1.0, 0.1], 'friction': 0.4}


@pytest.fixture
def ropes(hang):
    """Two straight ropes along x, `first` held at its start and `second` behind its end, and a plug in the air."""
    hang['materials']['wire']['bending_stiffness'] = 0
    hang['cables'] = [
        {'name': 'first', 'length': 1.0, 'segments': 10, 'material': 'wire',
         'initial': {'type': 'straight', 'from': [0, 0, 0], 'to': [1, 0, 0]}, 'attachments': [{'name': 'left', 'at': 'start'}]},
        {'name': 'second', 'length': 1.0, 'segments': 10, 'material': 'wire',
         'initial': {'type': 'straight', 'from': [1.01, 0, 0], 'to': [2, 0, 0]}}]
    hang['bodies'] = [{'name': 'plug', 'mass': 0.1, 'inertia': [1e-4, 1e-4, 1e-4], 'pose': [0, 0, 1, 0, 0, 0]}]
    hang['obstacles'] = [{'name': 'floor', 'type': 'plane', 'pose': [0, 0, -3, 0, 0, 0]}]
    return hang


def world_of(scene, *options):
    return World(Scene.from_dict(scene), *options)


def quiet(world):
    """At rest: settled, and its forces measured."""
    assert world.settle()
    world.step(5)
    return world


# What edits do

def test_a_pin_holds_the_weight_of_a_hanging_cable(hang):
    world = world_of(hang)
    pinned = world.pin('hose', node=5, frame_id='crane', keep_offset=True)
    assert pinned == ('pin1', 5) and isinstance(pinned, Pinned) and (pinned.name, pinned.node) == pinned
    for name in ('left', 'right'):
        world.unpin(name)
    assert world.attachment_names == ['pin1']
    quiet(world)
    force = world.wrench('pin1')[:3]
    assert abs(force - [0, 0, -WEIGHT]).max() < 1e-6


def test_a_pin_takes_its_node_to_its_place(ropes):
    world = world_of(ropes)
    assert world.pin('second', arc_length=0.49, name='middle', offset=[1.5, 0.2, 0, *IDENTITY]) == ('middle', 5)
    world.step(400)
    assert abs(world.positions('second')[5] - [1.5, 0.2, 0]).max() < 1e-9


def test_a_pin_finds_the_nearest_of_all_cables(ropes):
    world = world_of(ropes)
    assert world.pin(point=(1.42, 0, 0.3), keep_offset=True) == ('pin1', 4)
    world.add_frame('camera', [1, 0, 0], [0, 0, 1, 0])
    world.pin(point=(0.5, 0, 0), point_frame='camera', name='seen', keep_offset=True)
    assert world.events()[-1][2:6] == ('first', 'seen', 5, 'world')


def test_a_clamp_holds_the_direction(hang):
    hang['cables'][0]['attachments'].pop()
    half = numpy.sqrt(0.5)
    sideways = {}
    for clamp in (True, False):
        world = world_of(hang)
        world.pin('hose', node=20, offset=[0.2, 0, 0, 0, 0, half, half], clamp=clamp)
        world.step(400)
        quiet(world)
        last = world.positions('hose')[-1] - world.positions('hose')[-2]
        sideways[clamp] = last[1] / numpy.linalg.norm(last)
    assert sideways[True] > 0.8 > 0.1 > abs(sideways[False])


def test_a_body_is_pinned_by_its_origin(ropes):
    world = world_of(ropes)
    assert world.pin('plug', node=0, frame_id='hand', keep_offset=True).node == 0
    world.step(200)
    assert abs(world.body_pose('plug')[:3] - [0, 0, 1]).max() < 1e-9
    assert abs(world.wrench('pin1')[2] + 0.1 * 9.81) < 1e-6


def test_the_fixed_frame_has_its_name(ropes):
    first, second = world_of(ropes), world_of(ropes)
    first.pin('second', node=3, frame_id='world', keep_offset=True)
    second.pin('second', node=3, keep_offset=True)
    assert first.state_hash == second.state_hash and first.frame_names == []


@pytest.mark.parametrize('place', [{'node': 7}, {'arc_length': 0.37}, {'point': [0.15, 0, -0.4]}])
def test_a_cut_keeps_all_mass(hang, place):
    world = world_of(hang)
    assert abs(quiet(world).wrench('left')[2] + world.wrench('right')[2] + WEIGHT) < 1e-6
    assert world.cut('hose', **place) == Pieces('hose', 'hose_2')
    assert world.cable_names == ['hose', 'hose_2']
    assert len(world.tension('hose')) + len(world.tension('hose_2')) == 19
    quiet(world)
    assert abs(world.wrench('left')[2] + world.wrench('right')[2] + WEIGHT) < 1e-6


def test_a_join_makes_one_cable_of_two(ropes):
    world = world_of(ropes)
    assert world.join(first='first', first_at_end=True, second='second', second_at_end=False) == 'first'
    assert world.cable_names == ['first'] and world.positions('first').shape == (21, 3)
    world.step(400)
    quiet(world)
    assert abs(world.wrench('left')[2] + 2 * WEIGHT) < 1e-6


def test_a_winch_pays_out_at_its_speed(ropes):
    world = world_of(ropes)
    world.set_length('first', False, 1.5, 0.5)
    world.step(400)
    rest = numpy.linalg.norm(numpy.diff(world.positions('first'), axis=0), axis=1).sum()
    assert abs(rest - 1.5) < 1e-3
    assert len(world.tension('first')) == 15


def test_an_attachment_is_moved_in_its_frame(hang):
    world = world_of(hang)
    for k in range(100):
        world.move_attachment('left', [0, 0, 1e-3 * (k + 1), *IDENTITY])
        world.step()
    assert abs(world.positions('hose')[0] - [0.6, 0, 0.1]).max() < 1e-9


def test_a_net_is_cut_and_pinned():
    scene = {'nets': [{'name': 'flag', 'mass': 0.1, 'links': 'spring', 'stiffness': 500, 'damping': 0.5,
                       'grid': {'rows': 3, 'columns': 3, 'spacing': 0.1}}]}
    world = world_of(scene)
    assert world.pin('flag', node=0, keep_offset=True).node == 0
    links = len(world.tension('flag'))
    assert world.cut('flag', node=8) == ('flag', '')
    assert len(world.tension('flag')) == links - 3
    assert world.events()[-1].type == 'CUT'


# Frames

def test_a_frame_of_a_pin_moves_by_set_frame(ropes):
    world = world_of(ropes)
    world.pin('second', node=0, frame_id='hand', keep_offset=True)
    assert world.frame_names == ['hand']
    start = world.positions('second')[0]
    world.step(3)
    assert abs(world.positions('second')[0] - start).max() < 1e-9
    for other in (world, world.copy(), copy.deepcopy(world)):
        for k in range(20):
            other.set_frame('hand', [0.002 * (k + 1), 0, 0], IDENTITY)
            other.step()
        assert abs(other.positions('second')[0] - start - [0.04, 0, 0]).max() < 1e-9
        other.step(10)
        assert abs(other.positions('second')[0] - start - [0.04, 0, 0]).max() < 1e-9
        assert other.state_hash == world.state_hash


def test_frames_of_edits_go_with_a_motion(hang):
    times = numpy.linspace(0, 1, 11)
    poses = numpy.zeros((11, 7))
    poses[:, 6] = 1
    poses[:, 0] = 0.6 + 0.1 * times
    alone, world = (world_of(hang, {'hand': (times, poses)}) for _ in range(2))
    world.add_frame('camera', [1, 2, 3], IDENTITY)
    world.set_obstacle('far', type='sphere', radius=0.1, frame='camera')
    world.step(50)
    alone.step(50)
    assert (world.positions('hose') == alone.positions('hose')).all()


def test_max_frame_speed_is_that_of_frames_of_edits_too(ropes):
    ropes['max_frame_speed'] = 0.2
    world = world_of(ropes)
    world.pin('second', node=0, frame_id='hand', keep_offset=True)
    world.set_frame('hand', [0.1, 0, 0], IDENTITY)
    world.step(20)
    assert abs(world.positions('second')[0] - [1.03, 0, 0]).max() < 1e-9
    world.step(100)
    assert abs(world.positions('second')[0] - [1.11, 0, 0]).max() < 1e-9


def robot(tmp_path, ropes):
    """`base` with a `tool` 0.3 m above it."""
    (tmp_path / 'robot.urdf').write_text('''<robot name="arm"><link name="base"/>
      <link name="tool"><collision><geometry><sphere radius="0.05"/></geometry></collision></link>
      <joint name="lift" type="prismatic"><parent link="base"/><child link="tool"/><origin xyz="0 0 0.3"/><axis xyz="0 0 1"/>
      <limit lower="0" upper="1" effort="1" velocity="1"/></joint></robot>''')
    ropes['robot'] = {'file': str(tmp_path / 'robot.urdf')}
    return ropes


def test_a_robots_link_carries_others_where_set_frame_takes_it(ropes, tmp_path):
    world = world_of(robot(tmp_path, ropes))
    if 'base' not in world.frame_names:
        world.pin('first', node=10, frame_id='base', keep_offset=True)
    world.pin('second', node=0, frame_id='tool', offset=[1.01, 0, -0.3, *IDENTITY])
    for k in range(20):
        world.set_frame('base', [0, 0, 0.002 * (k + 1)], IDENTITY)
        world.step()
    assert abs(world.positions('second')[0] - [1.01, 0, 0.04]).max() < 1e-9
    world.set_frame('tool', [0, 0, 0.34], IDENTITY)
    world.set_frame('base', [0, 0, 0.05], IDENTITY)
    world.step(5)
    assert abs(world.positions('second')[0] - [1.01, 0, 0.04]).max() < 1e-9


def test_a_robots_link_that_nothing_used_is_where_its_parent_has_it(ropes, tmp_path):
    scene = robot(tmp_path, ropes)
    scene['robot']['links'] = ['tool']
    world = world_of(scene)
    assert world.frame_names == ['tool']
    world.pin('plug', node=0, frame_id='base', keep_offset=True)
    assert world.frame_names == ['tool', 'base']
    world.pin('second', node=0, frame_id='tool', keep_offset=True)
    for k in range(10):
        world.set_frame('base', [0, 0, 0.002 * (k + 1)], IDENTITY)
        world.step()
    assert abs(world.positions('second')[0] - [1.01, 0, 0.02]).max() < 1e-9


# The same as cable_sim

def test_an_obstacle_that_is_set_is_one_of_the_scene(ropes, cable_sim):
    world, free = world_of(ropes), world_of(ropes)
    world.set_obstacle('table', **TABLE)
    world.step(100)
    free.step(100)
    ropes['obstacles'].append({'name': 'table', **TABLE})
    summary, _ = cable_sim(ropes, '--duration', '0.5')
    assert world.state_hash == summary['state_hash'] != free.state_hash
    assert world.obstacle_names == ['floor', 'table']


def test_an_obstacle_in_a_moving_frame_is_as_in_cable_sim(ropes, cable_sim, tmp_path):
    rows = [f'{0.05 * k},lift,0,0,{0.02 * k},0,0,0,1' for k in range(11)]
    (tmp_path / 'motion.csv').write_text('\n'.join(['t,frame,x,y,z,qx,qy,qz,qw', *rows]))
    world = world_of(ropes)
    world.set_obstacle('table', frame='lift', **TABLE)
    for k in range(100):
        world.set_frame('lift', [0, 0, 0.002 * (k + 1)], IDENTITY)
        world.step()
    ropes['obstacles'].append({'name': 'table', 'frame': 'lift', **TABLE})
    _, rows = cable_sim(ropes, '--duration', '0.5', '--rate', '2', '--motion', str(tmp_path / 'motion.csv'))
    assert rows[-1, 0] == 0.5
    assert abs(numpy.vstack([world.positions('first'), world.positions('second')]) - rows[-22:, 2:5]).max() < 1e-6


def test_what_is_tuned_at_first_is_as_in_a_scene(ropes, cable_sim):
    world = world_of(ropes)
    world.tune(gravity=[0.5, 0, -1.62], wind=[1, 2, 0], materials={'wire': {'bending_damping': 1e-3, 'drag': 0.02}})
    world.step(100)
    ropes['gravity'] = [0.5, 0, -1.62]
    ropes['fluid'] = {'velocity': [1, 2, 0]}
    ropes['materials']['wire'].update(bending_damping=1e-3, drag=0.02)
    summary, _ = cable_sim(ropes, '--duration', '0.5')
    assert world.state_hash == summary['state_hash']


def test_events_are_those_of_cable_sim(ropes, cable_sim):
    ropes['materials']['wire'].update(breaking_tension=1.2, maximum_tension=0.9)
    summary, _ = cable_sim(ropes, '--duration', '0.5')
    world = world_of(ropes)
    world.step(100)
    events = world.events()
    assert {'BROKE', 'LIMIT'} <= {event.type for event in events}
    assert [(e.time, e.type, e.cable, e.node, e.other) for e in events] == [
        (e['time'], e['type'], e['cable'], e['node'], e.get('other', '')) for e in summary['events'] if e['type'].isupper()]
    assert world.events() == []


def test_a_guide_that_lets_go_is_an_event(ropes, cable_sim):
    ropes['cables'][1]['initial'] = {'type': 'straight', 'from': [2, 0, 0], 'to': [2, 0, -1]}
    ropes['guides'] = [{'name': 'eye', 'cable': 'second', 'at': 0.2, 'frame': 'mast', 'offset': [2, 0, -0.2], 'type': 'eyelet'}]
    summary, _ = cable_sim(ropes, '--duration', '0.5')
    world = world_of(ropes)
    assert world.guide_names == ['eye']
    world.step(100)
    released, = world.events()
    assert released[1:4] == ('RELEASED', 'second', 'eye') and released.message == 'guide "eye" has let cable "second" go'
    assert [e['time'] for e in summary['events'] if e['type'] == 'RELEASED'] == [released.time]


# Obstacles

def test_an_obstacle_is_moved_and_removed(hang):
    world = world_of(hang)
    world.set_obstacle('table', **TABLE)
    world.step(200)
    assert world.positions('hose')[:, 2].min() > -0.26
    world.set_obstacle('table', **dict(TABLE, pose=[0.3, 0, -0.4, 0, 0, 0]))
    assert world.obstacle_names == ['table']
    world.step(200)
    assert -0.36 < world.positions('hose')[:, 2].min() < -0.26
    world.remove_obstacle('table')
    assert world.obstacle_names == []
    quiet(world)
    free = quiet(world_of(hang))
    assert abs(world.positions('hose') - free.positions('hose')).max() < 1e-4


def test_a_new_frame_of_an_obstacle_begins_at_its_initial_pose(hang):
    world, fixed = world_of(hang), world_of(hang)
    world.set_obstacle('table', **dict(TABLE, pose=[0, 0, 0, 0, 0, 0], frame='desk', initial_pose=TABLE['pose']))
    fixed.set_obstacle('table', **TABLE)
    world.step(100)
    fixed.step(100)
    assert abs(world.positions('hose') - fixed.positions('hose')).max() < 1e-6


def test_a_mesh_is_read_from_a_directory(hang, tmp_path):
    (tmp_path / 'wedge.obj').write_text('v 0 -1 -0.5\nv 1 -1 -0.5\nv 0 1 -0.5\nv 0 0 -0.2\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n')
    world = world_of(hang)
    with pytest.raises(SceneError, match='^uri: "wedge.obj"'):
        world.set_obstacle('wedge', type='mesh', uri='wedge.obj')
    world.set_obstacle('wedge', type='mesh', uri='wedge.obj', directory=tmp_path)
    assert world.obstacle_names == ['wedge']


# Tuning

def test_bending_stiffness_is_one_number_or_two(hang):
    world = world_of(hang)
    world.tune(materials={'wire': {'bending_stiffness': 0.02}})
    assert quiet(world).energy()['bend'] > 1.5 * quiet(world_of(hang)).energy()['bend']
    with pytest.raises(SceneError, match='"wire_bending_stiffness_y"; allowed: gravity_x'):
        world.tune(materials={'wire': {'bending_stiffness': [0.02, 0.01]}})
    hang['materials']['wire'].update(bending_stiffness=[0.02, 0.01], torsional_stiffness=0.01)
    ribbons = [world_of(hang) for _ in range(3)]
    ribbons[0].tune(materials={'wire': {'bending_stiffness': numpy.array([0.01, 0.01])}})
    ribbons[1].tune(materials={'wire': {'bending_stiffness': 0.01}})
    ribbons[2].tune(materials={'wire': {'bending_stiffness': (0.02, 0.01)}})
    assert ribbons[0].state_hash == ribbons[1].state_hash != ribbons[2].state_hash
    ribbons[0].tune(materials={'wire': {'bending_stiffness': [0.02, 0.01]}})
    assert ribbons[0].state_hash != ribbons[1].state_hash


def test_nothing_tuned_is_nothing_changed(hang):
    world = world_of(hang)
    before = world.state_hash
    world.tune()
    assert world.state_hash == before


# Events

def test_edits_are_events_with_the_fields_of_the_message(ropes):
    world = world_of(ropes)
    world.step(2)
    world.pin('second', node=2, name='grip', frame_id='hand', keep_offset=True)
    world.cut('first', node=4)
    world.unpin('grip')
    world.join('first', True, 'first_2', False)
    pinned, cut, unpinned, joined = events = world.events()
    assert all(event.time == world.time for event in events)
    assert pinned[1:6] == ('PINNED', 'second', 'grip', 2, 'hand')
    assert cut[1:6] == ('CUT', 'first', '', 4, 'first_2')
    assert unpinned[1:6] == ('UNPINNED', 'second', 'grip', 2, 'hand')
    assert joined[1:6] == ('JOINED', 'first', '', 4, 'first_2')
    assert pinned.message == 'node 2 of cable "second" is pinned to frame "hand" as "grip"'
    assert Event._fields == ('time', 'type', 'cable', 'attachment', 'node', 'other', 'message')
    assert pickle.loads(pickle.dumps(events)) == events
    assert world.events() == []


def test_a_jump_is_told_once_a_second(hang):
    hang['time_step'] = 0.002
    world = world_of(hang)
    for k in range(40):
        world.set_frame('hand', [0.6, 0, 0.05 * (k // 10 % 2)], IDENTITY)
        world.step()
    jumps = world.events()
    assert [event[1:6] for event in jumps] == [('JUMPED', 'hose', 'left', 0, 'hand')]


def test_unread_events_take_no_more_than_so_much_room(ropes):
    world = world_of(ropes)
    for k in range(700):
        world.pin('second', node=0, keep_offset=True)
        world.unpin('pin1')
    events = world.events()
    assert len(events) == 1001
    assert events[-1][1:] == ('more', '', '', 0, '', '400 more events')


def test_a_copy_has_the_events_that_were_not_read(ropes):
    world = world_of(ropes)
    world.pin('second', node=0, keep_offset=True)
    other = world.copy()
    assert len(other.events()) == 1
    other.cut('first', node=4)
    assert [event.type for event in world.events()] == ['PINNED']


# Copies, and what is refused

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
    ('pin', {'cable': 'rope', 'node': 1}, KeyError, 'location.cable: "rope"; allowed: first, second, plug'),
    ('pin', {'cable': '', 'node': 1}, KeyError, 'location.cable: ""'),
    ('pin', {'cable': 'second'}, ValueError, 'node, arc_length, point: 0 of them given; allowed: exactly one'),
    ('pin', {'cable': 'second', 'node': 1, 'point': [0, 0, 0]}, ValueError, '2 of them given'),
    ('pin', {'cable': 'second', 'node': 11}, ValueError, 'location.node: 11; allowed: 0 to 10'),
    ('pin', {'cable': 'second', 'node': -1}, ValueError, 'location.node: -1; allowed: 0 to 10'),
    ('pin', {'cable': 'second', 'node': 1.5}, TypeError, ''),
    ('pin', {'cable': 'second', 'arc_length': NAN}, ValueError, 'location.arc_length: nan; allowed: 0 to 1 m'),
    ('pin', {'cable': 'second', 'arc_length': 1.1}, ValueError, 'location.arc_length: 1.1; allowed: 0 to 1 m'),
    ('pin', {'point': [0, 0]}, ValueError, 'point: shape \\(2,\\); allowed: \\(3,\\)'),
    ('pin', {'point': [0, NAN, 0]}, ValueError, 'location.point.point: \\(0, nan, 0\\)'),
    ('pin', {'point': [0, 0, 0], 'point_frame': 'moon'}, KeyError, 'location.point.header.frame_id: "moon"'),
    ('pin', {'cable': 'second', 'node': 1, 'point_frame': 'world'}, ValueError, 'point_frame: "world" without a point'),
    ('pin', {'cable': 'second', 'node': 1, 'frame_id': '/hand'}, ValueError, 'frame_id: "/hand"'),
    ('pin', {'cable': 'second', 'node': 1, 'frame_id': 'a b'}, ValueError, 'frame_id: "a b"'),
    ('pin', {'cable': 'second', 'node': 1, 'name': '1st'}, ValueError, 'name: "1st"'),
    ('pin', {'cable': 'second', 'node': 1, 'name': 'left'}, ValueError, 'name: "left"; allowed: names that no attachment has'),
    ('pin', {'cable': 'first', 'node': 0, 'frame_id': 'hand'}, ValueError, 'node 0 of cable "first" is held by'),
    ('pin', {'cable': 'first', 'node': 5, 'frame_id': 'hand', 'offset': [3, 0, 0, 0, 0, 0, 1]}, ValueError, 'offset.position'),
    ('pin', {'cable': 'second', 'node': 5, 'offset': [0, 0, 0, 0, 0, 0, 2]}, ValueError, 'offset.orientation'),
    ('pin', {'cable': 'second', 'node': 5, 'offset': [0, 0, NAN, 0, 0, 0, 1]}, ValueError, 'offset.position'),
    ('pin', {'cable': 'second', 'node': 5, 'offset': [0, 0, 0]}, ValueError, 'offset: shape \\(3,\\); allowed: \\(7,\\)'),
    ('pin', {'cable': 'rope', 'node': 1, 'name': '1st'}, ValueError, 'location.cable: "rope".*; name: "1st"'),
    ('pin', {'cable': 'second', 'node': 5, 'frame_id': 'plug', 'clamp': True, 'keep_offset': True}, ValueError, 'by a hinge'),
    ('unpin', {'name': 'grip'}, KeyError, 'name: "grip" is no attachment; allowed: left'),
    ('cut', {'cable': 'rope', 'node': 1}, KeyError, 'location.cable: "rope"; allowed: first, second'),
    ('cut', {'cable': 'plug', 'node': 0}, KeyError, 'location.cable: "plug"; allowed: first, second'),
    ('cut', {'cable': 'first', 'node': 0}, ValueError, 'so that each piece keeps one'),
    ('cut', {'cable': 'first', 'arc_length': 1.0}, ValueError, 'so that each piece keeps one'),
    ('cut', {'cable': 'first'}, ValueError, '0 of them given'),
    ('join', {'first': 'rope', 'first_at_end': True, 'second': 'second', 'second_at_end': False}, KeyError, 'first: "rope"'),
    ('join', {'first': 'first', 'first_at_end': True, 'second': 'rope', 'second_at_end': False}, KeyError, 'second: "rope"'),
    ('join', {'first': 'first', 'first_at_end': True, 'second': 'first', 'second_at_end': True}, ValueError, ''),
    ('set_length', {'cable': 'rope', 'at_end': True, 'length': 1, 'speed': 1}, KeyError, 'cable: "rope"; allowed: first, second'),
    ('set_length', {'cable': 'first', 'at_end': True, 'length': NAN, 'speed': 1}, ValueError, 'length: nan'),
    ('set_length', {'cable': 'first', 'at_end': True, 'length': 1e9, 'speed': 1}, ValueError, 'length'),
    ('set_length', {'cable': 'first', 'at_end': True, 'length': 1.5, 'speed': 0}, ValueError, 'speed: 0'),
    ('move_attachment', {'name': 'grip', 'offset': [0, 0, 0, 0, 0, 0, 1]}, KeyError, 'name: "grip"'),
    ('move_attachment', {'name': 'left', 'offset': [0, 0, NAN, 0, 0, 0, 1]}, ValueError, 'offset.position'),
    ('move_attachment', {'name': 'left', 'offset': [0, 0, 0]}, ValueError, 'offset: shape'),
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
    ('set_obstacle', {'name': 'ball', 'type': 'sphere', 'radius': object()}, TypeError, 'obstacle: '),
    ('set_obstacle', {'name': 'ball', 'type': 'mesh', 'uri': 'file:///none.stl', 'frame': 'new'}, SceneError, 'uri'),
    ('remove_obstacle', {'name': 'ball'}, KeyError, 'obstacle: "ball"; allowed: floor'),
    ('tune', {'gravity': [0, 0]}, ValueError, 'gravity: shape'),
    ('tune', {'gravity': [0, 0, NAN], 'wind': [1e10, 0, 0]}, SceneError, '(?s)tuning.gravity_z: nan.*tuning.wind_x: 1e\\+10'),
    ('tune', {'contact_friction': 0.1}, SceneError, 'contact_friction'),
    ('tune', {'gravity': [0, 0, 1], 'materials': {'rope': {'friction': 1}}}, KeyError, 'materials: "rope"; allowed: wire'),
    ('tune', {'gravity': [0, 0, 1], 'materials': {'wire': {'friction': -1}}}, SceneError, 'tuning.wire_friction: -1'),
    ('tune', {'materials': {'wire': {'axial_stiffness': 100}}}, SceneError, '"wire_axial_stiffness"'),
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
