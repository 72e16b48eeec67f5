"""Worlds, scenes and batches as bytes and pickles."""
import copy
import pathlib
import pickle

import numpy
import pytest

from verlet_cable.sim import Batch, Scene, World
from worlds import IDENTITY, world_of

CONFIG = pathlib.Path(__file__).resolve().parents[2] / 'config'
# Every shipped example: with bodies, guides, obstacles, nets, robots.
EXAMPLES = sorted([*CONFIG.glob('*.yaml'), *CONFIG.glob('examples/*.yaml'), *CONFIG.glob('scenes/*.yaml')])
NOT_SCENES = {'materials.yaml', 'replay.yaml', 'sweep.yaml', 'scene_template.yaml'}

HOSE = {
    'materials': {'m': {'linear_density': 0.1, 'radius': 0.005, 'bending_stiffness': 0.01, 'bending_damping': 1e-4}},
    'obstacles': [{'name': 'floor', 'type': 'plane', 'pose': [0, 0, -0.1, 0, 0, 0]}],
    'cables': [{'name': 'hose', 'length': 1.0, 'segments': 20, 'material': 'm',
                'attachments': [{'name': 'left', 'at': 'start'},
                                {'name': 'right', 'at': 'end', 'frame': 'hand', 'initial_pose': [0.7, 0, 0, 0, 0, 0]}]}]}


def begun(scene):
    world = world_of(scene)
    world.set_frame('hand', [0.7, 0, 0.05], IDENTITY)
    world.step(50)
    return world


def forms(world, scene):
    return [World.load(scene, world.save()), pickle.loads(pickle.dumps(world)), copy.deepcopy(world)]


@pytest.mark.parametrize('path', [path for path in EXAMPLES if path.name not in NOT_SCENES], ids=lambda path: path.stem)
def test_every_shipped_scene_goes_on_with_the_same_bytes(path):
    motion = path.with_suffix('.csv')
    scene = Scene.load(path)
    world = World(scene, motion if motion.exists() else {name: ([0.0], [[0, 0, 0, *IDENTITY]]) for name in scene.frame_names})
    world.step(20)
    for other in forms(world, scene):
        assert other.state_hash == world.state_hash
        assert other.step(20) is not None
    ahead = world.copy()
    ahead.step(20)
    again = World.load(scene, world.save())
    assert again.save() == world.save()
    again.step(20)
    assert again.state_hash == ahead.state_hash
    assert again.time == ahead.time


def test_frames_edits_and_tuning_are_in_it():
    world = begun(HOSE)
    world.pin('hose', node=10, name='peg', keep_offset=True)
    world.set_obstacle('ball', type='sphere', radius=0.05, pose=[0.3, 0, -0.1, 0, 0, 0])
    world.tune(gravity=[0, 0, -5])
    world.cut('hose', node=15)
    scene = Scene.from_dict(HOSE)
    for other in forms(world, scene):
        for one in (world.copy(), other):
            one.unpin('peg')
            one.step(30)
            one.set_frame('hand', [0.6, 0, 0.05], IDENTITY)
            one.step(30)
        assert other.cable_names == world.cable_names
        assert other.frame_names == world.frame_names
    assert World.load(scene, world.save()).state_hash == world.state_hash


def test_motions_go_on():
    times, poses = [0.0, 0.2], [[0.7, 0, 0, *IDENTITY], [0.5, 0, 0.2, *IDENTITY]]
    world = World(Scene.from_dict(HOSE), {'hand': (times, poses)})
    world.step(50)
    other = World.load(Scene.from_dict(HOSE), world.save())
    world.step(200)
    other.step(200)
    assert other.state_hash == world.state_hash
    assert numpy.allclose(other.positions('hose')[-1], [0.5, 0, 0.2])


def test_a_scene_is_pickled_with_its_directory(tmp_path):
    text = 'materials: {m: {linear_density: 0.1, radius: 0.01}}\ncables: [{name: c, length: 1, segments: 5, material: m}]\n'
    (tmp_path / 'a.yaml').write_text(text)
    for scene in (Scene.load(tmp_path / 'a.yaml'), Scene.from_yaml(text), Scene.from_dict(HOSE)):
        again = pickle.loads(pickle.dumps(scene))
        assert again.cable_names == scene.cable_names
        assert World(again, {}).state_hash == World(scene, {}).state_hash


def test_a_world_knows_its_scene():
    scene = Scene.from_dict(HOSE)
    assert World(scene).scene.cable_names == ['hose']
    assert Batch(scene, 2).world(1).scene.cable_names == ['hose']


