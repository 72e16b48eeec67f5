"""One world of a batch that is not as the others: its scene is wrong, its cable breaks, it faults. The others go on."""
import pickle

import numpy
import pytest

from verlet_cable.sim import Batch, Scene, SceneError, World
from worlds import IDENTITY


def reaching(hang):
    """Alike but for where the hand is: a cable of 1 m reaches the first, third and fifth."""
    del hang['cables'][0]['attachments'][0]['initial_pose']
    scenes = []
    for length in (1.0, 0.3, 1.1, 0.2, 0.9):
        hang['cables'][0]['length'] = length
        scenes.append(Scene.from_dict(hang))
    return scenes, {'hand': ([0.0], [[0.6, 0, 0, *IDENTITY]])}


def test_a_scene_that_cannot_start_is_named_and_left_out(hang):
    scenes, motion = reaching(hang)
    with pytest.raises(SceneError):
        Batch(scenes, motion)
    batch = Batch(scenes, motion, keep_going=True, threads=2)
    assert [bool(error) for error in batch.errors] == [False, True, False, True, False] and 'cables[0].length: 0.3 m' in batch.errors[1]
    for one in (batch, pickle.loads(pickle.dumps(batch)), batch.copy()):
        assert one.status.tolist() == [0, 6, 0, 6, 0]
    batch.step(20, record_every=10)
    assert batch.status.tolist() == [0, 6, 0, 6, 0]
    assert batch.positions('hose').shape == (5, 2, 21, 3)
    for i in (0, 2, 4):
        world = World(scenes[i], motion)
        world.step(20)
        assert batch.state_hash[i] == world.state_hash
    assert batch.time.tolist() == pytest.approx([0.1, 0, 0.1, 0, 0.1])
    again = pickle.loads(pickle.dumps(batch))
    assert again.errors == batch.errors and (again.status == batch.status).all()
    for one in (batch, again):
        one.set_world(1, World(scenes[0], motion))
        assert one.errors[1] == '' and one.errors[3]
        one.step(20)
        assert one.status.tolist() == [0, 0, 0, 6, 0]
    assert again.state_hash == batch.state_hash
    assert not batch.settle()[3]


def test_the_first_scenes_may_be_wrong_and_not_all(hang):
    scenes, motion = reaching(hang)
    batch = Batch([scenes[1], scenes[1], scenes[2], scenes[0]], motion, keep_going=True)
    assert [bool(error) for error in batch.errors] == [True, True, False, False]
    batch.step(5)
    assert batch.status.tolist() == [6, 6, 0, 0]
    assert pickle.loads(pickle.dumps(batch)).state_hash == batch.state_hash
    with pytest.raises(SceneError, match='cables.*length: 0.3 m'):
        Batch([scenes[1], scenes[3]], motion, keep_going=True)


def test_scenes_that_are_not_alike_are_left_out(hang):
    first = Scene.from_dict(hang)
    hang['cables'][0]['segments'] = 10
    batch = Batch([first, Scene.from_dict(hang)], keep_going=True)
    assert batch.errors[0] == '' and 'scenes[1].cables: hose of 10 segments' in batch.errors[1]


def test_arrays_of_cables_that_broke_have_what_is_given_in_their_place(hang):
    batch = Batch(Scene.from_dict(hang), 3)
    batch.step(2)
    batch.cut(1, 'hose', node=10)
    with pytest.raises(ValueError, match=r'positions of hose: world 1 has none of shape \(21, 3\).*missing=0.0'):
        batch.positions('hose')
    positions = batch.positions('hose', missing=-1.0)
    assert positions.shape == (3, 21, 3) and (positions[1] == -1).all() and not positions.flags.writeable
    assert (positions[0] == batch.worlds[0].positions('hose')).all() and (positions[2] != -1).any()
    seen = batch.observations([('positions', 'hose'), ('wrench', 'left')], missing=numpy.nan)
    assert seen.shape == (3, 69) and numpy.isnan(seen[1, :63]).all() and numpy.isfinite(seen[:, 63:]).all()
    batch.step(4, record_every=2, fields=['tension', 'wrench'])
    assert (batch.tension('hose', missing=-2.0)[1] == -2).all() and (batch.tension('hose', missing=-2.0)[0] != -2).all()
    assert batch.wrench('left').shape == (3, 2, 6)


def test_records_before_a_cable_broke_are_kept(hang):
    hang['materials']['wire']['breaking_tension'] = 3.0
    batch = Batch(Scene.from_dict(hang), 2)
    poses = numpy.tile([0.6, 0, 0, *IDENTITY], (2, 200, 1))
    poses[1, :, 0] += numpy.linspace(0, 0.45, 200)  # it is drawn straight, and breaks
    batch.set_frames('hand', poses)
    batch.step(200, record_every=20, fields=['tension'])
    tension = batch.tension('hose', missing=-1.0)
    broken = (tension[1] == -1).all(axis=1)
    assert broken[-1] and not broken[0] and (numpy.diff(broken.astype(int)) >= 0).all() and (tension[0] != -1).all()
    assert 'BROKE' in [event.type for event in batch.events(1)]
