"""verlet_cable.sim against cable_sim, and what it refuses."""
import copy
import json
import os
import subprocess
import sys
import threading
from pathlib import Path

import numpy
import pytest
from worlds import interrupted

from verlet_cable.sim import Batch, Scene, SceneError, World

TIMES = numpy.linspace(0, 0.4, 9)
POSES = numpy.zeros((9, 7))
POSES[:, 0] = 0.6 + 0.1 * numpy.sin(9 * TIMES)
POSES[:, 4] = numpy.sin(TIMES)
POSES[:, 6] = numpy.cos(TIMES)


def write_motion(path):
    rows = [','.join([repr(t), 'hand', *map(repr, map(float, pose))]) for t, pose in zip(map(float, TIMES), POSES)]
    path.write_text('t,frame,x,y,z,qx,qy,qz,qw\n' + '\n'.join(rows) + '\n')
    return str(path)


def test_the_ledger_adds_up_and_is_that_of_cable_sim(hang, cable_sim, tmp_path):
    motion = write_motion(tmp_path / 'motion.csv')
    summary, _ = cable_sim(hang, '--duration', '0.4', '--rate', '10', '--motion', motion)
    world = World(Scene.from_dict(hang), motion)
    batch = Batch([Scene.from_dict(hang)] * 2, motion=motion)
    world.step(80)
    batch.step(80)
    ledger = world.ledger()
    assert ledger.pop('unaccounted_steps') == summary['unaccounted_steps'] == 0
    assert ledger == summary['ledger']
    assert batch.ledger(-1) == batch.ledger(0) == {**ledger, 'unaccounted_steps': 0}
    assert list(ledger['work']) == ['attachments', 'winches', 'obstacles', 'applied']
    assert list(ledger['dissipated']) == ['axial', 'bending', 'torsional', 'yielding', 'drag', 'contact', 'guides', 'bodies', 'unresolved', 'edits']
    energy = summary['energy']
    assert ledger['change'] == pytest.approx(energy['total'] - energy['initial_total'], abs=1e-12)
    work, lost = sum(ledger['work'].values()), sum(ledger['dissipated'].values())
    assert work - lost + ledger['unaccounted'] == pytest.approx(ledger['change'], abs=1e-12)
    assert abs(ledger['work']['attachments']) > 1e-3
    # The hand starts at once: doc/how_to/ledger.md
    assert abs(ledger['unaccounted']) < 2e-3 * abs(ledger['work']['attachments'])
    with pytest.raises(IndexError):
        batch.ledger(2)


def test_world_has_the_bytes_of_cable_sim(hang, cable_sim, tmp_path):
    motion = write_motion(tmp_path / 'motion.csv')
    summary, rows = cable_sim(hang, '--duration', '0.5', '--rate', '10', '--motion', motion)
    rows = rows.reshape(6, 21, 9)
    for given in (motion, Path(motion), {'hand': (TIMES, POSES)}):
        world = World(Scene.from_dict(hang), given)
        for k, row in enumerate(rows):
            world.step(20 if k > 0 else 0)
            assert world.time == row[0, 0]
            assert (world.positions('hose') == row[:, 2:5]).all()
            assert (world.velocities('hose') == row[:, 5:8]).all()
            assert (world.tension('hose') == row[:-1, 8]).all()
        assert world.state_hash == summary['state_hash']
        wrench = summary['attachments']['left']
        assert world.wrench('left').tolist() == wrench['force_now'] + wrench['torque_now']
        assert world.energy() == {key: value for key, value in summary['energy'].items() if key != 'initial_total'}


def test_what_is_bent_too_far_stays_bent(hang):
    hang['materials']['wire'].update(bending_stiffness=0.01, yield_curvature=0.5, hardening=0.2)
    world = World(Scene.from_dict(hang))
    world.step(100)
    plastic = world.plastic_curvature('hose')
    assert plastic.max() > 0.05
    copy = World.load(world.scene, world.save())
    assert copy.state_hash == world.state_hash
    assert (copy.plastic_curvature('hose') == plastic).all()
    batch = Batch(Scene.from_dict(hang), 2)
    batch.step(100, record_every=50, fields=['plastic_curvature'])
    assert (batch.plastic_curvature('hose')[0, 1] == plastic).all()
    assert world.ledger()['dissipated']['yielding'] >= 0


