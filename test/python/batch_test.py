"""Batches whose worlds are set, and what they observe."""
import copy
import json
import subprocess
import sys
import time

import numpy
import pytest
from worlds import interrupted

from verlet_cable.sim import Batch, Scene, SceneError, World

TIMES = numpy.linspace(0, 0.4, 9)
POSES = numpy.zeros((9, 7))
POSES[:, 0] = 0.6 + 0.1 * numpy.sin(9 * TIMES)
POSES[:, 6] = 1
MOTION = {'hand': (TIMES, POSES)}


def held_at(*x):
    """Poses (count, 7) of the hand at these x."""
    poses = numpy.zeros((len(x), 7))
    poses[:, 0] = x
    poses[:, 6] = 1
    return poses


@pytest.fixture
def scene(hang):
    return Scene.from_dict(hang)


@pytest.fixture
def moved(scene):
    """A world under way: of 13 steps along a motion."""
    world = World(scene, MOTION)
    world.step(13)
    return world


def hash_after(world, steps):
    world = world.copy()
    world.step(steps)
    return world.state_hash


def test_a_batch_of_a_world_goes_on_as_the_world_does(moved):
    before = moved.state_hash
    batch = Batch(moved, 5, threads=2)
    assert len(batch) == 5 and batch.state_hash == [before] * 5
    assert batch.time.shape == (5,) and (batch.time == moved.time).all()
    batch.step(20)
    assert batch.state_hash == [hash_after(moved, 20)] * 5
    assert moved.state_hash == before


def test_a_batch_of_a_world_has_its_given_poses(scene):
    world = World(scene, MOTION)
    world.set_frame('hand', [0.62, 0, 0], [0, 0, 0, 1])
    batch = Batch(world, 2)
    batch.step(9)
    assert batch.state_hash == [hash_after(world, 9)] * 2


@pytest.mark.parametrize('index, places', [
    (2, [2]), (-1, [6]), (numpy.int8(-7), [0]), ([1, 3, 1, -4], [1, 3]), (range(2), [0, 1]),
    (numpy.arange(7)[::-3], [0, 3, 6]), (numpy.array([[5, 0], [4, 1]])[:, 0], [4, 5]), (numpy.broadcast_to(numpy.int64(2), 3), [2]),
    (numpy.array([5], numpy.uint64), [5]), (numpy.arange(7) % 2 == 0, [0, 2, 4, 6]),
    ([True] + [False] * 6, [0]), ([], []), (numpy.zeros(7, bool), []), (slice(1, 3), None),
])
def test_set_world_sets_the_worlds_of_an_index(scene, moved, index, places):
    batch = Batch(scene, 7)
    batch.step(2)
    before = batch.state_hash
    if places is None:
        with pytest.raises(ValueError, match='index.*allowed'):
            batch.set_world(index, moved)
        return
    batch.set_world(index, moved)
    expected = [moved.state_hash if i in places else before[i] for i in range(7)]
    assert batch.state_hash == expected
    assert batch.time.tolist() == [moved.time if i in places else 2 * scene.time_step for i in range(7)]


def test_worlds_that_were_set_follow_their_own_motions_from_their_own_times(scene, moved):
    batch = Batch(scene, 3, {'hand': (TIMES, POSES[::-1] * [1, 1, 1, 1, 1, 1, 1])})
    batch.step(8)
    other = batch.world(0)
    batch.set_world(1, moved)
    batch.step(6)
    assert batch.state_hash == [hash_after(other, 6), hash_after(moved, 6), hash_after(other, 6)]


def test_a_world_that_was_set_has_no_poses_that_were_given_before(scene, moved):
    batch = Batch(scene, 2)
    batch.set_frames('hand', held_at(0.65, 0.65))
    batch.set_world(0, moved)
    batch.step(7)
    assert batch.state_hash[0] == hash_after(moved, 7)
    assert abs(batch.positions('hose')[1, 0, 0] - 0.65) < 1e-12
    batch.set_frames('hand', held_at(0.61, 0.66))
    batch.step(7)
    assert abs(batch.positions('hose')[:, 0, 0] - [0.61, 0.66]).max() < 1e-12