def test_a_batch_is_pickled():
    batch = Batch(Scene.from_dict(HOSE), 3, threads=1)
    batch.set_material('m', linear_density=numpy.array([0.1, 0.2, 0.3]))
    batch.step(10)
    other = pickle.loads(pickle.dumps(batch))
    assert other.state_hash == batch.state_hash
    assert World.load(Scene.from_dict(HOSE), batch.save(1)).state_hash == batch.state_hash[1]
    for one in (batch, other):
        one.set_frames('hand', numpy.tile([0.6, 0, 0, *IDENTITY], (3, 1)))
        one.step(20)
    assert other.state_hash == batch.state_hash


def test_foreign_bytes_are_refused():
    scene = Scene.from_dict(HOSE)
    world = begun(HOSE)
    data = world.save()
    rope = dict(HOSE, cables=[dict(HOSE['cables'][0], name='rope')])
    for bad, words in [(b'', 'not a saved world'), (b'nonsense', 'not a saved world'), (data[:-1], 'cut off or damaged'),
                       (data[:100] + bytes([data[100] ^ 1]) + data[101:], 'cut off or damaged'), (data + b'x', 'cut off or damaged')]:
        with pytest.raises(ValueError, match='data: .*' + words):
            World.load(scene, bad)
    with pytest.raises(ValueError, match='data: it is of a scene with cables hose.*this one has cables rope'):
        World.load(Scene.from_dict(rope), data)
    with pytest.raises(TypeError, match="data: 'text'; allowed: bytes, as save"):
        World.load(scene, 'text')
    for as_bytes in (bytearray(data), memoryview(data), numpy.frombuffer(data, numpy.uint8)):
        assert World.load(scene, as_bytes).state_hash == world.state_hash


def changed(**keys):
    """HOSE with other keys, those of its cable after cable_."""
    cable = {key[len('cable_'):]: value for key, value in keys.items() if key.startswith('cable_')}
    others = {key: value for key, value in keys.items() if not key.startswith('cable_')}
    return Scene.from_dict({**HOSE, **others, 'cables': [{**HOSE['cables'][0], **cable}]})


LEFT, RIGHT = HOSE['cables'][0]['attachments']


@pytest.mark.parametrize('other, words', [
    (dict(cable_segments=21), 'cables hose of 20 segments of m.*cables hose of 21 segments of m'),
    (dict(cable_segments=1, cable_attachments=[]), 'cables hose of 20 segments of m.*this one has .*cables hose of 1 segment of m'),
    (dict(cable_sections=[{'from': 0, 'to': 0.5, 'material': 'm'}]), 'this one has cables hose of 20 segments of m and m'),
    (dict(cable_attachments=[LEFT]), r'attachments left \(hinge on world\), right \(hinge on hand\).*this one has .*attachments left'),
    (dict(cable_attachments=[dict(LEFT, type='clamp'), RIGHT]), r'this one has attachments left \(clamp on world\), right'),
    (dict(cable_attachments=[LEFT, dict(RIGHT, frame='grip')]), 'frames world, hand.*this one has frames world, grip'),
    (dict(obstacles=[]), r'obstacles floor \(plane in world\), and this one has obstacles none'),
    (dict(obstacles=[{'name': 'floor', 'type': 'sphere', 'radius': 0.01, 'pose': [0, 0, -2, 0, 0, 0]}]), r'floor \(sphere in world\)'),
    (dict(particles=[{'name': 'p', 'mass': 1.0, 'position': [0, 0, 5]}]), 'particles none, and this one has particles p'),
    (dict(nets=[{'name': 'f', 'mass': 1.0, 'grid': {'rows': 2, 'columns': 3, 'spacing': 0.1, 'origin': [0, 0, 5]}}]),
     r'this one has nets f \(2 x 3 nodes; spring\)'),
    (dict(time_step=0.002), 'time_step 0.001 s, and this one has time_step 0.002 s'),
    (dict(frame_id='map'), 'frames world.*this one has frames map'),
    (dict(bodies=[{'name': 'b', 'mass': 1.0, 'shapes': [{'type': 'sphere', 'radius': 0.1}], 'pose': [0, 0, 5, 0, 0, 0]}]),
     r'bodies none.*this one has bodies b \(sphere\)'),
    (dict(guides=[{'name': 'g', 'cable': 'hose', 'type': 'clip', 'offset': [0, 0, 5], 'capture': 0.01}]),
     r'guides g \(clip for hose on world\)'),
], ids=lambda value: value[:30] if isinstance(value, str) else '')
def test_worlds_of_other_scenes_are_refused(other, words):
    world, scene = begun(HOSE), changed(**other)
    with pytest.raises(ValueError, match='data: it is of a scene with .*' + words):
        World.load(scene, world.save())
    batch = Batch(scene, 2)
    before = batch.state_hash
    with pytest.raises(ValueError, match='world.*; allowed: scenes that differ in numbers only'):
        batch.set_world(0, world)
    assert batch.state_hash == before


