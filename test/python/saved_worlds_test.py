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


def test_a_state_is_set_within_lengths_and_holders():
    world = begun(HOSE)
    other = world.copy()
    world.step(100)
    world.set_state('hose', positions=other.positions('hose'), velocities=other.velocities('hose'))
    assert numpy.allclose(world.positions('hose'), other.positions('hose'), atol=1e-9)
    assert numpy.allclose(world.velocities('hose'), other.velocities('hose'), atol=1e-6)
    # A heap of nodes, drawn to one side.
    shape = numpy.linspace([0, 0.3, 0], [0.7, 0.3, 0.3], 21)
    world.set_state('hose', positions=shape, velocities=numpy.ones((21, 3)))
    lengths = numpy.linalg.norm(numpy.diff(world.positions('hose'), axis=0), axis=1)
    assert numpy.allclose(lengths, 0.05, rtol=1e-6)
    assert numpy.allclose(world.positions('hose')[0], 0)
    along = numpy.diff(world.positions('hose'), axis=0) * numpy.diff(world.velocities('hose'), axis=0)
    assert abs(along.sum(axis=1)).max() < 1e-9
    assert world.step(500) == 'ok'


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
    with pytest.raises(KeyError, match='rope'):
        world.set_state('rope', positions=numpy.zeros((21, 3)))
    assert world.state_hash == before
