"""What a call says that does not fit: the argument, what was given, what is allowed."""
import re
from fractions import Fraction

import numpy
import pytest

from verlet_cable.sim import Batch, Scene, SceneError, World
from worlds import IDENTITY, world_of


@pytest.mark.parametrize('call, text', [
    (lambda world, batch: Scene('hose.yaml'), 'Scene is not made by calling it; allowed: Scene.load(path) for a file,'),
    (lambda world, batch: Scene.from_dict('hose.yaml'), "keys: 'hose.yaml'; allowed: a dict; Scene.load(path) reads a file"),
    (lambda world, batch: World('hose.yaml'), "scene: 'hose.yaml'; allowed: a Scene; Scene.load(path) reads a file"),
    (lambda world, batch: World({'cables': []}), "scene: {'cables': []}; allowed: a Scene; Scene.from_dict(keys) makes one of a dict"),
    (lambda world, batch: World(), 'scene: missing; allowed: a Scene'),
    (lambda world, batch: Batch('hose.yaml', 4), "scene: 'hose.yaml'; allowed: a Scene; Scene.load(path) reads a file"),
    (lambda world, batch: Batch(world, 'four'), "count: 'four'; allowed: an integer"),
    (lambda world, batch: world.set_frame('hand', [0, 0, 0, *IDENTITY]), 'quaternion_xyzw: missing; allowed: numbers'),
    (lambda world, batch: world.set_frame('hand', ['a', 0, 0], IDENTITY), "position: ['a', 0, 0]; allowed: numbers"),
    (lambda world, batch: world.positions(3), 'name: 3; allowed: text'),
    (lambda world, batch: world.step('10'), "steps: '10'; allowed: an integer"),
    (lambda world, batch: world.step(1, 2), '2 arguments without a name; allowed: at most 1: steps'),
    (lambda world, batch: world.tune(gravitiy=[0, 0, 0]), 'gravitiy: no such argument (did you mean gravity?); allowed: gravity,'),
    (lambda world, batch: world.pin('hose', node=1.5), 'node: 1.5; allowed: None, or an integer'),
    (lambda world, batch: world.pin('hose', node=1, clamp=1), 'clamp: 1; allowed: True or False'),
    (lambda world, batch: batch.set_world(0, None), 'world: None; allowed: a World'),
    (lambda world, batch: batch.step(1, fields='positions'), "fields: 'positions'; allowed: a list, of each text"),
    (lambda world, batch: batch.observations(['positions']), "parts: ['positions']; allowed: a list, of each (text, text) or"),
    (lambda world, batch: batch.world(), 'index: missing; allowed: an integer'),
])
def test_a_call_that_does_not_fit_says_what_is_allowed(hang, call, text):
    world = world_of(hang)
    with pytest.raises(TypeError, match='^' + re.escape(text)) as error:
        call(world, Batch(Scene.from_dict(hang), 2))
    assert 'incompatible' not in str(error.value) and '_simulation' not in str(error.value)


@pytest.mark.parametrize('call, text', [
    (lambda world, batch: world.set_frame('hans', [0, 0, 0], IDENTITY), 'name: "hans"; allowed: hand'),
    (lambda world, batch: world.wrench('rihgt'), 'attachment: "rihgt"; allowed: left, right (did you mean right?)'),
    (lambda world, batch: batch.wrench('zzz'), 'attachment: "zzz"; allowed: left, right'),
    (lambda world, batch: batch.step(2, record_every=1, fields=['position']), '(did you mean positions?)'),
    (lambda world, batch: batch.set_material('wire', bend_stiffness=1), '(did you mean bending_stiffness?)'),
    (lambda world, batch: batch.step(2, record_every=2, fields=['positions']) or batch.tension('hose'),
     "tension: not recorded; allowed: what `fields` of the last step named: positions; step(..., fields=['tension']) records it"),
    (lambda world, batch: world.pin('hose', node=10, frame_id='there', offset=[9, 0, 0]), 'to hold it where it is: keep_offset=True'),
])
def test_a_name_or_number_that_does_not_fit_says_what_was_meant(hang, call, text):
    with pytest.raises((KeyError, ValueError)) as error:
        call(world_of(hang), Batch(Scene.from_dict(hang), 2))
    assert error.value.args[0].endswith(text)


@pytest.mark.parametrize('numbers, shown', [
    ([[1j] * 7] * 2, 'poses: [[1j'), ([[None] * 7] * 2, 'poses: [[None'), ([['0'] * 7] * 2, "poses: [['0'"), ([[0] * 7, [0]], 'poses: [[0')])
def test_numbers_are_real_ones(hang, numbers, shown):
    batch = Batch(Scene.from_dict(hang), 2)
    before = batch.state_hash
    with pytest.raises(TypeError, match='^' + re.escape(shown) + '.*; allowed: numbers that are real, as an array or nested sequences'):
        batch.set_frames('hand', numbers)
    batch.set_frames('hand', [[Fraction(3, 5), 0, 0, 0, 0, 0, numpy.float32(1)], (0.6, False, 0, 0, 0, 0, numpy.int8(1))])
    batch.step()
    assert batch.state_hash[0] == batch.state_hash[1] != before[0]


def test_documentation_and_errors_of_methods_are_what_they_were(hang):
    assert World.step.__name__ == 'step' and 'Advances by a number of time steps' in World.step.__doc__
    with pytest.raises(KeyError, match='handle'):
        world_of(hang).set_frame('handle', [0, 0, 0], IDENTITY)


def test_an_offset_needs_no_rotation(hang):
    with_rotation, without = world_of(hang), world_of(hang)
    with_rotation.pin('hose', node=10, offset=[0.3, 0, -0.3, 0, 0, 0, 1])
    without.pin('hose', node=10, offset=[0.3, 0, -0.3])
    with_rotation.step(20)
    without.step(20)
    assert with_rotation.state_hash == without.state_hash
    with pytest.raises(ValueError, match=re.escape('offset: shape (4,); allowed: (7,), or (3,) without rotation')):
        without.pin('hose', node=5, offset=[0, 0, 0, 1])


def test_a_scene_without_a_path_is_refused_as_one_that_is_not_there():
    with pytest.raises(SceneError, match='scene: cannot read ""'):
        Scene.load('')


def test_an_integer_of_any_size_is_told(hang):
    with pytest.raises(TypeError, match=f'^node: {2 ** 70}; allowed: an integer; this one is too large$'):
        world_of(hang).apply_force('hose', 2 ** 70, [0, 0, 1])
