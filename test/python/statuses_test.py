"""What steps are worth, and what World, Batch and cable_sim say of it."""
import numpy
import pytest

from verlet_cable.sim import Batch, Scene, World
from worlds import IDENTITY, world_of

STATUSES = ['ok', 'jumped', 'overstretched', 'inside_obstacle', 'not_settled', 'degraded', 'fault']


def through_a_table(height=0.6, length=1.0, friction=0.2, obstacle=None, settled=False, **material):
    """A cable that is longer than the room above a table: settled, or told to hang straight down from its clamp."""
    straight = {'type': 'straight', 'from': [0, 0, height], 'to': [0, 0, height - length]}
    return {
        'time_step': 0.005,
        'materials': {'m': {'linear_density': 0.05, 'radius': 0.004, 'bending_stiffness': 0.002, 'bending_damping': 1e-4, **material}},
        'cables': [{'name': 'rope', 'length': length, 'segments': 40, 'material': 'm',
                    'initial': {'type': 'settled'} if settled else straight,
                    'attachments': [{'name': 'hand', 'at': 'start', 'frame': 'hand', 'type': 'clamp',
                                     'initial_pose': [0, 0, height, 0, 0, 0]}]}],
        'obstacles': [{'name': 'table', 'type': 'plane', 'friction': friction, **(obstacle or {})}]}


TABLES = [
    {}, {'height': 0.4, 'length': 0.8}, {'height': 0.3, 'length': 1.2, 'friction': 0.0}, {'axial_stiffness': 200.0},
    {'obstacle': {'type': 'box', 'size': [3, 3, 0.5], 'pose': [0, 0, -0.25, 0, 0, 0]}}]


@pytest.mark.parametrize('table', TABLES)
def test_a_settled_cable_starts_on_a_table(table):
    world = world_of(through_a_table(settled=True, **table))
    assert world.positions('rope')[:, 2].min() > 0
    assert world.step(100) == 'ok'
    assert world.positions('rope')[:, 2].min() > 0


@pytest.mark.parametrize('scene', [through_a_table(**table) for table in TABLES])
def test_a_cable_below_a_table_is_said(scene):
    world = world_of(scene)
    assert world.positions('rope')[:, 2].min() < 0
    assert world.step(100) != 'ok'
    assert {'inside_obstacle', 'not_settled', 'degraded'} & {event.type for event in world.events()}


def pulled(rope):
    """The hand draws the cable beyond its length, and comes back."""
    times = numpy.array([0, 0.2, 0.5, 0.8, 2.0])
    poses = numpy.zeros((5, 7))
    poses[:, 0], poses[:, 6] = [0.6, 0.6, 1.05, 0.6, 0.6], 1
    return {'hand': (times, poses)}


def test_a_status_has_a_beginning_and_an_end(hang):
    world = world_of(hang, pulled(hang))
    statuses = {world.step() for _ in range(300)}
    assert statuses == {'ok', 'overstretched'}
    begin, end = [event for event in world.events() if event.type.startswith('overstretched')]
    assert (begin.type, begin.cable, end.type, end.cable) == ('overstretched', 'hose', 'overstretched_end', 'hose')
    assert 0.2 < begin.time < end.time < 0.8
    assert 'largest strain' in end.message


def test_events_are_those_of_cable_sim(hang, cable_sim, tmp_path):
    motion = tmp_path / 'motion.csv'
    times, poses = pulled(hang)['hand']
    rows = [','.join(map(str, [time, 'hand', *pose])) for time, pose in zip(times, poses)]
    motion.write_text('\n'.join(['t,frame,x,y,z,qx,qy,qz,qw', *rows]) + '\n')
    hang['max_frame_speed'] = 1.2
    summary, _ = cable_sim(hang, '--duration', '1.5', '--motion', str(motion))
    world = world_of(hang, str(motion))
    world.step(300)
    told = [(event.time, event.type, event.cable, event.message) for event in world.events()]
    assert told == [(event['time'], event['type'], event.get('cable', ''), event['message']) for event in summary['events']]
    assert {'frame_too_fast', 'frame_too_fast_end', 'overstretched', 'overstretched_end'} <= {event[1] for event in told}


def test_a_batch_has_the_events_of_each_world(hang):
    scene = Scene.from_dict(hang)
    batch = Batch(scene, 3, threads=2)
    assert batch.events(0) == []
    poses = numpy.zeros((3, 200, 7))
    poses[..., 6] = 1
    poses[..., 0] = 0.6
    poses[1, :, 0] = numpy.linspace(0.6, 1.05, 200)
    batch.set_frames('hand', poses)
    batch.step(200)
    assert batch.status.tolist() == [0, STATUSES.index('overstretched'), 0]
    world = World(scene)
    for pose in poses[1]:
        world.set_frame('hand', pose[:3], pose[3:])
        world.step()
    assert batch.events(-2) == world.events() != []
    assert batch.events(1) == [] and batch.events(0) == []
    with pytest.raises(IndexError, match='index: 3; allowed: -3 to 2'):
        batch.events(3)


