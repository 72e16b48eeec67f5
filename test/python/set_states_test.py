"""Bodies, guides and cables that are put elsewhere, one alone and several at once."""
import copy
import pathlib

import numpy
import pytest

from verlet_cable.sim import Batch, Scene, World
from worlds import IDENTITY, world_of

CONFIG = pathlib.Path(__file__).resolve().parents[2] / 'config'
NOT_SCENES = {'materials.yaml', 'replay.yaml', 'sweep.yaml'}
SHIPPED = sorted(path for folder in ('', 'examples', 'scenes', 'scenes/lecture') for path in (CONFIG / folder).glob('*.yaml')
                 if path.name not in NOT_SCENES)
DT = 0.002
ROPE = {'linear_density': 0.05, 'radius': 0.003}
PLUG = {'name': 'load', 'mass': 0.5, 'inertia': [1e-3, 1e-3, 1e-3], 'pose': [0, 0, -1, 0, 0, 0]}
PENDULUM = {
    'time_step': DT, 'materials': {'m': ROPE}, 'bodies': [PLUG],
    'cables': [{'name': 'rope', 'length': 1.0, 'segments': 10, 'material': 'm', 'attachments': [
        {'name': 'peg', 'at': 'start'}, {'name': 'eye', 'at': 'end', 'body': 'load'}]}]}
# Two loads on a rope over a sheave of 0.1 m, whose arc is pi/10 m long: half of the rope hangs on each side.
LENGTH = 2 + numpy.pi / 10
ATWOOD = {
    'time_step': DT, 'materials': {'m': ROPE},
    'bodies': [dict(PLUG, name='left', pose=[-0.1, 0, -1, 0, 0, 0]), dict(PLUG, name='right', pose=[0.1, 0, -1, 0, 0, 0])],
    'guides': [{'name': 'sheave', 'cable': 'rope', 'at': LENGTH / 2, 'type': 'sheave', 'radius': 0.1, 'rotation': [1.5707963267948966, 0, 0]}],
    'cables': [{'name': 'rope', 'length': LENGTH, 'segments': 40, 'material': 'm', 'attachments': [
        {'name': 'a', 'at': 'start', 'body': 'left'}, {'name': 'b', 'at': 'end', 'body': 'right'}]}]}


def pose(x, y, z):
    return [x, y, z, *IDENTITY]


def lengths(world):
    return numpy.linalg.norm(numpy.diff(world.positions('rope'), axis=0), axis=1)


def test_a_body_that_nothing_holds_is_where_and_as_fast_as_it_was_set():
    scene = {'time_step': DT, 'materials': {'m': ROPE}, 'bodies': [dict(PLUG)], 'cables': [
        {'name': 'rope', 'length': 1.0, 'segments': 5, 'material': 'm', 'attachments': [{'name': 'peg', 'at': 'start', 'offset': [5, 0, 0]}]}]}
    world = world_of(scene)
    world.step(100)
    turned = [0, 0, numpy.sin(0.3), numpy.cos(0.3)]
    world.set_state('load', pose=[1, 2, 3, *turned], twist=[0.5, 0, 2, 0, 0, 1.5])
    assert numpy.allclose(world.body_pose('load'), [1, 2, 3, *turned], atol=1e-15)
    assert world.body_twist('load').tolist() == [0.5, 0, 2, 0, 0, 1.5]
    world.step(100)
    t = 100 * DT
    assert world.body_pose('load')[:3] == pytest.approx([1 + 0.5 * t, 2, 3 + 2 * t - 9.81 / 2 * t * t], abs=1e-9)
    assert world.body_pose('load')[3:] == pytest.approx([0, 0, numpy.sin(0.3 + 0.75 * t), numpy.cos(0.3 + 0.75 * t)], abs=1e-6)


