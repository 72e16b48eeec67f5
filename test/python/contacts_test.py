"""What touches what, and with which force."""
import numpy
import pytest
from worlds import IDENTITY, world_of

from verlet_cable.sim import Batch, Scene, World

WEIGHT = 9.81 * 0.05 * 0.5
RADIUS = 0.004


def lying(**material):
    """A rope of 0.5 m and 25 g on a table."""
    return {
        'time_step': 0.002,
        'materials': {'m': {'linear_density': 0.05, 'radius': RADIUS, 'bending_stiffness': 0.002, **material}},
        'obstacles': [{'name': 'table', 'type': 'plane', 'frame': 'floor', 'initial_pose': [0, 0.1, 0, 0, 0, 0]}],
        'cables': [{'name': 'c', 'length': 0.5, 'segments': 20, 'material': 'm',
                    'initial': {'type': 'straight', 'from': [0, 0, RADIUS], 'to': [0.5, 0, RADIUS]}}],
    }


def test_a_table_bears_what_lies_on_it():
    world = world_of(lying())
    world.step(3000)
    contacts = world.contacts()
    assert contacts.dtype.names == ('cable', 'segment', 'position', 'normal', 'force', 'other')
    assert len(contacts) == 21 and set(contacts['cable']) == {'c'} and set(contacts['other']) == {'table'}
    assert numpy.array_equal(contacts['normal'], [[0, 0, 1]] * 21)
    assert contacts['segment'].tolist() == [*range(20), 19]
    assert numpy.array_equal(contacts['position'], world.positions('c'))
    wrench = world.contact_force('table')
    assert wrench[2] == pytest.approx(-WEIGHT, abs=1e-9)
    assert wrench[:3] == pytest.approx(-contacts['force'].sum(axis=0), abs=1e-12)
    # About the frame, which is 0.1 m beside the rope: its middle is at 0.25 m.
    assert wrench[3:] == pytest.approx([0.1 * WEIGHT, 0.25 * WEIGHT, 0], abs=1e-7)
    with pytest.raises(ValueError):
        contacts['force'] = 0
    with pytest.raises(ValueError):
        wrench[0] = 0


def test_wrenches_and_contacts_bear_the_weight():
    scene = lying()
    scene['cables'][0]['initial'] = {'type': 'settled'}
    scene['cables'][0]['attachments'] = [{'name': 'hand', 'at': 'start', 'offset': [0, 0, 0.1]}]
    scene['numerical_damping'] = True
    scene['materials']['m']['drag'] = 0.1
    world = world_of(scene)
    world.step(5000)
    forces = world.wrench('hand')[:3] + world.contact_force('table')[:3]
    assert forces == pytest.approx([0, 0, -WEIGHT], abs=1e-6)
    assert 0.1 * WEIGHT < -world.contact_force('table')[2] < 0.9 * WEIGHT


def test_bodies_feel_ropes_and_tables():
    scene = lying()
    scene['bodies'] = [{'name': 'brick', 'mass': 0.2, 'pose': [0.25, 0, 0.02 + 2 * RADIUS, 0, 0, 0],
                        'shapes': [{'type': 'box', 'size': [0.2, 0.1, 0.04]}]},
                       {'name': 'other', 'mass': 0.3, 'pose': [2, 0, 0.02, 0, 0, 0],
                        'shapes': [{'type': 'box', 'size': [0.1, 0.1, 0.04]}]}]
    world = world_of(scene)
    world.step(500)
    assert world.contact_force('other')[2] == pytest.approx(0.3 * 9.81, rel=1e-4)
    assert world.contact_force('brick')[2] == pytest.approx(0.2 * 9.81, rel=1e-2)
    assert -world.contact_force('table')[2] == pytest.approx(0.5 * 9.81 + WEIGHT, rel=1e-2)
    contacts = world.contacts()
    of_brick = contacts[contacts['other'] == 'brick']
    assert of_brick['force'].sum(axis=0)[2] < 0 and (of_brick['normal'][:, 2] < -0.9).all()


def test_cables_feel_each_other_alike():
    scene = lying()
    scene['contact'] = {'friction': 0.3}
    scene['cables'].append({'name': 'd', 'length': 0.2, 'segments': 8, 'material': 'm', 'initial': {
        'type': 'straight', 'from': [0.26, -0.1, 3 * RADIUS], 'to': [0.26, 0.1, 3 * RADIUS]}})
    world = world_of(scene)
    world.step(400)
    contacts = world.contacts()
    pairs = contacts[contacts['other'] != 'table']
    assert len(pairs) > 0
    above, below = pairs[pairs['cable'] == 'd'], pairs[pairs['cable'] == 'c']
    assert (above['other'] == 'c').all() and (below['other'] == 'd').all()
    assert above['force'].sum(axis=0) == pytest.approx(-below['force'].sum(axis=0), abs=1e-12)


