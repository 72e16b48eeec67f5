"""Forces and torques from outside: on worlds and batches, and from files."""
import numpy
import pytest
from worlds import world_of

from verlet_cable.sim import Batch, Load, Scene, SceneError, World

HEADER = 't,name,on,node,fx,fy,fz,tx,ty,tz\n'
STEP = 0.005  # [s] of the scenes


@pytest.fixture
def free():
    """A body and a rope that nothing holds, without gravity."""
    return {
        'frame_id': 'world', 'time_step': STEP, 'gravity': [0, 0, 0],
        'materials': {'wire': {'linear_density': 0.1, 'radius': 0.005}},
        'cables': [{'name': 'rope', 'length': 1.0, 'segments': 10, 'material': 'wire'}],
        'bodies': [{'name': 'plug', 'mass': 2.0, 'inertia': [0.1, 0.2, 0.25], 'center_of_mass': [0, 0, 0.1], 'pose': [0, 0, 1, 0, 0, 1.5]}],
    }


def test_a_wrench_moves_a_body_as_newton_says(free):
    world = world_of(free)
    assert world.apply_wrench('plug', [4, 0, 2], [0, 0, 0.5]) is None
    world.step()
    assert abs(world.body_twist('plug') - [4 * STEP / 2, 0, STEP, 0, 0, 0.5 * STEP / 0.25]).max() < 1e-9
    world.step(9)
    assert abs(world.body_twist('plug')[:3] - [20 * STEP, 0, 10 * STEP]).max() < 1e-9  # it is held until it is changed
    world.apply_wrench('plug', [0, 0, 0])
    before = world.body_twist('plug')
    world.step(5)
    assert abs(world.body_twist('plug')[:3] - before[:3]).max() < 1e-12
    assert world.loads() == []


def test_a_force_may_act_at_a_point_and_in_the_axes_of_the_body(free):
    world, local = world_of(free), world_of(free)
    world.apply_wrench('plug', [1, 0, 0], point=[0, 0, 0])
    local.apply_wrench('plug', [1, 0, 0], local=True)
    world.step()
    local.step()
    # The arm is from the center of mass, 0.1 m above.
    assert world.body_twist('plug')[4] < 0 and abs(local.body_twist('plug')[3:]).max() < 1e-12
    assert abs(local.body_twist('plug')[:2] - STEP / 2 * numpy.array([numpy.cos(1.5), numpy.sin(1.5)])).max() < 1e-9


def test_a_force_acts_on_a_node(hang):
    world, plain = world_of(hang), world_of(hang)
    world.apply_force('hose', 10, [0, 0.5, 0])
    assert world.settle()
    world.step(2)
    plain.settle()
    plain.step(2)
    forces = world.wrench('left')[:3] + world.wrench('right')[:3] - plain.wrench('left')[:3] - plain.wrench('right')[:3]
    assert abs(forces - [0, 0.5, 0]).max() < 1e-6
    assert world.positions('hose')[10, 1] > 0.1


def test_loads_are_named_listed_and_end(free):
    world = world_of(free)
    world.apply_force('rope', 3, [0, 0, 1], name='thrust', duration=4 * STEP)
    world.apply_force('rope', 3, [0, 1, 0])
    world.apply_force('rope', 3, [0, 2, 0])  # in the place of the one before
    world.apply_wrench('plug', [1, 0, 0], [0, 1, 0], [0, 0, 0.2], True)
    loads = world.loads()
    assert [load[:3] for load in loads] == [('thrust', 'rope', 3), ('rope[3]', 'rope', 3), ('plug', 'plug', -1)]
    assert isinstance(loads[0], Load) and loads[0].time_left == pytest.approx(4 * STEP) and loads[1].time_left == float('inf')
    assert loads[1].force.tolist() == [0, 2, 0] and loads[2].torque.tolist() == [0, 1, 0] and loads[2].point.tolist() == [0, 0, 0.2]
    assert loads[2].local and not loads[0].local
    world.step(4)
    assert [load.name for load in world.loads()] == ['rope[3]', 'plug']
    event, = [event for event in world.events() if event.type == 'LOAD_ENDED']
    assert event[1:4] == ('LOAD_ENDED', 'rope', 'thrust') and event.time == pytest.approx(4 * STEP)
    copied = world.copy()
    assert copied.state_hash == world.state_hash
    copied.step(10)
    world.step(10)
    assert copied.state_hash == world.state_hash