def test_shapes_of_what_is_read(hang):
    world = World(Scene.from_dict(hang))
    world.step(3)
    shapes = {'positions': (21, 3), 'velocities': (21, 3), 'tension': (20,), 'curvature': (19,), 'twist': (19,), 'plastic_curvature': (19,),
              'orientations': (20, 4)}
    for name, shape in shapes.items():
        array = getattr(world, name)('hose')
        assert (array.shape, array.dtype, array.flags.c_contiguous) == (shape, numpy.float64, True), name
        assert numpy.isfinite(array).all()
    assert world.wrench('right').shape == (6,)


def test_an_array_stays_as_it_was_read(hang):
    world = World(Scene.from_dict(hang))
    before = world.positions('hose')
    kept = before.copy()
    world.step(20)
    assert (before == kept).all() and (world.positions('hose') != kept).any()


def test_settle_finds_the_equilibrium(hang):
    world = World(Scene.from_dict(hang))
    assert world.settle()
    before = world.positions('hose')
    world.step(100)
    assert abs(world.positions('hose') - before).max() < 1e-6


def test_a_copy_goes_on_with_the_same_bytes(hang):
    world = World(Scene.from_dict(hang), {'hand': (TIMES, POSES)})
    world.step(17)
    for other in (world.copy(), copy.copy(world), copy.deepcopy(world)):
        assert other.state_hash == world.state_hash
        other.step(9)
        again = world.copy()
        again.step(9)
        assert other.state_hash == again.state_hash != world.state_hash


def test_set_frame_is_where_the_frame_is_after_the_next_step(hang):
    world = World(Scene.from_dict(hang))
    place = numpy.array([0.61, 0.005, 0.003])
    world.set_frame('hand', place, [0, 0, 0, 1])
    assert (world.positions('hose')[0] == [0.6, 0, 0]).all()
    world.step()
    assert abs(world.positions('hose')[0] - place).max() < 1e-12
    world.step(50)
    assert abs(world.positions('hose')[0] - place).max() < 1e-12


def test_set_frame_goes_before_the_motion(hang):
    world = World(Scene.from_dict(hang), {'hand': (TIMES, POSES)})
    world.step(10)
    world.set_frame('hand', [0.65, 0, 0], [0, 0, 0, 1])
    world.step(10)
    assert abs(world.positions('hose')[0] - [0.65, 0, 0]).max() < 1e-12


def test_max_frame_speed_holds_frames_back_as_in_cable_sim(hang, cable_sim, tmp_path):
    hang['max_frame_speed'] = 0.3
    motion = write_motion(tmp_path / 'motion.csv')
    summary, _ = cable_sim(hang, '--duration', '0.5', '--motion', motion)
    scene = Scene.from_dict(hang)
    world, batch = World(scene, motion), Batch(scene, 3, motion)
    world.step(100)
    batch.step(100)
    assert [world.state_hash, *batch.state_hash] == [summary['state_hash']] * 4


def test_bodies_and_particles():
    scene = {'frame_id': 'world', 'time_step': 0.002,
             'bodies': [{'name': 'plug', 'mass': 0.1, 'inertia': [1e-4, 2e-4, 2e-4], 'pose': [0, 0, 1, 0.1, 0, 0],
                         'velocity': [1, 0, 0], 'angular_velocity': [1, 2, 3]}],
             'particles': [{'name': 'ball', 'mass': 1.0, 'position': [0, 1, 2], 'velocity': [1, 0, 0]}]}
    scene = Scene.from_dict(scene)
    world = World(scene)
    world.step(50)
    assert scene.body_names == ['plug'] and scene.particle_names == ['ball']
    assert world.positions('ball').shape == (1, 3)
    assert abs(world.positions('ball')[0] - [0.1, 1, 2 - 9.81 * 0.005]).max() < 1e-3
    assert world.body_pose('plug').shape == (7,) and world.body_twist('plug').shape == (6,)
    assert abs(numpy.linalg.norm(world.body_pose('plug')[3:]) - 1) < 1e-12
    assert abs(world.body_twist('plug')[2] + 9.81 * 0.1) < 1e-9