def test_a_load_on_a_rope_swings_as_one_that_begins_there():
    """The rope is light: a pendulum of 1 m, let go at 0.5 rad, comes to the bottom with sqrt(2 g (1 - cos 0.5)) m/s."""
    place = [numpy.sin(0.5), 0, -numpy.cos(0.5)]
    light = dict(PENDULUM, materials={'m': dict(ROPE, linear_density=1e-4)})
    world = world_of(light)
    world.step(50)
    world.set_state('load', pose=pose(*place), twist=numpy.zeros(6))
    assert lengths(world) == pytest.approx(0.1, rel=1e-6)
    assert world.positions('rope')[-1] == pytest.approx(place, abs=1e-12)
    began = copy.deepcopy(light)
    began['bodies'][0]['pose'] = [*place, 0, 0, 0]
    other = world_of(began)
    fastest = 0
    for _ in range(300):
        assert world.step() == 'ok'
        other.step()
        fastest = max(fastest, numpy.linalg.norm(world.body_twist('load')[:3]))
    assert fastest == pytest.approx(numpy.sqrt(2 * 9.81 * (1 - numpy.cos(0.5))), rel=2e-3)
    assert world.body_pose('load')[:3] == pytest.approx(other.body_pose('load')[:3], abs=2e-3)


def test_what_a_rope_does_not_allow_of_a_velocity_the_next_step_takes_away():
    world = world_of(PENDULUM)
    world.step(50)
    world.set_state('load', twist=[0.3, 0, -1, 0, 0, 0])
    world.step()
    assert world.body_twist('load')[:3] == pytest.approx([0.3, 0, 0], abs=0.02)
    assert lengths(world) == pytest.approx(0.1, rel=1e-5)


def test_the_ledger_closes_over_what_was_set():
    world = world_of(PENDULUM)
    world.step(20)
    world.set_state('load', pose=pose(0.4, 0, -0.8), twist=[0, 0.5, 0, 0, 0, 0])
    world.step(200)
    ledger = world.ledger()
    books = sum(ledger['work'].values()) - sum(ledger['dissipated'].values())
    assert ledger['change'] == pytest.approx(books + ledger['unaccounted'], abs=1e-9)
    assert abs(ledger['unaccounted']) < 1e-4


def test_a_rope_goes_over_its_sheave_with_both_loads():
    world = world_of(ATWOOD)
    world.step(20)
    assert world.arc_length('sheave') == pytest.approx(LENGTH / 2, abs=1e-3)
    nodes = len(world.positions('rope'))
    for lower in (0.3, -0.5, 0.0):
        world.set_states({'left': {'pose': pose(-0.1, 0, -1 - lower), 'twist': numpy.zeros(6)},
                          'right': {'pose': pose(0.1, 0, -1 + lower), 'twist': numpy.zeros(6)},
                          'sheave': {'arc_length': LENGTH / 2 + lower}})
        assert world.arc_length('sheave') == pytest.approx(LENGTH / 2 + lower, abs=1e-9)
        assert abs(len(world.positions('rope')) - nodes) <= 2
        # Equal loads are at rest anywhere, but for the weight of the rope: 0.05 kg/m of it for 2 x 0.3 m against 1 kg.
        before = world.body_pose('left')[2]
        assert world.step(25) in ('ok', 'jumped')
        assert abs(world.body_pose('left')[2] - before) < 0.02


def test_a_slack_rope_goes_through_an_eyelet():
    scene = {'time_step': DT, 'materials': {'m': ROPE}, 'guides': [{'name': 'eye', 'cable': 'rope', 'at': 1.0, 'offset': [0.5, 0, 0]}],
             'cables': [{'name': 'rope', 'length': 2.0, 'segments': 40, 'material': 'm', 'attachments': [
                 {'name': 'a', 'at': 'start'}, {'name': 'b', 'at': 'end', 'offset': [1, 0, 0]}]}]}
    world = world_of(scene)
    world.step(10)
    world.set_state('eye', arc_length=0.8)
    assert world.arc_length('eye') == pytest.approx(0.8, abs=1e-9)
    assert world.step(50) == 'ok'
    before = world.state_hash
    for arguments, words in [({'arc_length': 0.3}, 'arc_length'), ({'arc_length': -1}, 'arc_length: -1; must be from 0.05 to 1.95 m'),
                             ({'positions': numpy.zeros((2, 3))}, 'positions: of the guide "eye"; allowed: arc_length')]:
        with pytest.raises(ValueError, match=words):
            world.set_state('eye', **arguments)
    assert world.state_hash == before