def test_what_differs_in_numbers_or_by_edits_is_loaded():
    world = begun(HOSE)
    world.cut('hose', node=15)
    world.set_length('hose', False, 0.5, 1.0)
    world.step(300)
    assert len(world.positions('hose')) != 16
    softer = changed(materials={'m': dict(HOSE['materials']['m'], bending_stiffness=0.002)}, gravity=[0, 0, -1], cable_length=1.1)
    assert World.load(softer, world.save()).state_hash == world.state_hash


@pytest.mark.parametrize('protocol', range(pickle.HIGHEST_PROTOCOL + 1))
def test_any_protocol_pickles(protocol):
    scene = Scene.from_dict(HOSE)
    world = begun(HOSE)
    assert pickle.loads(pickle.dumps(scene, protocol)).cable_names == ['hose']
    assert pickle.loads(pickle.dumps(world, protocol)).state_hash == world.state_hash
    batch = Batch(world, 2)
    assert pickle.loads(pickle.dumps(batch, protocol)).state_hash == batch.state_hash
    with pytest.raises(TypeError, match='cannot pickle'):
        pickle.dumps(batch.worlds, protocol)


def test_contacts_are_in_it():
    world = begun(HOSE)
    while not len(world.contacts()):
        world.step(5)
    assert world.contact_force('floor')[2] < 0
    batch = Batch(world, 2)
    for other in [*forms(world, Scene.from_dict(HOSE)), pickle.loads(pickle.dumps(batch)).world(1)]:
        assert numpy.array_equal(other.contacts(), world.contacts())
        assert numpy.array_equal(other.contact_force('floor'), world.contact_force('floor'))


def test_a_state_is_set_within_lengths_and_holders():
    world = begun(HOSE)
    other = world.copy()
    world.step(100)
    world.set_state('hose', positions=other.positions('hose'), velocities=other.velocities('hose'))
    assert numpy.allclose(world.positions('hose'), other.positions('hose'), atol=1e-9)
    assert numpy.allclose(world.velocities('hose'), other.velocities('hose'), atol=1e-6)
    # A heap of nodes, drawn to one side.
    shape = numpy.linspace([0, 0.3, 0], [0.9, 0.3, 0.38], 21)
    world.set_state('hose', positions=shape, velocities=numpy.ones((21, 3)))
    lengths = numpy.linalg.norm(numpy.diff(world.positions('hose'), axis=0), axis=1)
    assert numpy.allclose(lengths, 0.05, rtol=1e-6)
    assert numpy.allclose(world.positions('hose')[0], 0)
    along = numpy.diff(world.positions('hose'), axis=0) * numpy.diff(world.velocities('hose'), axis=0)
    assert abs(along.sum(axis=1)).max() < 1e-9
    assert world.step(500) == 'ok'


def test_a_strained_cable_takes_the_lengths_that_it_has():
    """A rope of 10 N, drawn to twice its length."""
    shape = numpy.linspace([0, 0, 0], [2, 0, 0], 21)
    elastic = dict(HOSE, materials={'m': dict(HOSE['materials']['m'], axial_stiffness=10.0)})
    world = world_of(elastic)
    with pytest.raises(ValueError, match="positions: a polyline of 2 m; allowed: at most 5 % more or less than the cable's length 1 m"):
        world.set_state('hose', positions=shape)
    for step in range(300):
        world.set_frame('hand', [0.7 + 1.3 * (step + 1) / 300, 0, 0], IDENTITY)
        world.step()
    world.set_state('hose', positions=world.positions('hose'))
    world.set_state('hose', positions=shape)
    with pytest.raises(ValueError, match="than the cable's length 1 m, or than the 2 m to which it is strained"):
        world.set_state('hose', positions=1.2 * shape)


@pytest.mark.parametrize('kind', [{}, {'torsional_stiffness': 0.008, 'bending_stiffness': [0.01, 0.02]}, {'axial_stiffness': 1e4}])
def test_a_state_that_was_set_moves_as_what_begins_there(kind):
    scene = dict(HOSE, materials={'m': dict(HOSE['materials']['m'], **kind)})
    x = numpy.linspace(0, 1, 21)
    shape = numpy.stack([x, 0 * x, 0 * x], axis=1) + [5, 0, 3]
    free = dict(scene['cables'][0], attachments=[])
    first = world_of(dict(scene, cables=[dict(free, initial={'type': 'points', 'points': shape.tolist()})]))
    second = world_of(dict(scene, cables=[free]))
    second.step(20)
    second.set_state('hose', positions=shape, velocities=numpy.zeros((21, 3)))
    first.step(50)
    second.step(50)
    assert numpy.allclose(first.positions('hose'), second.positions('hose'), atol=1e-9)