def test_what_cannot_be_applied_changes_nothing(free):
    world = world_of(free)
    before = world.state_hash
    for error, text, call in (
        (KeyError, 'cable: "robe"; allowed: rope', lambda: world.apply_force('robe', 0, [0, 0, 1])),
        (ValueError, 'node: 11; allowed: 0 to 10', lambda: world.apply_force('rope', 11, [0, 0, 1])),
        (ValueError, 'force: (0, nan, 0); allowed: finite numbers [N]', lambda: world.apply_force('rope', 1, [0, numpy.nan, 0])),
        (ValueError, 'force: shape (2,); allowed: (3,)', lambda: world.apply_force('rope', 1, [0, 1])),
        (ValueError, 'duration: -1; allowed: 0 or more [s]', lambda: world.apply_force('rope', 1, [0, 0, 1], duration=-1)),
        (ValueError, 'name: "a b"; allowed: at most 1000 letters', lambda: world.apply_force('rope', 1, [0, 0, 1], name='a b')),
        (KeyError, 'body: "rope"; allowed: plug', lambda: world.apply_wrench('rope', [0, 0, 1])),
        (ValueError, 'torque: (0, 0, inf); allowed: finite numbers [N m]', lambda: world.apply_wrench('plug', [0, 0, 1], [0, 0, numpy.inf])),
        (ValueError, 'point: (nan, 0, 0)', lambda: world.apply_wrench('plug', [0, 0, 1], point=[numpy.nan, 0, 0])),
    ):
        with pytest.raises(error) as raised:
            call()
        assert text in str(raised.value)
        assert world.state_hash == before


def test_all_errors_are_told_at_once(free):
    with pytest.raises(ValueError) as raised:
        world_of(free).apply_wrench('plug', [numpy.nan, 0, 0], [0, numpy.nan, 0], duration=-1)
    assert all(field in str(raised.value) for field in ('force: (nan', 'torque: (0, nan', 'duration: -1'))


def test_a_batch_has_a_load_a_world(free):
    scene = Scene.from_dict(free)
    forces = numpy.array([[1, 0, 0], [0, 2, 0], [0, 0, -3]], float)
    for threads in (1, 2):
        batch = Batch(scene, 3, threads=threads)
        batch.apply_wrench('plug', forces, 0.1 * forces)
        batch.apply_force('rope', 4, forces[::-1])
        batch.step(20)
        for index in range(3):
            world = World(scene)
            world.apply_wrench('plug', forces[index], 0.1 * forces[index])
            world.apply_force('rope', 4, forces[2 - index])
            world.step(20)
            assert batch.state_hash[index] == world.state_hash
    batch.apply_wrench('plug', [0, 0, 0])
    assert [load.name for load in batch.world(0).loads()] == ['rope[4]']
    before = batch.state_hash
    for text, given in (('forces: shape (2, 3); allowed: (3, 3), or (3,) for all', forces[:2]),
                        ('world 1: force: (0, nan, 0)', [[0, 0, 1], [0, numpy.nan, 0], [0, 0, 1]])):
        with pytest.raises(ValueError) as raised:
            batch.apply_force('rope', 4, given)
        assert text in str(raised.value)
    with pytest.raises(KeyError, match='world 0: body: "cork"; allowed: plug'):
        batch.apply_wrench('cork', forces)
    assert batch.state_hash == before


def test_a_file_of_loads_does_the_same_everywhere(free, cable_sim, tmp_path):
    rows = HEADER + '0,push,plug,-1,1,0,0,0,0,0.1\n0.05,push,plug,-1,0,0,0,0,0,0\n0.02,pull,rope,5,0,0.01,0,0,0,0\n'
    (tmp_path / 'loads.csv').write_text(rows)
    path = tmp_path / 'loads.csv'
    summary, nodes = cable_sim(free, '--loads', 'loads.csv', '--duration', '0.2', '--rate', '20')
    world = World(Scene.from_dict(free), loads=path)
    world.step(40)
    assert world.state_hash == summary['state_hash']
    assert abs(world.body_twist('plug')[:3] - [0.5 * 0.05, 0, 0]).max() < 1e-12
    by_hand = world_of(free)
    by_hand.apply_wrench('plug', [1, 0, 0], [0, 0, 0.1], name='push')
    by_hand.step(4)
    by_hand.apply_force('rope', 5, [0, 0.01, 0], name='pull')
    by_hand.step(6)
    by_hand.apply_wrench('plug', [0, 0, 0], name='push')
    by_hand.step(30)
    assert by_hand.state_hash == world.state_hash
    batch = Batch(Scene.from_dict(free), 2, loads=str(path))
    batch.step(40)
    assert batch.state_hash == [world.state_hash] * 2