def test_what_was_recorded_and_the_status_are_of_worlds_before(scene, moved):
    batch = Batch(scene, 2)
    batch.set_frames('hand', held_at(0.6, 1.2))
    batch.step(4, record_every=2)
    assert batch.positions('hose').shape == (2, 2, 21, 3) and batch.status[0] == 0 != batch.status[1]
    batch.set_world(1, moved)
    assert (batch.positions('hose')[1] == moved.positions('hose')).all()
    assert batch.status.tolist() == [0, 0]


@pytest.mark.parametrize('threads', [0, 1, 2, 5])
def test_same_bytes_at_any_number_of_threads(hang, threads):
    """Frames, materials, settling, worlds set in between, and a copy: against worlds alone."""
    scene = Scene.from_dict(hang)
    count = 41
    start = World(scene, MOTION)
    start.step(5)
    places = numpy.linspace(0.58, 0.63, count)
    stiffness = numpy.linspace(0.001, 0.02, count)
    mask = numpy.arange(count) % 3 == 1
    batch = Batch(scene, count, MOTION, threads=threads)
    batch.set_material('wire', bending_stiffness=stiffness)
    batch.step(10)
    batch.set_world(mask, start)
    again = batch.copy()
    for one in (batch, again):
        one.step(7)
        one.set_frames('hand', held_at(*places))
        one.step(9, record_every=3, fields=['positions', 'wrench'])
    assert batch.state_hash == again.state_hash
    assert (batch.wrench('left') == again.wrench('left')).all()
    for i in (0, 1, 2, 22, count - 2, count - 1):
        if mask[i]:
            world = start.copy()
        else:
            hang['materials']['wire']['bending_stiffness'] = float(stiffness[i])
            world = World(Scene.from_dict(hang), MOTION)
            world.step(10)
        world.step(7)
        world.set_frame('hand', [places[i], 0, 0], [0, 0, 0, 1])
        world.step(9)
        assert batch.state_hash[i] == world.state_hash
        assert (batch.positions('hose')[i, -1] == world.positions('hose')).all()


def test_a_copy_of_a_batch_knows_nothing_of_the_other(scene, moved):
    batch = Batch(scene, 3)
    batch.step(4)
    other = batch.copy()
    before = other.state_hash
    for one in (copy.copy(batch), copy.deepcopy(batch)):
        one.step(1)
        assert one.state_hash != before == batch.state_hash
    batch.set_world([0, 2], moved)
    batch.set_frames('hand', held_at(0.61, 0.62, 0.63))
    batch.step(5)
    assert other.state_hash == before
    other.step(5)
    alone = World(scene)
    alone.step(9)
    assert other.state_hash == [alone.state_hash] * 3


def test_set_material_is_of_each_world_whether_it_was_stepped(hang, moved):
    """Those as they began begin anew, settled with their stiffness; others are tuned where they are."""
    hang['cables'][0]['initial'] = {'type': 'settled'}
    scene = Scene.from_dict(hang)
    start = World(scene)
    moved = World(scene, MOTION)
    moved.step(13)
    batch = Batch(scene, 3)
    batch.step(4)
    batch.set_world(0, start)
    batch.set_world(2, moved)
    stepped = batch.world(1).positions('hose')
    batch.set_material('wire', bending_stiffness=0.05)
    hang['materials']['wire']['bending_stiffness'] = 0.05
    assert batch.state_hash[0] == World(Scene.from_dict(hang)).state_hash
    assert (batch.positions('hose')[1:] == [stepped, moved.positions('hose')]).all()
    assert batch.time.tolist() == [0, 4 * scene.time_step, 13 * scene.time_step]


def test_masses_are_given_before_the_first_step_of_every_world(hang, scene, moved):
    batch = Batch(scene, 3)
    batch.set_world(1, moved)
    before = batch.state_hash
    with pytest.raises(SceneError, match='linear_density: given when world 1 was stepped'):
        batch.set_material('wire', linear_density=0.2)
    assert batch.state_hash == before
    batch.set_world(1, World(scene))
    batch.set_material('wire', linear_density=0.2)
    hang['materials']['wire']['linear_density'] = 0.2
    assert batch.state_hash == [World(Scene.from_dict(hang)).state_hash] * 3
    batch.step(3)
    batch.set_world(range(3), World(scene))
    batch.set_material('wire', linear_density=0.2)
    assert batch.state_hash == [World(Scene.from_dict(hang)).state_hash] * 3


