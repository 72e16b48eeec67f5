"""The worlds of a batch, each as a World, and what a batch does to one of them."""
import copy
import gc
import inspect
import pickle
import re

import numpy
import pytest
from worlds import IDENTITY

from verlet_cable.sim import Batch, Scene, World

# What a batch does to one of its worlds, by its index.
BY_WORLD = ['pin', 'unpin', 'cut', 'join', 'set_length', 'set_tension', 'set_state', 'set_states', 'move_attachment', 'set_obstacle', 'remove_obstacle',
            'add_frame', 'set_frame', 'tune', 'events', 'loads', 'contacts', 'ledger', 'arc_length', 'save']


@pytest.fixture
def scene(hang):
    return Scene.from_dict(hang)


def edit(world):
    world.pin('hose', node=10, name='peg', keep_offset=True)
    world.set_obstacle('ball', type='sphere', radius=0.05, pose=[0.3, 0, -0.5, 0, 0, 0])
    world.tune(gravity=[0, 0, -5])
    world.set_frame('hand', [0.61, 0, 0.01], IDENTITY)
    world.cut('hose', node=15)


def test_an_edit_of_one_world_is_of_that_world(scene):
    batch, alone = Batch(scene, 40), World(scene)
    other = alone.copy()
    for world in (batch.worlds[17], alone):
        edit(world)
    batch.step(20)
    alone.step(20)
    other.step(20)
    assert batch.state_hash == [alone.state_hash if i == 17 else other.state_hash for i in range(40)]
    assert batch.worlds[17].cable_names == alone.cable_names != batch.worlds[16].cable_names
    assert batch.events(17) == alone.events()
    assert batch.worlds[17].ledger() == alone.ledger() == batch.ledger(17)


@pytest.mark.parametrize('call', [
    lambda target, *world: target.pin(*world, 'hose', node=4, keep_offset=True),
    lambda target, *world: target.cut(*world, 'hose', arc_length=0.5),
    lambda target, *world: target.tune(*world, wind=[1, 0, 0], materials={'wire': {'drag': 0.1}}),
    lambda target, *world: target.set_length(*world, 'hose', True, 0.9, speed=0.1),
    lambda target, *world: target.set_state(*world, 'hose', velocities=numpy.zeros((21, 3))),
    lambda target, *world: target.set_obstacle(*world, 'floor', type='plane', pose=[0, 0, -1, 0, 0, 0]),
    lambda target, *world: target.set_frame(*world, 'hand', [0.61, 0, 0], IDENTITY),
    lambda target, *world: target.add_frame(*world, 'peg', [0, 0, 0], IDENTITY),
    lambda target, *world: target.unpin(*world, 'right'),
    lambda target, *world: target.save(*world),
])
def test_methods_of_world_are_those_of_batch_with_an_index(scene, call):
    batch, alone = Batch(scene, 3), World(scene)
    batch.step(3)
    alone.step(3)
    before = alone.state_hash
    assert call(batch, -1) == call(alone) == call(batch.worlds[1])
    assert batch.state_hash == [before, alone.state_hash, alone.state_hash]
    batch.step(9)
    alone.step(9)
    assert batch.state_hash[1:] == [alone.state_hash] * 2


def test_every_method_of_world_is_there_for_one_of_a_batch(scene):
    view = Batch(scene, 2).worlds[0]
    assert type(view) is World
    for name in BY_WORLD:
        assert re.match(rf'{name}\(self: \S+, world: int', getattr(Batch, name).__doc__), name
        assert f'As World.{name}, of one of the worlds' in getattr(Batch, name).__doc__
    own = {name for name, _ in inspect.getmembers(World) if not name.startswith('_')}
    assert own - set(dir(Batch)) == {'load', 'scene', 'cable_names', 'net_names', 'particle_names', 'body_names', 'guide_names',
                                     'attachment_names', 'obstacle_names', 'frame_names', 'sensitivity', 'track_sensitivity'}


def test_worlds_are_a_sequence(scene):
    batch = Batch(scene, 4)
    batch.worlds[2].step(5)
    assert len(batch.worlds) == 4 and [round(world.time / scene.time_step) for world in batch.worlds] == [0, 0, 5, 0]
    assert batch.worlds[-2].time == batch.time[2]
    for index in (4, -5):
        with pytest.raises(IndexError, match=f'index: {index}; allowed: -4 to 3'):
            batch.worlds[index]
        with pytest.raises(IndexError, match='allowed: -4 to 3'):
            batch.pin(index, 'hose', node=3)
    with pytest.raises(TypeError, match=re.escape('index: slice(1, 2, None); allowed: an integer')):
        batch.worlds[1:2]
    with pytest.raises(TypeError, match=re.escape('a Batch has no items; allowed: batch.worlds[2] for one of its worlds')):
        batch[2]


def test_a_view_keeps_its_batch_and_sees_what_the_batch_does(scene):
    view = Batch(scene, 3).worlds[1]
    gc.collect()
    assert view.step(3) == 'ok' and view.time == pytest.approx(3 * scene.time_step)
    batch = Batch(scene, 3)
    view = batch.worlds[1]
    batch.set_material('wire', bending_stiffness=[0.01, 0.02, 0.03])
    batch.step(4)
    assert view.state_hash == batch.state_hash[1] and (view.positions('hose') == batch.positions('hose')[1]).all()


def test_copies_of_a_view_are_worlds_of_their_own(scene):
    batch = Batch(scene, 3)
    batch.step(4)
    view = batch.worlds[1]
    for other in (view.copy(), copy.deepcopy(view), pickle.loads(pickle.dumps(view)), World.load(scene, view.save())):
        other.step(5)
        assert other.state_hash != view.state_hash == batch.state_hash[1]
    assert view.copy().state_hash == view.state_hash


def test_a_world_of_a_batch_is_a_start_for_others(scene):
    batch = Batch(scene, 3)
    batch.worlds[0].step(7)
    batch.set_world([0, 2], batch.worlds[0])
    assert batch.state_hash[0] == batch.state_hash[2] != batch.state_hash[1]
    assert Batch(batch.worlds[2], 2).state_hash == [batch.state_hash[2]] * 2


def test_changes_drop_the_records_and_refused_ones_do_not(scene):
    batch = Batch(scene, 2)
    batch.step(4, record_every=2)
    with pytest.raises(KeyError, match='rope'):
        batch.worlds[0].pin('rope', node=1)
    batch.contacts(0), batch.events(1), batch.save(1)
    assert batch.positions('hose').shape == (2, 2, 21, 3)
    batch.worlds[0].pin('hose', node=10, keep_offset=True)
    assert batch.positions('hose').shape == (2, 21, 3)


def test_edited_batches_are_pickled(scene):
    batch = Batch(scene, 3)
    edit(batch.worlds[1])
    batch.step(3)
    other = pickle.loads(pickle.dumps(batch))
    for one in (batch, other):
        one.step(10)
    assert batch.state_hash == other.state_hash


def test_a_frame_that_one_world_lacks_is_named_with_the_world(scene):
    batch = Batch(scene, 3)
    batch.worlds[0].add_frame('peg', [0, 0, 0], IDENTITY)
    with pytest.raises(KeyError, match='world 1: name: .*peg.*allowed: hand'):
        batch.set_frames('peg', numpy.tile([0, 0, 0, *IDENTITY], (3, 1)))