@pytest.mark.parametrize('threads', [0, 1, 2, 5])
def test_batch_has_the_bytes_of_worlds_alone(hang, threads):
    scene = Scene.from_dict(hang)
    count = 37
    poses = numpy.zeros((count, 30, 7))
    poses[..., 6] = 1
    poses[..., 0] = 0.6 + numpy.linspace(0, 0.2, count)[:, None] * numpy.linspace(0, 1, 30)
    batch = Batch(scene, count, threads=threads)
    batch.set_frames('hand', poses)
    batch.step(40, record_every=10, fields=['positions', 'velocities', 'tension', 'curvature', 'twist', 'orientations', 'wrench'])
    for i in (0, 11, count - 1):
        world = World(scene)
        for record in range(4):
            for k in range(10 * record, 10 * record + 10):
                if k < 30:
                    world.set_frame('hand', poses[i, k, :3], poses[i, k, 3:])
                world.step()
            for field in ('positions', 'velocities', 'tension', 'curvature', 'twist', 'orientations'):
                assert (getattr(batch, field)('hose')[i, record] == getattr(world, field)('hose')).all(), field
            assert (batch.wrench('left')[i, record] == world.wrench('left')).all()
        assert batch.state_hash[i] == world.state_hash == batch.world(i).state_hash


def test_batch_of_changed_materials_has_the_bytes_of_changed_scenes(hang, cable_sim):
    hang['cables'][0]['initial'] = {'type': 'settled'}
    stiffness = numpy.linspace(0.001, 0.05, 5)
    density = numpy.linspace(0.05, 0.2, 5)
    batch = Batch(Scene.from_dict(hang), 5)
    batch.set_material('wire', bending_stiffness=stiffness, linear_density=density)
    scenes = []
    for one, other in zip(stiffness, density):
        hang['materials']['wire'].update(bending_stiffness=float(one), linear_density=float(other))
        scenes.append(copy.deepcopy(hang))
    of_scenes = Batch([Scene.from_dict(scene) for scene in scenes])
    batch.step(40)
    of_scenes.step(40)
    assert batch.state_hash == of_scenes.state_hash
    assert batch.state_hash[3] == cable_sim(scenes[3], '--duration', '0.2')[0]['state_hash']


def test_batch_changes_materials_between_steps_but_not_masses(hang):
    batch = Batch(Scene.from_dict(hang), 3)
    batch.step(10)
    before = batch.state_hash
    with pytest.raises(SceneError, match='linear_density'):
        batch.set_material('wire', linear_density=0.2, bending_stiffness=1.0)
    assert batch.state_hash == before
    batch.set_material('wire', bending_stiffness=[0.002, 0.002, 1.0])
    batch.step(10)
    assert batch.state_hash[0] == batch.state_hash[1] != batch.state_hash[2]


def test_records_are_views_that_outlive_the_batch(hang):
    batch = Batch(Scene.from_dict(hang), 4)
    batch.step(6, record_every=2)
    positions = batch.positions('hose')
    assert positions.shape == (4, 3, 21, 3) and not positions.flags.writeable
    kept = positions.copy()
    with pytest.raises(ValueError):
        positions[0] = 0
    batch.step(6, record_every=2)
    del batch
    assert (positions == kept).all()


def test_after_a_step_without_records_arrays_are_of_now(hang):
    batch = Batch(Scene.from_dict(hang), 4)
    batch.step(6, record_every=3)
    last = batch.positions('hose')[:, -1]
    batch.step(0)
    assert (batch.positions('hose') == last).all()
    assert batch.status.tolist() == [0] * 4 and batch.time == pytest.approx(0.03)
    assert batch.energy()['total'].shape == (4,)


def test_scenes_of_a_batch_are_alike(hang):
    other = copy.deepcopy(hang)
    other['cables'][0]['length'] = 1.1
    batch = Batch([Scene.from_dict(hang), Scene.from_dict(other)])
    batch.step(5)
    assert len(batch) == 2 and (batch.positions('hose')[0] != batch.positions('hose')[1]).any()
    other['cables'][0]['segments'] = 21
    with pytest.raises(SceneError, match=r'scenes\[1\].cables: hose of 21 segments'):
        Batch([Scene.from_dict(hang), Scene.from_dict(other)])


