"""Obstacles that are set from Python: those of scenes."""
import numpy
import pytest
from worlds import IDENTITY, quiet, world_of

from verlet_cable.sim import SceneError

TABLE = {'type': 'box', 'pose': [0.3, 0, -0.4, 0, 0, 0], 'size': [1.0, 1.0, 0.3], 'friction': 0.4}


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


def test_an_obstacle_is_moved_and_removed(hang):
    world = world_of(hang)
    world.set_obstacle('table', **TABLE)
    world.step(400)
    assert world.positions('hose')[:, 2].min() > -0.26
    world.set_obstacle('table', **dict(TABLE, pose=[0.3, 0, -0.5, 0, 0, 0]))
    assert world.obstacle_names == ['table']
    world.step(400)
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


@pytest.mark.parametrize('name, key', [('first', 'cables[0].name'), ('plug', 'bodies[0].name')])
def test_what_contacts_tell_by_its_name_has_a_name_of_its_own(ropes, name, key):
    """Contacts, events, contact_force() and masks have no more than the name of what is touched."""
    world = world_of(ropes)
    before = world.state_hash
    with pytest.raises(ValueError, match=f'obstacle "{name}": name: that of a .*; allowed: names that no cable, net, particle or body has'):
        world.set_obstacle(name, **TABLE)
    assert world.state_hash == before
    ropes['obstacles'][0]['name'] = name
    with pytest.raises(SceneError) as caught:
        world_of(ropes)
    assert caught.value.errors == [f'obstacles[0].name: "{name}"; allowed: a name that is used once; it is {key} already']


def test_pieces_have_names_of_their_own(ropes):
    ropes['obstacles'].append({'name': 'first_2', **TABLE})
    ropes['bodies'][0]['name'] = 'first_3'
    world = world_of(ropes)
    assert world.cut('first', node=5).second == 'first_4'
    # Guides touch nothing: an obstacle may have the name of one.
    ropes['guides'] = [{'name': 'first_2', 'cable': 'first', 'at': 0.5, 'offset': [0.5, 0, 0]}]
    assert world_of(ropes).guide_names == ['first_2']