def test_what_is_no_number_is_named(scene):
    with pytest.raises(ValueError, match="drag: 'a'; allowed: numbers"):
        Batch(scene, 2).set_material('wire', drag='a')


def test_a_material_does_not_undo_settling(scene):
    batch = Batch(scene, 2)
    assert batch.settle().all()
    settled = batch.positions('hose')
    batch.set_material('wire', bending_stiffness=0.01)
    assert (batch.positions('hose') == settled).all()
    with pytest.raises(SceneError, match='world 0 was stepped, settled or edited'):
        batch.set_material('wire', linear_density=0.2)


def test_a_material_keeps_the_motion_of_a_world_that_was_set(hang, scene):
    batch = Batch(scene, 2)
    batch.set_world(1, World(scene, MOTION))
    batch.set_material('wire', linear_density=0.2)
    batch.step(20)
    hang['materials']['wire']['linear_density'] = 0.2
    assert batch.state_hash[1] == hash_after(World(Scene.from_dict(hang), MOTION), 20)


def test_a_material_keeps_the_poses_that_were_given(scene):
    batch = Batch(scene, 2)
    batch.set_frames('hand', held_at(0.61, 0.62))
    batch.set_material('wire', linear_density=0.2)
    batch.step()
    assert abs(batch.positions('hose')[:, 0, 0] - [0.61, 0.62]).max() < 1e-12


def test_observations_are_the_arrays_side_by_side(scene, moved):
    batch = Batch(scene, 37, threads=2)
    batch.set_world([3, 4], moved)
    batch.set_frames('hand', held_at(*numpy.linspace(0.58, 0.63, 37)))
    batch.step(4, record_every=2)
    parts = [('positions', 'hose'), ('wrench', 'left'), ('tension', 'hose'), ('curvature', 'hose'), ('twist', 'hose'),
             ('orientations', 'hose'), ('velocities', 'hose'), ('wrench', 'right')]
    observations = batch.observations(parts)
    batch.step(0)
    arrays = [getattr(batch, quantity)(name).reshape(37, -1) for quantity, name in parts]
    assert (observations == numpy.hstack(arrays)).all() and numpy.isfinite(observations).all()
    assert observations.dtype == numpy.float64 and observations.flags.c_contiguous and observations.flags.owndata
    kept = observations.copy()
    batch.step(2)
    assert (observations == kept).all() and (batch.observations(parts) != kept).any()
    assert batch.observations([]).shape == (37, 0)
    assert (batch.observations((('wrench', 'left'),)) == batch.wrench('left')).all()


def test_points_are_read_of_cables_at_even_distances(scene, moved):
    batch = Batch(scene, 20)
    batch.set_world(7, moved)
    nodes, velocities = batch.positions('hose'), batch.velocities('hose')
    for points, every in ((21, 1), (11, 2), (6, 4), (2, 20)):
        observed = batch.observations([('wrench', 'left'), ('positions', 'hose', points), ('velocities', 'hose', points)])
        assert observed.shape == (20, 6 + 6 * points)
        positions = observed[:, 6:6 + 3 * points].reshape(20, points, 3)
        assert abs(positions - nodes[:, ::every]).max() < 1e-12
        assert abs(observed[:, 6 + 3 * points:].reshape(20, points, 3) - velocities[:, ::every]).max() < 1e-10
    between = batch.observations([('positions', 'hose', 41)]).reshape(20, 41, 3)[:, 1::2]
    assert abs(between - (nodes[:, 1:] + nodes[:, :-1]) / 2).max() < 1e-12


