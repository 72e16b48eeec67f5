"""Derivatives of a world's state: against closed forms and differences, and what is refused."""
import copy
import pickle

import numpy
import pytest

from verlet_cable.sim import Batch, Scene, World
from worlds import IDENTITY, world_of

HOSE = {
    'time_step': 0.002, 'tolerance': 1e-6, 'fluid': {'velocity': [0, 1, 0]},
    'materials': {'m': {'linear_density': 0.08, 'radius': 0.005, 'bending_stiffness': 0.02, 'drag': 0.05}},
    'cables': [{'name': 'hose', 'length': 0.6, 'segments': 12, 'material': 'm', 'initial': {'type': 'settled'},
                'attachments': [{'name': 'grip', 'at': 'start', 'frame': 'hand', 'type': 'clamp', 'initial_pose': [0, 0, 0, 0, 0, 0]},
                                {'name': 'peg', 'at': 'end', 'offset': [0.4, 0.1, 0]}]}]}
OUTPUTS = ['positions:hose', 'velocities:hose', 'tension:hose', 'wrench:peg']


def hose(**material):
    scene = copy.deepcopy(HOSE)
    scene['materials']['m'].update(material)
    return scene


def swing(world, steps=40):
    """Moves the hand; returns the world."""
    for i in range(1, steps + 1):
        t = 0.002 * i
        world.set_frame('hand', [0.02 * (1 - numpy.cos(15 * t)), 0, 0.03 * (1 - numpy.cos(11 * t))], IDENTITY)
        world.step()
    return world


def test_shapes_are_those_of_the_outputs_with_columns():
    world = world_of(HOSE)
    found = world.sensitivity(OUTPUTS, ['drag:hose', 'pose:hand', 'gravity'])
    assert {name: array.shape for name, array in found.items()} == {
        'positions:hose': (13, 3, 10), 'velocities:hose': (13, 3, 10), 'tension:hose': (12, 10), 'wrench:peg': (6, 10)}
    alone = world.sensitivity('tension:hose', 'gravity')
    assert numpy.array_equal(alone, found['tension:hose'][:, 7:])
    assert not alone.flags.writeable


def test_a_motion_has_the_derivatives_of_differences():
    value, change = 0.02, 4e-5
    world = world_of(HOSE)
    world.track_sensitivity(['drag:hose', 'bending_stiffness:hose'])
    swing(world)
    found = world.sensitivity(OUTPUTS, 'bending_stiffness:hose')
    more, less = (swing(world_of(hose(bending_stiffness=value + sign * change))) for sign in (1, -1))
    # Differences of what a step forgets, forces and velocities, contain what the tolerance of the solver leaves.
    for name, read, part in (('positions:hose', World.positions, 1e-5), ('velocities:hose', World.velocities, 1e-3),
                             ('tension:hose', World.tension, 1e-3), ('wrench:peg', World.wrench, 1e-3)):
        expected = (read(more, name.split(':')[1]) - read(less, name.split(':')[1])) / (2 * change)
        assert numpy.linalg.norm(found[name][..., 0] - expected) < part * numpy.linalg.norm(expected), name


def loaded(change='', by=0):
    """A hose that stretches, with a weight on it, held by one hand at its start and in its middle and by a peg; one number is changed."""
    scene = hose(axial_stiffness=2e3, axial_damping=2, bending_damping=2e-4)
    cable, material = scene['cables'][0], scene['materials']['m']
    if change in material:
        material[change] += by
    if change == 'length':
        cable['length'] += by
    at = cable['length'] / 0.6  # places on it grow with it
    cable['point_masses'] = [{'at': 0.45 * at, 'mass': 0.03}]
    cable['attachments'].append({'name': 'middle', 'at': 0.25 * at, 'offset': [0.2, 0, -0.02], 'frame': 'hand', 'type': 'hinge'})
    return scene


@pytest.mark.parametrize('parameter, change', [
    ('length', 6e-6), ('linear_density', 8e-6), ('drag', 5e-6), ('bending_stiffness', 2e-6), ('bending_damping', 2e-7),
    ('axial_stiffness', 0.2), ('axial_damping', 2e-3)])
def test_a_loaded_hose_in_three_holders_has_the_derivatives_of_differences(parameter, change):
    world = world_of(loaded())
    world.track_sensitivity(parameter + ':hose')
    found = swing(world, 100).sensitivity('positions:hose')[..., 0]
    more, less = (swing(world_of(loaded(parameter, sign * change)), 100).positions('hose') for sign in (1, -1))
    expected = (more - less) / (2 * change)
    assert numpy.linalg.norm(found - expected) < 1e-4 * numpy.linalg.norm(expected)


def test_forces_of_an_equilibrium_are_those_on_its_holders():
    """The weight that comes with a heavier hose hangs on both holders."""
    world = world_of(hose(drag=0))
    found = world.sensitivity(['wrench:grip', 'wrench:peg'], 'linear_density:hose')
    force = found['wrench:grip'][:3, 0] + found['wrench:peg'][:3, 0]
    numpy.testing.assert_allclose(force, [0, 0, -9.81 * 0.6], atol=1e-9)