def test_a_file_of_loads_is_read_with_all_its_errors(free, tmp_path):
    path = tmp_path / 'loads.csv'
    path.write_text(HEADER + '0,a,rope,11,1,0,0,0,0,0\n0,b,robe,1,1,0,0,0,0,0\n')
    with pytest.raises(SceneError) as raised:
        World(Scene.from_dict(free), loads=path)
    assert len(raised.value.errors) == 2
    assert 'line 2: node 11 of cable "rope"; allowed: 0 to 10' in raised.value.errors[0]
    assert 'line 3: on "robe"; allowed: rope, plug' in raised.value.errors[1]


def test_rows_on_what_was_cut_off_are_left_out(free, tmp_path):
    path = tmp_path / 'loads.csv'
    path.write_text(HEADER + '0.1,push,rope,9,0,0,1,0,0,0\n')
    world = World(Scene.from_dict(free), loads=path)
    world.cut('rope', node=4)
    world.step(40)
    event, = [event for event in world.events() if event.type == 'LOAD_ENDED']
    assert event.attachment == 'push' and 'line 2 is left out: node: 9; must be from 0 to 4' in event.message
    assert world.loads() == []


STRAIGHT = {
    'gravity': [0, 0, 0], 'materials': {'m': {'linear_density': 0.1, 'radius': 0.005}},
    'cables': [{'name': 'c', 'length': 1.0, 'segments': 10, 'material': 'm', 'initial': {'type': 'straight', 'from': [0, 0, 0], 'to': [1, 0, 0]},
                'attachments': [{'name': 'a', 'at': 'start'}]}]}


def test_what_has_no_name_is_replaced_where_nodes_have_new_numbers():
    world = World(Scene.from_dict(STRAIGHT))
    world.set_length('c', False, 1.5, 0.2)
    for _ in range(3000):
        world.apply_force('c', len(world.positions('c')) - 1, [1, 0, 0])
        world.step()
    assert len(world.loads()) == 1
    assert world.wrench('a')[0] == pytest.approx(1, abs=1e-6)
    world.apply_force('c', len(world.positions('c')) - 1, [0, 0, 0])
    assert world.loads() == []
    batch = Batch(world, 2)
    batch.apply_force('c', 3, numpy.array([[0, 1, 0], [0, 0, 0]]))
    assert [len(batch.loads(k)) for k in range(2)] == [1, 0]


def test_a_name_is_not_taken_from_a_load_elsewhere():
    world = World(Scene.from_dict(STRAIGHT))
    world.apply_force('c', 8, [0, 1, 0])
    world.cut('c', node=4)
    world.apply_force('c', 3, [0, 0, 1])
    world.join('c', True, 'c_2', False)
    before = len(world.loads())
    for node in range(8):
        world.apply_force('c', node, [0, 0, 1])
    assert before == 2
    assert len(world.loads()) == 8 + sum(load.node >= 8 for load in world.loads())


def test_a_load_ends_by_its_name_alone():
    world = World(Scene.from_dict(STRAIGHT))
    world.apply_force('c', 9, [0, 1, 0], name='g')
    world.cut('c', node=4)
    world.apply_force('c', 9, [0, 0, 0], name='g')
    assert world.loads() == []


def test_a_force_on_the_node_of_an_eyelet_moves_the_cable():
    scene = dict(STRAIGHT, cables=[dict(STRAIGHT['cables'][0], attachments=[])],
                 guides=[{'name': 'eye', 'cable': 'c', 'at': 0.6, 'offset': [0.6, 0, 0]}])
    world = World(Scene.from_dict(scene))
    places = numpy.abs(world.positions('c')[:, 0] - 0.6)
    world.apply_force('c', int(places.argmin()), [-0.1, 0, 0])
    before = world.positions('c')[0, 0]
    world.step(400)
    assert world.positions('c')[0, 0] - before == pytest.approx(-0.5 * 0.1 / 0.1 * 0.4**2, rel=2e-3)


def test_rows_name_nodes_as_the_scene_has_them(tmp_path):
    scene = dict(STRAIGHT, cables=[dict(STRAIGHT['cables'][0], attachments=[])],
                 guides=[{'name': 'eye', 'cable': 'c', 'at': 0.55, 'offset': [0.55, 0, 0]}])
    file = tmp_path / 'loads.csv'
    file.write_text('t,name,on,node,fx,fy,fz,tx,ty,tz\n0,end,c,10,0.1,0,0,0,0,0\n')
    world = World(Scene.from_dict(scene), loads=file)
    world.step()
    (load,) = world.loads()
    assert world.positions('c')[load.node][0] == pytest.approx(1, abs=1e-6)


def test_what_weighs_nothing_and_rests_is_accounted_for():
    world = World(Scene.from_dict(STRAIGHT))
    world.step(20)
    assert world.ledger()['unaccounted_steps'] == 0
    assert world.events() == []