def test_a_broken_cable_has_no_array_of_the_batch(hang):
    hang['materials']['wire']['breaking_tension'] = 2.0
    batch = Batch(Scene.from_dict(hang), 2)
    poses = numpy.zeros((2, 100, 7))
    poses[..., 6] = 1
    poses[..., 0] = 0.6
    poses[1, :, 0] = numpy.linspace(0.6, 1.02, 100)
    batch.set_frames('hand', poses)
    batch.step(100, record_every=50)
    with pytest.raises(ValueError, match='world 1 has none'):
        batch.positions('hose')
    assert batch.world(0).positions('hose').shape == (21, 3)


@pytest.mark.parametrize('wrong, kind, text', [
    (lambda s: World(s).positions('nope'), KeyError, 'nope.*hose'),
    (lambda s: World(s).wrench('nope'), KeyError, 'nope.*left, right'),
    (lambda s: World(s).body_pose('nope'), KeyError, 'nope.*none'),
    (lambda s: World(s).set_frame('nope', [0, 0, 0], [0, 0, 0, 1]), KeyError, 'nope.*hand'),
    (lambda s: World(s).set_frame('world', [0, 0, 0], [0, 0, 0, 1]), KeyError, 'world.*hand'),
    (lambda s: World(s).set_frame('hand', [0, float('nan'), 0], [0, 0, 0, 1]), ValueError, 'position.*nan'),
    (lambda s: World(s).set_frame('hand', [0, 1e10, 0], [0, 0, 0, 1]), ValueError, 'position'),
    (lambda s: World(s).set_frame('hand', [0, 0], [0, 0, 0, 1]), ValueError, r'position: shape \(2,\)'),
    (lambda s: World(s).set_frame('hand', [0, 0, 0], [0, 0, 0, 0]), ValueError, 'quaternion_xyzw'),
    (lambda s: World(s).step(-1), ValueError, 'steps: -1'),
    (lambda s: World(s, {'hend': ([0], [[0, 0, 0, 0, 0, 0, 1]])}), KeyError, 'hend.*hand'),
    (lambda s: World(s, {'hand': ([0, 0], numpy.ones((2, 7)))}), ValueError, r'motion\["hand"\]\[0\]\[1\].*ascend'),
    (lambda s: World(s, {'hand': ([0], numpy.ones((2, 7)))}), ValueError, r'poses: shape \(2, 7\); allowed: \(1, 7\)'),
    (lambda s: World(s, {'hand': ([0], [[0, 0, 0, 0, 0, 0, numpy.nan]])}), ValueError, 'nan'),
    (lambda s: World(s, {'hand': ([0], [[9, 0, 0, 0, 0, 0, 1]])}), SceneError, 'motion at t = 0'),
    (lambda s: World(s, {'hand': 3}), ValueError, 'motion'),
    (lambda s: World(s, '/nowhere.csv'), SceneError, 'No such file'),
    (lambda s: Batch(s, 0), ValueError, 'count: 0'),
    (lambda s: Batch(s, 2, threads=-1), ValueError, 'threads: -1'),
    (lambda s: Batch([]), ValueError, 'scenes'),
    (lambda s: Batch(s, 2).set_frames('hand', numpy.ones((3, 7))), ValueError, r'\(3, 7\); allowed: \(2, 7\)'),
    (lambda s: Batch(s, 2).set_frames('hand', numpy.ones((2, 0, 7))), ValueError, 'poses'),
    (lambda s: Batch(s, 2).set_frames('hand', numpy.full((2, 3, 7), numpy.nan)), ValueError, r'poses\[0, 0\]'),
    (lambda s: Batch(s, 2).set_material('nope', radius=1), KeyError, 'nope.*wire'),
    (lambda s: Batch(s, 2).set_material('wire', stiffness=1), KeyError, 'stiffness.*bending_stiffness'),
    (lambda s: Batch(s, 2).set_material('wire', radius=numpy.ones(3)), ValueError, r'radius: shape \(3,\)'),
    (lambda s: Batch(s, 2).set_material('wire', radius=[1, numpy.nan]), SceneError, r'materials.wire.radius\[1\]: nan'),
    (lambda s: Batch(s, 2).step(5, record_every=2), ValueError, 'record_every: 2'),
    (lambda s: Batch(s, 2).step(5, record_every=5, fields=['place']), ValueError, 'place.*positions'),
    (lambda s: Batch(s, 2).step(10 ** 15, record_every=1), MemoryError, 'record_every: '),
    (lambda s: Batch(s, 2).world(2), IndexError, 'index: 2'),
])
def test_what_is_refused(hang, wrong, kind, text):
    with pytest.raises(kind, match=text):
        wrong(Scene.from_dict(hang))