def test_gauss_newton_finds_what_a_motion_was_made_with():
    values = numpy.array([0.02, 0.05])
    film = swing(world_of(hose(bending_stiffness=values[0], drag=values[1])), 60).positions('hose')
    found = numpy.array([0.015, 0.08])
    for _ in range(6):
        world = world_of(hose(bending_stiffness=found[0], drag=found[1]))
        world.track_sensitivity(['bending_stiffness:hose', 'drag:hose'])
        swing(world, 60)
        jacobian = world.sensitivity('positions:hose').reshape(-1, 2)
        found = found + numpy.linalg.lstsq(jacobian, (film - world.positions('hose')).ravel(), rcond=None)[0]
    numpy.testing.assert_allclose(found, values, rtol=1e-6)


def test_trajectories_are_the_same_with_and_without():
    followed, alone = world_of(HOSE), world_of(HOSE)
    followed.track_sensitivity('drag:hose')
    assert swing(followed).state_hash == swing(alone).state_hash


def test_copies_and_pickles_are_without():
    world = world_of(HOSE)
    world.track_sensitivity('drag:hose')
    swing(world, 3)
    for other in (world.copy(), pickle.loads(pickle.dumps(world)), World.load(world.scene, world.save())):
        with pytest.raises(ValueError, match='after track_sensitivity'):
            other.sensitivity('positions:hose')
    world.track_sensitivity(None)
    with pytest.raises(ValueError, match='after track_sensitivity'):
        world.sensitivity('positions:hose')


def test_what_is_not_known_is_refused_and_changes_nothing():
    world = world_of(HOSE)
    world.track_sensitivity('drag:hose')
    for parameters, start, message in (
            (['drag:rope', 'stiffness:hose'], 'settled', '(?s)cables: hose.*bending_stiffness'), ([], 'settled', 'none'),
            ('length:hose', 'given', 'settled'), ('drag:hose', 'moving', "'settled', 'given'")):
        with pytest.raises(ValueError, match=message):
            world.track_sensitivity(parameters, start)
    with pytest.raises(TypeError):
        world.track_sensitivity([1])
    for output, message in (('curvature:hose', 'positions:CABLE'), ('positions:rope', 'hose'), ('wrench:hand', 'grip')):
        with pytest.raises(ValueError, match=message):
            world.sensitivity(output)
    with pytest.raises(ValueError, match='drag:hose'):
        world.sensitivity('positions:hose', 'gravity')
    assert world.sensitivity('positions:hose').shape == (13, 3, 1)
    with pytest.raises(ValueError, match='copy'):
        Batch(Scene.from_dict(HOSE), 2).worlds[0].track_sensitivity('drag:hose')


def test_derivatives_end_where_a_state_is_given():
    """It does not depend on anything, even if it is the one that there was."""
    world = world_of(HOSE)
    world.track_sensitivity('drag:hose')
    swing(world, 5)
    world.set_state('hose', world.positions('hose'), world.velocities('hose'))
    with pytest.raises(ValueError, match='edited.*track_sensitivity'):
        world.sensitivity('positions:hose')


def test_derivatives_end_with_an_edit():
    world = world_of(HOSE)
    world.track_sensitivity('drag:hose')
    world.unpin('peg')
    for _ in range(2):
        with pytest.raises(ValueError, match='no derivatives any longer'):
            world.sensitivity('positions:hose')
        world.step()
    piece = world.cut('hose', node=6).second
    with pytest.raises(ValueError, match='came later'):
        world.sensitivity(f'positions:{piece}')


def test_what_is_asked_for_wrongly_is_named_with_what_is_allowed():
    """Of both arguments at once."""
    world = world_of(HOSE)
    world.settle()
    with pytest.raises(ValueError) as caught:
        world.sensitivity('position:hose')
    lines = str(caught.value).splitlines()
    assert lines[0].startswith('outputs: "position:hose"; allowed: positions:CABLE, velocities:CABLE')
    assert lines[1].startswith('parameters: None; allowed: KEY:CABLE with a key axial_stiffness, ') and 'track_sensitivity' in lines[1]
    with pytest.raises(ValueError) as caught:
        world.sensitivity(['positions:rope', 'tension:hose', 'wrench:hose'], ['drag:rope', 'mass:hose'])
    assert [line.split(';')[0] for line in str(caught.value).splitlines()] == [
        'outputs: "positions:rope"', 'outputs: "wrench:hose"', 'parameters: "drag:rope"', 'parameters: "mass:hose"']
    for call, text in ((lambda: world.sensitivity(5, 'gravity'), 'outputs: 5; allowed: a text, or a list of texts: positions:CABLE'),
                       (lambda: world.sensitivity(['positions:hose', 3], 'gravity'), 'outputs: 3; allowed: a text, or a list'),
                       (lambda: world.sensitivity('positions:hose', 5), 'parameters: 5; allowed: a text, or a list of texts: KEY:CABLE'),
                       (lambda: world.track_sensitivity(1j), 'parameters: 1j; allowed: a text, or a list of texts: KEY:CABLE')):
        with pytest.raises(TypeError) as caught:
            call()
        assert str(caught.value).startswith(text)
    with pytest.raises(ValueError, match=r'^outputs: \[\]; allowed: positions:CABLE'):
        world.sensitivity([], 'gravity')