def test_states_go_from_world_to_world():
    """As an estimator has them: bodies and cables of one world are put into another one, which then goes on alike."""
    first, second = world_of(PENDULUM), world_of(PENDULUM)
    first.set_state('load', pose=pose(0.3, 0, -0.9))
    first.step(120)
    second.set_states({'load': {'pose': first.body_pose('load'), 'twist': first.body_twist('load')},
                       'rope': {'positions': first.positions('rope'), 'velocities': first.velocities('rope')}})
    assert second.positions('rope') == pytest.approx(first.positions('rope'), abs=1e-6)
    for world in (first, second):
        world.step(60)
    assert second.positions('rope') == pytest.approx(first.positions('rope'), abs=5e-3)
    assert second.body_pose('load') == pytest.approx(first.body_pose('load'), abs=5e-3)
    again = World.load(Scene.from_dict(PENDULUM), second.save())
    for world in (second, again):
        world.step(10)
    assert again.state_hash == second.state_hash


def test_what_cannot_be_is_refused_and_changes_nothing():
    held = copy.deepcopy(PENDULUM)
    held['bodies'].append(dict(PLUG, name='hook', pose=[3, 0, 0, 0, 0, 0], attachments=[{'name': 'hand', 'frame': 'hand'}]))
    world = world_of(held)
    world.set_frame('hand', [3, 0, 0], IDENTITY)
    world.step(3)
    before = world.state_hash
    for call, error, words in [
            (lambda: world.set_state('load', pose=pose(0, 0, -1.2)), ValueError, 'pose: too far for the cable rope'),
            (lambda: world.set_state('hook', pose=pose(0, 0, 0)), ValueError, 'pose: of a body held by hand; allowed: of bodies that nothing'),
            (lambda: world.set_state('load', pose=pose(0, numpy.nan, 0)), ValueError, 'pose: .*nan.*finite'),
            (lambda: world.set_state('load', pose=[0, 0, 0]), ValueError, r'pose: shape \(3,\); allowed: \(7,\)'),
            (lambda: world.set_state('load', twist=[0, 0, numpy.inf, 0, 0, 0]), ValueError, 'twist.linear.z: inf'),
            (lambda: world.set_state('load', positions=numpy.zeros((2, 3))), ValueError, 'positions: of the body "load"; allowed: pose, twist'),
            (lambda: world.set_state('rope', pose=pose(0, 0, 0)), ValueError, 'pose: of the cable "rope"; allowed: positions, velocities'),
            (lambda: world.set_state('lode', pose=pose(0, 0, 0)), KeyError, 'cable: "lode"; allowed: rope, load, hook .did you mean load'),
            (lambda: world.set_states({'load': {'posse': 1}}), KeyError, 'no such key; allowed: positions, velocities, pose'),
            (lambda: world.set_states({'load': 3}), TypeError, 'load.*: 3; allowed: a dict'),
            (lambda: world.set_states({'load': {'pose': pose(0, 0, -1)}, 'rope': {'positions': numpy.zeros((3, 3))}}), ValueError,
             'rope.positions: 3; must be 11')]:
        with pytest.raises(error, match=words):
            call()
        assert world.state_hash == before, words


def test_a_batch_sets_states_of_one_of_its_worlds():
    batch = Batch(Scene.from_dict(PENDULUM), 3)
    alone = world_of(PENDULUM)
    for one in (batch.worlds[1], alone):
        one.set_state('load', pose=pose(0.3, 0, -0.9))
    batch.step(20)
    alone.step(20)
    assert batch.state_hash[1] == alone.state_hash != batch.state_hash[0]