def test_a_refused_call_changes_nothing(hang):
    batch = Batch(Scene.from_dict(hang), 2)
    before = batch.state_hash
    poses = numpy.zeros((2, 7))
    poses[:, 6] = 1
    poses[1, 0] = numpy.inf
    for wrong in (lambda: batch.set_frames('hand', poses), lambda: batch.set_material('wire', radius=0.1, bending_stiffness=[1, -1])):
        with pytest.raises(ValueError):
            wrong()
    assert batch.state_hash == before
    batch.step(5)
    other = Batch(Scene.from_dict(hang), 2)
    other.step(5)
    assert batch.state_hash == other.state_hash


def test_scene_error_lists_every_error(hang, tmp_path):
    hang['cabels'] = []
    hang['cables'][0]['length'] = -1
    hang['materials']['wire']['radius'] = 'thick'
    (tmp_path / 'scene.yaml').write_text(json.dumps(hang))
    for make in (lambda: Scene.from_dict(hang), lambda: Scene.from_yaml(json.dumps(hang)), lambda: Scene.load(tmp_path / 'scene.yaml')):
        with pytest.raises(SceneError) as caught:
            make()
        errors = caught.value.errors
        assert len(errors) >= 3 and str(caught.value).splitlines() == errors
        assert all(any(key in line for line in errors) for key in ('cabels', 'cables[0].length', 'materials.wire.radius'))
    assert issubclass(SceneError, ValueError)


def test_dicts_may_hold_numpy(hang):
    hang['cables'][0]['length'] = numpy.float64(1.0)
    hang['cables'][0]['segments'] = numpy.int64(20)
    hang['cables'][0]['attachments'][0]['initial_pose'] = numpy.array([0.6, 0, 0, 0, 0, 0])
    hang['materials']['wire']['axial_stiffness'] = float('inf')
    hang['numerical_damping'] = True
    world = World(Scene.from_dict(hang))
    world.step(5)
    for wrong in (object(), {1: 2}, {'cables': {3}}):
        with pytest.raises((TypeError, SceneError)):
            Scene.from_dict(wrong)
    deep = []
    deep.append(deep)
    with pytest.raises(ValueError, match='32 levels'):
        Scene.from_dict({'cables': deep})


def test_other_threads_run_while_a_world_steps(hang):
    world = World(Scene.from_dict(hang))
    thread = threading.Thread(target=world.step, args=(30000,))
    thread.start()
    turns, refused = 0, 0
    while thread.is_alive():
        turns += 1
        try:
            world.positions('hose')
        except RuntimeError as error:
            assert 'in use by another thread' in str(error)
            refused += 1
    thread.join()
    assert turns > 100 and refused > 0
    assert world.time == pytest.approx(150)


def test_ctrl_c_ends_a_long_step(hang):
    program = '''
import json, sys, numpy
from verlet_cable.sim import Batch, Scene, World
scene = Scene.from_dict(json.loads(sys.argv[1]))
one = World(scene) if sys.argv[2] == 'world' else Batch(scene, 20)
print('begins', flush=True)
try:
    one.step(10 ** 12)
except KeyboardInterrupt:
    before = numpy.max(one.time)
    one.step(3)
    print('ended', numpy.min(one.time) > before > 0, flush=True)
'''
    for what in ('world', 'batch'):
        assert interrupted(program, hang, what) == 'ended True\n'


def test_importing_needs_no_ros():
    program = ("import sys, verlet_cable.sim; "
               "print([name for name in sys.modules if name.split('.')[0] in ('rospy', 'roslib', 'genpy', 'tf2_ros')])")
    environment = dict(os.environ, ROS_MASTER_URI='http://localhost:1')
    assert subprocess.run([sys.executable, '-c', program], stdout=subprocess.PIPE, text=True, env=environment, check=True).stdout == '[]\n'


def test_docstrings_and_signatures_are_there():
    for cls in (Scene, World, Batch):
        for name in dir(cls):
            if not name.startswith('_'):
                assert (getattr(cls, name).__doc__ or '').strip(), f'{cls.__name__}.{name}'