def test_batches_have_what_their_worlds_have():
    scene = Scene.from_dict(lying())
    batch = Batch(scene, 2)
    batch.step(10, record_every=5, fields=['contact_force'])
    assert batch.contact_force('table').shape == (2, 2, 6)
    world = World(scene)
    world.step(10)
    assert numpy.array_equal(batch.contact_force('table')[1, -1], world.contact_force('table'))
    assert numpy.array_equal(batch.contacts(1), world.contacts())
    batch.step()
    assert batch.contact_force('table').shape == (2, 6)
    with pytest.raises(KeyError, match='name: "tabel"; allowed: table'):
        world.contact_force('tabel')
    with pytest.raises(IndexError):
        batch.contacts(2)


def jaws(segments, step, compression, middle, stiffness=1e5, width=0.02, friction=0.6):
    """Two jaws take a rope on a table at x = 0, where its `middle` [m] is beside it, and lift it: by 0.2 m in 2 s."""
    scene = lying(transverse_stiffness=stiffness, friction=friction)
    del scene['obstacles'][0]['frame'], scene['obstacles'][0]['initial_pose']
    scene['time_step'] = step
    start = middle - 0.25
    scene['cables'][0].update(segments=segments)
    scene['cables'][0]['initial'].update({'from': [start, 0, RADIUS], 'to': [start + 0.5, 0, RADIUS]})
    for name, side in ('left', 1), ('right', -1):
        scene['obstacles'].append({'name': name, 'type': 'box', 'size': [width, 0.01, 0.03], 'frame': name,
                                   'initial_pose': [0, 0.015 * side, 0.0155, 0, 0, 0]})
    world = world_of(scene)
    closed, lifted, steps = 0.005 + RADIUS - compression / 2, 0.2, round(0.5 / step)

    def move(count, place):
        for k in range(count):
            y, z = place((k + 1) / count)
            for name, side in ('left', 1), ('right', -1):
                world.set_frame(name, [0, side * y, z], IDENTITY)
            world.step()

    move(steps, lambda s: (0.015 + (closed - 0.015) * s, 0.0155))
    move(steps, lambda s: (closed, 0.0155))
    squeeze = [abs(world.contact_force(name)[1]) for name in ('left', 'right')]
    move(4 * steps, lambda s: (closed, 0.0155 + lifted * s * s * (3 - 2 * s)))
    move(2 * steps, lambda s: (closed, 0.0155 + lifted))
    height = world.positions('c')[numpy.abs(world.positions('c')[:, 0]).argsort()[:2], 2].mean()
    return world, squeeze, height


@pytest.mark.parametrize('segments, step, middle', [
    (10, 0.001, 0.025), (10, 0.01, 0.005), (20, 0.002, 0.012), (20, 0.005, 0), (20, 0.01, 0.02), (50, 0.002, 0.003),
    (100, 0.005, 0.0025), (120, 0.01, 0.001)])
def test_jaws_squeeze_with_the_stiffness_times_what_they_compress(segments, step, middle):
    compression = 0.001
    world, squeeze, height = jaws(segments, step, compression, middle)
    assert squeeze == pytest.approx([1e5 * compression * 0.02] * 2, rel=0.03)
    assert height > 0.18
    ledger = world.ledger()
    assert all(value >= -1e-9 for value in ledger['dissipated'].values()), ledger


@pytest.mark.parametrize('segments, step', [(10, 0.005), (11, 0.002), (20, 0.01), (21, 0.001), (50, 0.005), (101, 0.01)])
def test_a_grip_holds_what_friction_bears(segments, step):
    # By its middle, a node or the middle of a segment; faster than at rest by 0.3 m/s^2, 3 %.
    just = WEIGHT / 2 / (1e5 * 0.001 * 0.02)
    assert jaws(segments, step, 0.001, 0, friction=1.1 * just)[2] > 0.18
    assert jaws(segments, step, 0.001, 0, friction=0.9 * just)[2] < 0.1


def test_a_limit_names_what_squeezes():
    world = jaws(20, 0.005, 0.001, 0, stiffness=1e5)[0]
    assert not [event for event in world.events() if event.type == 'LIMIT']
    scene = lying(maximum_squeeze=0.4)
    world = world_of(scene)
    world.step(200)
    told = [event for event in world.events() if event.type == 'LIMIT']
    assert told and {event.other for event in told} == {'table'} and 'above maximum_squeeze, 0.4 N/m' in told[0].message