def states_of(world):
    """{name: its own state} of all cables, bodies, and guides that have a cable."""
    states = {name: {'positions': world.positions(name), 'velocities': world.velocities(name)} for name in world.cable_names}
    states.update({name: {'pose': world.body_pose(name), 'twist': world.body_twist(name)} for name in world.body_names})
    for name in world.guide_names:
        try:
            states[name] = {'arc_length': world.arc_length(name)}
        except ValueError as error:
            assert 'has no cable in it' in str(error)
    return states


@pytest.mark.parametrize('path', SHIPPED, ids=lambda path: path.stem)
def test_what_a_shipped_scene_tells_of_itself_can_be_set(path):
    """Of each thing alone, and of all at once: it then goes on as it would have."""
    motion = next((file for file in (path.with_suffix('.csv'), path.with_name(path.stem + '_motion.csv')) if file.exists()), None)
    world = World(Scene.load(path), motion)
    for steps in (0, round(0.5 / world.scene.time_step)):
        world.step(steps)
        states = states_of(world)
        ahead = world.copy()
        ahead.step(2)
        for some in [*({name: state} for name, state in states.items()), states]:
            other = world.copy()
            other.set_states(some)
            for name, state in states_of(other).items():
                for key in ('positions', 'pose', 'arc_length'):
                    if key in state:
                        assert state[key] == pytest.approx(states[name][key], abs=1e-6), (name, list(some))
            assert other.step(2) in ('ok', 'jumped', ahead.copy().step()), list(some)
            for name in world.body_names:
                assert other.body_pose(name) == pytest.approx(ahead.body_pose(name), abs=1e-3), (name, list(some))


def eyelet(**material):
    """A load on a rope that comes from a peg through an eyelet at the origin."""
    return {'time_step': DT, 'materials': {'m': dict(ROPE, **material)}, 'bodies': [PLUG],
            'contact': {'self': True, 'between_cables': True, 'friction': 0.3},
            'guides': [{'name': 'eye', 'cable': 'rope', 'at': 1.0, 'friction': 0.1}],
            'cables': [{'name': 'rope', 'length': 2.0, 'segments': 40, 'material': 'm', 'attachments': [
                {'name': 'peg', 'at': 'start', 'offset': [-0.98, 0, 0]}, {'name': 'hook', 'at': 'end', 'body': 'load'}]}]}


@pytest.mark.parametrize('material', [{}, {'bending_stiffness': 1e-3, 'bending_damping': 1e-5}, {'axial_stiffness': 1e4, 'axial_damping': 1.0}],
                         ids=['rope', 'wire', 'elastic'])
def test_all_that_a_load_at_an_eyelet_can_do_can_be_set(material):
    """Anywhere within what the eyelet lets through, but where the rope would go through itself: its bight is on the peg's side."""
    begun = world_of(eyelet(**material))
    begun.step(20)
    random = numpy.random.default_rng(1)
    for _ in range(25):
        world = begun.copy()
        through = random.uniform(0.985, 1.9)
        reach = (2 - through) * random.choice([random.uniform(0.2, 0.95), 0.9995])
        angle = random.uniform(0, 1.2)
        place = pose(reach * numpy.sin(angle), 0, -reach * numpy.cos(angle))
        world.set_states({'load': {'pose': place, 'twist': numpy.zeros(6)}, 'eye': {'arc_length': through}})
        case = through, reach, angle
        assert world.arc_length('eye') == pytest.approx(through, abs=1e-6), case
        assert world.body_pose('load') == pytest.approx(place, abs=1e-12), case
        assert lengths(world).sum() == pytest.approx(2, rel=2e-3), case
        assert world.step(25) in ('ok', 'jumped'), case
        # It is let go from there: no faster than what falls, or swings.
        speed = numpy.linalg.norm(world.body_twist('load')[:3])
        assert speed < 1.2 * 9.81 * 25 * DT, case


