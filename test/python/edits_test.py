"""Pins, cuts, joins, winches, tuning and frames from Python."""
import copy

import numpy
import pytest
from worlds import IDENTITY, quiet, world_of

from verlet_cable.sim import Pieces, Pinned, SceneError

WEIGHT = 0.1 * 9.81  # [N] of 1 m of `wire`


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


def test_a_winch_keeps_a_tension_in_copies_too(ropes):
    world = world_of(ropes)
    quiet(world)
    world.set_tension('first', at_end=False, tension=0.9 * WEIGHT, max_speed=0.5, min_length=0.2, max_length=3)
    other = world.copy()
    for each in (world, other):
        each.step(40)
        assert abs(each.tension('first')[0] - 0.9 * WEIGHT) < 0.01 * WEIGHT
    assert world.state_hash == other.state_hash
    world.set_length('first', False, 1.0, 0.5, max_tension=0.5 * WEIGHT)
    world.step(40)
    assert world.tension('first')[0] < 0.51 * WEIGHT


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


def test_what_is_tuned_at_first_is_as_in_a_scene(ropes, cable_sim):
    world = world_of(ropes)
    world.tune(gravity=[0.5, 0, -1.62], wind=[1, 2, 0], materials={'wire': {'bending_damping': 1e-3, 'drag': 0.02}})
    world.step(100)
    ropes['gravity'] = [0.5, 0, -1.62]
    ropes['fluid'] = {'velocity': [1, 2, 0]}
    ropes['materials']['wire'].update(bending_damping=1e-3, drag=0.02)
    summary, _ = cable_sim(ropes, '--duration', '0.5')
    assert world.state_hash == summary['state_hash']


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