def test_points_are_read_whatever_guides_do_to_nodes(hang):
    """The hand draws the cable over a wheel in one of two worlds."""
    hang['cables'][0]['attachments'].pop()
    hang['materials']['wire']['bending_stiffness'] = 0
    hang['cables'][0]['initial'] = {'type': 'straight', 'from': [0.6, 0, 0], 'to': [-0.4, 0, 0]}
    hang['guides'] = [{'name': 'wheel', 'cable': 'hose', 'at': 0.3, 'type': 'sheave', 'radius': 0.05, 'offset': [0.3, 0, -0.05],
                       'rotation': [numpy.pi / 2, 0, 0]}]
    batch = Batch(Scene.from_dict(hang), 2)
    poses = numpy.tile(held_at(0.6)[:, None], (2, 100, 1))
    poses[1, :, 0] += numpy.linspace(0, 0.21, 100)
    batch.set_frames('hand', poses)
    batch.step(100)
    nodes = [batch.world(i).positions('hose') for i in (0, 1)]
    assert len(nodes[0]) != len(nodes[1])
    with pytest.raises(ValueError, match=r'positions of hose: world 1 has none of shape \(\d+, 3\) as world 0.*guides'):
        batch.positions('hose')
    points = batch.observations([('positions', 'hose', 9)]).reshape(2, 9, 3)
    for i in (0, 1):
        assert abs(points[i][[0, -1]] - nodes[i][[0, -1]]).max() < 1e-12
        assert numpy.linalg.norm(numpy.diff(points[i], axis=0), axis=1).max() < 1.01 / 8


def test_a_scene_of_another_kind_is_refused(hang, scene):
    batch = Batch(scene, 2)
    before = batch.state_hash

    def changed(**keys):
        other = copy.deepcopy(hang)
        other.update(keys)
        return other

    def cable(**keys):
        other = copy.deepcopy(hang)
        other['cables'][0].update(keys)
        return other

    for other, text in ((cable(segments=21), r'world.cables: hose of 21 segments of wire; allowed: .*hose of 20'),
                        (cable(name='pipe'), 'world.cables: pipe'),
                        (changed(time_step=0.002), 'world.time_step: 0.002 s'),
                        (cable(name='pipe', segments=7), 'world.cables: pipe of 7 segments')):
        with pytest.raises(ValueError, match=text):
            batch.set_world([0, 1], World(Scene.from_dict(other)))
        assert batch.state_hash == before
    batch.set_world(1, World(Scene.from_dict(cable(length=1.1))))
    assert batch.state_hash[1] != before[1]


@pytest.mark.parametrize('wrong, kind, text', [
    (lambda b, w: Batch(w, 0), ValueError, 'count: 0'),
    (lambda b, w: Batch(w, 2 ** 62), ValueError, 'count: 4611686018427387904; allowed: 1 to 1000000'),
    (lambda b, w: b.set_world([[1], [1, 2]], w), ValueError, r'index: \[\[1\], \[1, 2\]\]; allowed'),
    (lambda b, w: Batch(w, 2, threads=-1), ValueError, 'threads: -1'),
    (lambda b, w: b.set_world(3, w), IndexError, 'index: 3; allowed: -3 to 2'),
    (lambda b, w: b.set_world([0, -4], w), IndexError, 'index: -4'),
    (lambda b, w: b.set_world(numpy.array([2 ** 64 - 1], numpy.uint64), w), IndexError, 'index: 18446744073709551615; allowed'),
    (lambda b, w: b.set_world(2 ** 70, w), ValueError, 'index'),
    (lambda b, w: b.set_world(0.0, w), ValueError, r'index: shape \(\) of float64'),
    (lambda b, w: b.set_world([0.0], w), ValueError, 'float64'),
    (lambda b, w: b.set_world(True, w), ValueError, r'of bool; allowed: .*mask \(3,\)'),
    (lambda b, w: b.set_world([True, False], w), ValueError, r'shape \(2,\) of bool'),
    (lambda b, w: b.set_world(numpy.ones((3, 1), bool), w), ValueError, r'shape \(3, 1\) of bool'),
    (lambda b, w: b.set_world([[0, 1]], w), ValueError, r'shape \(1, 2\)'),
    (lambda b, w: b.set_world('0', w), ValueError, 'index'),
    (lambda b, w: b.set_world(None, w), ValueError, 'index'),
    (lambda b, w: b.set_world(0, None), TypeError, ''),
    (lambda b, w: b.set_world(0, b), TypeError, ''),
    (lambda b, w: b.observations([('places', 'hose')]), ValueError, 'parts: "places"; allowed: positions'),
    (lambda b, w: b.observations([('positions', 'nope')]), KeyError, 'nope.*hose'),
    (lambda b, w: b.observations([('wrench', 'hose')]), KeyError, 'hose.*left, right'),
    (lambda b, w: b.observations(['positions']), TypeError, ''),
    (lambda b, w: b.observations([('positions', 'hose', 1)]), ValueError, 'parts: 1 points of hose; allowed: 2 to'),
    (lambda b, w: b.observations([('positions', 'hose', 10 ** 9)]), ValueError, 'points of hose'),
    (lambda b, w: b.observations([('positions', 'hose', 2.5)]), TypeError, ''),
    (lambda b, w: b.observations([('tension', 'hose', 5)]), ValueError, 'parts: points of tension of hose'),
    (lambda b, w: b.observations([('positions', 'nope', 5)]), KeyError, 'nope.*hose'),
    (lambda b, w: b.observations('positions'), TypeError, ''),
])
def test_what_is_refused_changes_nothing(scene, moved, wrong, kind, text):
    batch = Batch(scene, 3)
    batch.step(2)
    before, time_before = batch.state_hash, batch.time.tolist()
    with pytest.raises(kind, match=text):
        wrong(batch, moved)
    assert batch.state_hash == before and batch.time.tolist() == time_before