HARNESS = {
    'materials': {'m': {'linear_density': 0.1, 'radius': 0.005, 'bending_stiffness': 0.01}},
    'cables': [
        {'name': 'trunk', 'length': 1.0, 'segments': 20, 'material': 'm', 'attachments': [
            {'name': 'left', 'at': 'start', 'offset': [0, 0, 1]}, {'name': 'right', 'at': 'end', 'offset': [0.8, 0, 1]}]},
        {'name': 'branch', 'length': 0.5, 'segments': 10, 'material': 'm'}],
    'junctions': [{'name': 'fork', 'cable': 'trunk', 'at': 0.5, 'branches': [
        {'cable': 'branch', 'end': 'start', 'rotation': [0, 0, 1.57]}]}]}


def shaken(scene):
    world = world_of(scene)
    world.apply_force('branch', 10, [0.3, 0.3, 0])
    world.step(300)
    return world


def of_cables(world, names):
    return {name: {'positions': world.positions(name), 'velocities': world.velocities(name)} for name in names}


@pytest.mark.parametrize('names', [('trunk', 'branch'), ('branch', 'trunk')])
def test_junctions_go_with_the_cables_that_they_join(names):
    one, other = shaken(HARNESS), world_of(HARNESS)
    other.set_states(of_cables(one, names))
    for name in names:
        assert abs(other.positions(name) - one.positions(name)).max() < 1e-8
        assert abs(other.velocities(name) - one.velocities(name)).max() < 1e-3
    other.step()
    for name in names:  # it starts as it was, not with a jump
        assert abs(other.positions(name) - one.positions(name)).max() < 2e-3


def test_a_branch_that_is_given_no_place_goes_with_its_trunk():
    one, other = shaken(HARNESS), world_of(HARNESS)
    before = other.positions('branch')
    other.set_states(of_cables(one, ['trunk']))
    assert abs(other.positions('trunk') - one.positions('trunk')).max() < 1e-8
    assert abs(other.positions('branch')[0] - one.positions('trunk')[10]).max() < 1e-8
    lengths_of_branch = numpy.linalg.norm(numpy.diff(other.positions('branch'), axis=0), axis=1)
    assert abs(lengths_of_branch - 0.05).max() < 1e-6
    assert abs(other.positions('branch') - before).max() > 0.05


def test_a_free_harness_is_put_elsewhere():
    scene = copy.deepcopy(HARNESS)
    scene['cables'][0].pop('attachments')
    scene['cables'][0]['initial'] = {'type': 'straight', 'from': [0, 0, 1], 'to': [1, 0, 1]}
    world = world_of(scene)
    world.step(50)
    places = {name: world.positions(name) + [1, 2, 3] for name in ('trunk', 'branch')}
    world.set_states({name: {'positions': place} for name, place in places.items()})
    for name, place in places.items():
        assert abs(world.positions(name) - place).max() < 1e-8


@pytest.mark.parametrize('distance', [0.49, 0.4998, 0.4999])
def test_a_taut_cable_has_the_positions_that_it_has(distance):
    world = world_of({'materials': {'m': ROPE}, 'cables': [{'name': 'rope', 'length': 0.5, 'segments': 20, 'material': 'm', 'attachments': [
        {'name': 'a', 'at': 'start'}, {'name': 'b', 'at': 'end', 'offset': [distance, 0, 0]}]}]})
    world.step(200)
    before = world.positions('rope')
    world.set_state('rope', positions=before)
    # Strains of 4e-8 are taken from it, and a taut cable sags by the root of a strain.
    assert abs(world.positions('rope') - before).max() < 3e-5


@pytest.mark.parametrize('scene, names', [(ATWOOD, ('rope', 'left')), (HARNESS, ('trunk', 'branch'))])
def test_where_nothing_is_given_nothing_changes(scene, names):
    world = world_of(scene)
    world.step(50)
    before = world.save()
    for name in names:
        world.set_state(name)
    assert world.save() == before


def test_errors_of_several_things_name_the_thing():
    world = world_of(HARNESS)
    short = numpy.zeros((21, 3))
    with pytest.raises(ValueError, match='trunk.positions: a polyline of 0 m'):
        world.set_states({'trunk': {'positions': short}, 'branch': {'velocities': numpy.zeros((11, 3))}})