def test_a_state_that_cannot_be_is_refused():
    world = begun(HOSE)
    before = world.state_hash
    for arguments, words in [(dict(positions=numpy.zeros((20, 3))), 'positions: 20; must be 21, one a node'),
                             (dict(positions=numpy.zeros(21)), r'positions: shape \(21,\); allowed: \(n \+ 1, 3\)'),
                             (dict(velocities=numpy.full((21, 3), numpy.nan)), r'velocities\[0\].x: nan'),
                             (dict(velocities=numpy.zeros((3, 3)), positions=numpy.zeros((4, 3))), '(?s)positions: 4.*velocities: 3')]:
        with pytest.raises(ValueError, match=words):
            world.set_state('hose', **arguments)
    # As a scene refuses it.
    for length in (2.0, 0.9):
        shape = numpy.linspace([0, 0, 0], [0, 0, length], 21)
        words = rf"positions: a polyline of {length:g} m; allowed: at most 5 % more or less than the cable's length 1 m"
        with pytest.raises(ValueError, match=words):
            world.set_state('hose', positions=shape)
        with pytest.raises(ValueError, match=words.replace('positions', 'points')):
            changed(cable_attachments=[], cable_initial={'type': 'points', 'points': shape.tolist()})
    with pytest.raises(KeyError, match='rope'):
        world.set_state('rope', positions=numpy.zeros((21, 3)))
    assert world.state_hash == before


def unsettled():
    """Around the ball it is further than the hose is long: it finds no equilibrium."""
    scene = copy.deepcopy(HOSE)
    scene['obstacles'] = [{'name': 'ball', 'type': 'sphere', 'radius': 0.1, 'pose': [0.49, 0, 0, 0, 0, 0]}]
    scene['cables'][0]['attachments'][1]['initial_pose'][0] = 0.98
    return scene


def told(world):
    return [(event.time, event.type, event.cable, event.message) for event in world.events()]


def test_what_was_told_of_a_world_is_told_by_its_copies():
    """That it did not settle, until a step has said so; then no more."""
    scene = Scene.from_dict(unsettled())
    world = World(scene)
    events = told(world.copy())
    assert ('not_settled', 'hose') in [event[1:3] for event in events]
    for other in forms(world, scene):
        assert told(other) == events
        assert other.step() == world.copy().step() != 'ok'
        assert 'not_settled' not in [event[1] for event in told(other)]
        assert 'not_settled_end' in [event[1] for event in (other.step(200), told(other))[1]]
    world.step(2)
    world.events()
    after = world.copy().step()
    for other in forms(world, scene):
        assert other.step() == after
        assert 'not_settled' not in [event[1] for event in told(other)]


def test_events_that_were_not_read_are_in_pickles():
    world = begun(HOSE)
    world.events()
    world.cut('hose', node=10)
    world.pin('hose_2', node=5, keep_offset=True)
    events = told(world.copy())
    assert [event[1] for event in events] == ['CUT', 'PINNED']
    for other in (copy.deepcopy(world), pickle.loads(pickle.dumps(world))):
        assert told(other) == events
    batch = Batch(Scene.from_dict(HOSE), 2)
    batch.cut(1, 'hose', node=10)
    for other in (copy.deepcopy(batch), pickle.loads(pickle.dumps(batch))):
        assert [event.type for event in other.events(1)] == ['CUT'] and other.events(0) == []


def test_a_status_that_began_before_ends_after_a_pickle():
    def overstretched(world):
        return [event[1] for event in told(world) if event[1].startswith('overstretched')]

    world = begun(HOSE)
    for step in range(100):
        world.set_frame('hand', [0.7 + 0.4 * (step + 1) / 100, 0, 0], IDENTITY)
        world.step()
    assert overstretched(world) == ['overstretched']
    again, loaded = pickle.loads(pickle.dumps(world)), World.load(Scene.from_dict(HOSE), world.save())
    # Bytes have what holds on, and not what was read.
    assert overstretched(again) == [] and overstretched(loaded) == ['overstretched']
    for other in (again, loaded):
        for step in range(300):
            other.set_frame('hand', [1.1 - 0.4 * min(step + 1, 100) / 100, 0, 0], IDENTITY)
            other.step()
        assert overstretched(other) == ['overstretched_end']