def test_a_broken_cable_is_named_and_can_be_set_back(hang):
    hang['materials']['wire']['breaking_tension'] = 2.0
    scene = Scene.from_dict(hang)
    batch = Batch(scene, 3)
    poses = numpy.tile(held_at(0.6)[:, None], (3, 100, 1))
    poses[0, :, 0] = numpy.linspace(0.6, 1.02, 100)
    batch.set_frames('hand', poses)
    batch.step(100, record_every=50)
    for read in (lambda: batch.positions('hose'), lambda: batch.observations([('wrench', 'left'), ('tension', 'hose')])):
        with pytest.raises(ValueError, match=r'of hose: world \d has none.*worlds\[\d\] has its own'):
            read()
    assert batch.observations([('positions', 'hose', 5)]).shape == (3, 15)
    batch.step(10, record_every=5)  # of worlds that do not have the names of world 0's pieces
    batch.set_world(0, World(scene))
    assert batch.positions('hose').shape == (3, 21, 3)
    batch.step(10, record_every=5)
    assert batch.positions('hose').shape == (3, 2, 21, 3)


def test_no_steps_have_no_records(scene):
    batch = Batch(scene, 2)
    batch.step(0, record_every=1)
    assert batch.positions('hose').shape == (2, 0, 21, 3)
    batch.step(0)
    assert batch.positions('hose').shape == (2, 21, 3)


def test_the_interpreter_may_end_while_a_thread_steps(hang):
    program = '''
import json, sys, threading, time
from verlet_cable.sim import Batch, Scene
batch = Batch(Scene.from_dict(json.loads(sys.argv[1])), 3)
def step():
    while True:
        batch.step()
threading.Thread(target=step, daemon=True).start()
time.sleep(0.1)
'''
    for _ in range(3):
        done = subprocess.run([sys.executable, '-c', program, json.dumps(hang)], stderr=subprocess.PIPE, text=True, timeout=60)
        assert (done.returncode, done.stderr) == (0, '')


def test_ctrl_c_between_two_steps_leaves_worlds_that_go_on(hang):
    program = '''
import json, sys
from verlet_cable.sim import Batch, Scene, World
scene = Scene.from_dict(json.loads(sys.argv[1]))
world = World(scene)
world.step(3)
batch = Batch(scene, 20)
batch.set_world([1, 5], world)
print('begins', flush=True)
try:
    batch.step(10 ** 12, record_every=10 ** 12)
except KeyboardInterrupt:
    apart = batch.time - batch.time[0]
    steps = round(batch.time[0] / scene.time_step)
    alone = World(scene)
    alone.step(steps)
    print(abs(apart[[1, 5]] - 3 * scene.time_step).max() < 1e-9, batch.positions('hose').shape)
    print(batch.state_hash[0] == alone.state_hash)
    batch.set_world(range(20), world)
    print(batch.state_hash == [world.state_hash] * 20, flush=True)
'''
    assert interrupted(program, hang) == 'True (20, 21, 3)\nTrue\nTrue\n'
