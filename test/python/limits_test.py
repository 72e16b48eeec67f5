"""What asks for more memory or time than anybody has is refused by name, before it takes any."""
import os

import numpy as np
import pytest
from worlds import world_of

from verlet_cable.sim import Batch, Scene, SceneError, World


def refusal(keys):
    with pytest.raises(SceneError) as refused:
        Scene.from_dict(keys)
    assert len(str(refused.value)) < 300
    return refused.value.errors[0]


def test_lists_that_multiply_are_refused():
    many = ['x'] * 10
    for _ in range(12):
        many = [many] * 10
    assert refusal({'cables': many}).endswith('with it the scene has more than 1000000 values; allowed: less')


def test_what_contains_itself_is_refused():
    keys = {}
    keys['a'] = keys
    assert refusal(keys).endswith('nested deeper than 32 levels; allowed: less')


def test_arrays_are_refused_before_they_are_copied():
    endless = np.lib.stride_tricks.as_strided(np.zeros(1), (10**12,), (0,))
    assert refusal({'gravity': endless}).startswith('gravity: with it the scene has more than 1000000 values')


def test_texts_are_refused_before_they_are_copied():
    assert refusal({'frame_id': 'x' * 17_000_000}).startswith('frame_id: with it the scene has more than 16777216 bytes')
    assert refusal({'x' * 17_000_000: 1}).startswith('scene: with it the scene has more than 16777216 bytes')


def test_integers_that_python_does_not_write_are_named():
    assert refusal({'time_step': 10**5000}).startswith("time_step: <class 'int'>")


def test_arguments_of_obstacles_are_bounded_too(hang):
    world = world_of(hang)
    before = world.state_hash
    with pytest.raises(SceneError, match='vertices: with it the scene has more than 1000000 values'):
        world.set_obstacle('mesh', type='mesh', vertices=np.zeros((1_000_000, 3)))
    assert world.state_hash == before


def test_named_pipes_are_refused_as_nobody_may_ever_write_to_them(hang, tmp_path):
    pipe = tmp_path / 'pipe'
    os.mkfifo(pipe)
    with pytest.raises(SceneError, match='cannot read: it is a named pipe'):
        Scene.load(pipe)
    with pytest.raises(SceneError, match='motion: .*: cannot read: it is a named pipe'):
        World(Scene.from_dict(hang), motion=pipe)


def test_records_are_sized_before_memory_is_taken(hang):
    batch = Batch(Scene.from_dict(hang), 2)
    before = batch.state_hash
    refusal = r'record_every: 1000000000000 records of 2 worlds take [0-9.e+]* GB of memory; allowed: at most the'
    with pytest.raises(MemoryError, match=refusal):
        batch.step(10**12, record_every=1)
    assert batch.state_hash == before


def test_batches_are_sized_before_memory_is_taken(hang):
    hang['cables'] = [{'name': 'hose', 'length': 1, 'segments': 20_000, 'material': 'wire'}]
    scene = Scene.from_dict(hang)
    refusal = r'count: 1000000 worlds take 4001 GB of memory; allowed: at most the'
    with pytest.raises(MemoryError, match=refusal):
        Batch(scene, 1_000_000)
    with pytest.raises(MemoryError, match=refusal):
        Batch(World(scene), 1_000_000)