def test_the_numbers_are_those_of_the_messages():
    world = world_of(through_a_table())
    batch = Batch(Scene.from_dict(through_a_table()), 2)
    batch.step(20)
    assert [STATUSES[number] for number in batch.status] == [world.step(20)] * 2


def unplaced(hang):
    del hang['cables'][0]['attachments'][0]['initial_pose']
    hang['cables'][0]['attachments'][1]['frame'] = 'other_hand'
    return hang


def test_frames_that_nothing_has_placed_are_an_error_that_names_all(hang):
    world = world_of(unplaced(hang))
    for act in (world.step, world.settle):
        with pytest.raises(ValueError) as error:
            act()
        assert str(error.value).startswith('frames: nothing has placed hand, other_hand; allowed: a pose by set_frame')
        assert 'initial_pose' in str(error.value) and 'motion' in str(error.value)
    assert world.time == 0
    world.set_frame('hand', [0.6, 0, 0], IDENTITY)
    with pytest.raises(ValueError, match='frames: nothing has placed other_hand;'):
        world.step()


def test_a_frame_that_is_set_before_the_first_step_was_there_from_the_start(hang):
    placed = world_of(hang)
    world = world_of(unplaced(hang))
    world.set_frame('hand', [0.6, 0, 0], IDENTITY)
    world.set_frame('other_hand', [0, 0, 0], IDENTITY)
    assert world.step(10) == placed.step(10) == 'ok'
    assert (world.positions('hose') == placed.positions('hose')).all()
    assert world.events() == []


def test_a_guide_needs_its_frame_and_an_obstacle_does_not(hang):
    hang['obstacles'] = [{'name': 'floor', 'type': 'plane', 'pose': [0, 0, -3, 0, 0, 0], 'frame': 'ground'}]
    assert world_of(hang).step() == 'ok'
    hang['guides'] = [{'name': 'eye', 'cable': 'hose', 'at': 0.5, 'frame': 'mast', 'type': 'eyelet'}]
    with pytest.raises(ValueError, match='frames: nothing has placed mast;'):
        world_of(hang).step()


def test_a_motion_places_a_frame(hang):
    world = World(Scene.from_dict(unplaced(hang)), {'hand': ([0], [[0.6, 0, 0, *IDENTITY]]), 'other_hand': ([0], [[0, 0, 0, *IDENTITY]])})
    assert world.step() == 'ok'


def test_a_batch_names_the_world(hang):
    batch = Batch(Scene.from_dict(unplaced(hang)), 3)
    for act in (batch.step, batch.settle):
        with pytest.raises(ValueError, match='^world 0: frames: nothing has placed hand, other_hand;'):
            act()
    poses = numpy.tile([0.6, 0, 0, *IDENTITY], (3, 1))
    batch.set_frames('hand', poses)
    batch.set_frames('other_hand', poses - [0.6, 0, 0, 0, 0, 0, 0])
    assert batch.settle().all()
    batch.step(5)
    assert batch.status.tolist() == [0, 0, 0]
    batch.set_world(1, world_of(hang))
    with pytest.raises(ValueError, match='^world 1: frames: nothing has placed hand, other_hand;'):
        batch.step()


def test_a_batch_names_the_worlds_that_a_place_does_not_suit(hang):
    batch = Batch(Scene.from_dict(unplaced(hang)), 3)
    poses = numpy.tile([0.6, 0, 0, *IDENTITY], (3, 1))
    batch.set_frames('hand', poses)
    others = numpy.tile([0, 0, 0, *IDENTITY], (3, 1))
    others[1:, 0] = 5, 7
    with pytest.raises(ValueError) as error:
        batch.set_frames('other_hand', others)
    lines = str(error.value).splitlines()
    assert [line[:9] for line in lines] == ['world 1: ', 'world 2: ']
    assert all('1 m of cable between "left" and "right"' in line for line in lines)


def test_a_place_that_a_cable_does_not_reach_is_refused_and_changes_nothing(hang):
    world = world_of(unplaced(hang))
    world.set_frame('hand', [0.6, 0, 0], IDENTITY)
    with pytest.raises(ValueError, match='1 m of cable between "left" and "right"'):
        world.set_frame('other_hand', [5, 0, 0], IDENTITY)
    with pytest.raises(ValueError, match='frames: nothing has placed other_hand;'):
        world.step()


def test_arrays_are_read_only(hang):
    world, batch = world_of(hang), Batch(Scene.from_dict(hang), 2)
    arrays = [world.positions('hose'), world.wrench('left'), batch.positions('hose'), batch.status, batch.time, batch.energy()['total'],
              batch.observations([('positions', 'hose')]), batch.settle()]
    assert not any(array.flags.writeable for array in arrays)
    with pytest.raises(ValueError):
        arrays[0][0] = 0


def test_objects_say_what_they_are(hang):
    scene = Scene.from_dict(hang)
    assert repr(scene) == '<Scene with cables: hose>'
    assert repr(World(scene)) == '<World at 0 s, cables: hose>'
    assert repr(Batch(scene, 4)) == '<Batch of 4 worlds>'
