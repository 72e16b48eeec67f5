"""What World.events tells: as cable_sim and CableEvent.msg."""
import pickle

import pytest
from worlds import IDENTITY, world_of

from verlet_cable.sim import Event


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
    ropes['guides'] = [{'name': 'eye', 'cable': 'second', 'at': 0.2, 'frame': 'mast', 'offset': [2, 0, -0.2], 'type': 'eyelet',
                        'initial_pose': [0, 0, 0, 0, 0, 0]}]
    summary, _ = cable_sim(ropes, '--duration', '0.5')
    world = world_of(ropes)
    assert world.guide_names == ['eye']
    world.step(100)
    released, = world.events()
    assert released[1:4] == ('RELEASED', 'second', 'eye') and released.message == 'guide "eye" has let cable "second" go'
    assert [e['time'] for e in summary['events'] if e['type'] == 'RELEASED'] == [released.time]


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


BOARD = {
    'time_step': 0.002, 'cables': [], 'materials': {},
    'bodies': [{'name': name, 'mass': 0.1, 'shapes': [{'type': 'box', 'size': [0.04, 0.04, 0.04]}], 'pose': [x, 0, z, 0, 0, 0],
                'linear_damping': 1.0} for name, x, z in (('plug', 0, -0.01), ('deep', 0.5, -0.03), ('beside', 1.0, 0.021))],
    'obstacles': [{'name': 'board', 'type': 'box', 'size': [3, 1, 0.2], 'pose': [0.5, 0, -0.1, 0, 0, 0]}]}


def test_a_body_inside_an_obstacle_is_told_as_a_cable_is(cable_sim):
    """How deep: of a box of 0.04 m, whose middle is 0.01 m below the surface of the board, the lowest corners are 0.03 m."""
    summary, _ = cable_sim(BOARD, '--duration', '2')
    world = world_of(BOARD)
    assert world.step() == 'inside_obstacle'
    begins = {event.cable: event for event in world.events()}
    assert set(begins) == {'plug', 'deep'}
    for name, depth in (('plug', 0.03), ('deep', 0.05)):
        event = begins[name]
        assert (event.type, event.other, event.time) == ('inside_obstacle', 'board', world.time)
        assert float(event.message.split()[2]) == pytest.approx(depth, abs=2e-4)
        assert event.message.endswith('m deep inside board and is pushed out')
    world.step(999)
    ends = {event.cable: event for event in world.events() if event.type == 'inside_obstacle_end'}
    assert set(ends) == {'plug', 'deep'} and 'deepest 0.03' in ends['plug'].message
    assert world.step(10) == 'ok' and world.body_pose('plug')[2] > 0.0195
    told = [(e.type, e.cable, e.time, e.message) for e in [*begins.values(), *ends.values()]]
    said = [(e['type'], e['cable'], e['time'], e['message']) for e in summary['events'] if e['type'].startswith('inside_obstacle')]
    assert sorted(told) == sorted(said)


def test_what_is_inside_goes_with_its_obstacle():
    world = world_of(BOARD)
    world.step()
    world.remove_obstacle('board')
    assert world.copy().events() == world.events() != []
    assert world.step(100) == 'ok'
