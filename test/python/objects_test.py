"""What Python does with objects besides calling their methods: makes them without their constructors."""
import copy

import pytest

from verlet_cable.sim import Batch, Scene, World


@pytest.mark.parametrize('use', [lambda scene: scene.cable_names, World, lambda scene: Batch(scene, 2),
                                 lambda scene: Batch([scene])])
def test_a_scene_without_its_constructor_is_refused(use):
    with pytest.raises(TypeError, match='the object was not made: call its class, not its __new__'):
        use(Scene.__new__(Scene))


@pytest.mark.parametrize('use', [lambda world: world.time, lambda world: world.step(), lambda world: world.copy(),
                                 lambda world: world.set_frame('hand', [0, 0, 0], [0, 0, 0, 1]), copy.deepcopy,
                                 lambda world: Batch(world, 2)])
def test_a_world_without_its_constructor_is_refused(use):
    with pytest.raises(TypeError, match='the object was not made: call its class, not its __new__'):
        use(World.__new__(World))


@pytest.mark.parametrize('use', [len, lambda batch: batch.step(), lambda batch: batch.world(0), copy.copy])
def test_a_batch_without_its_constructor_is_refused(use):
    with pytest.raises(TypeError, match='the object was not made: call its class, not its __new__'):
        use(Batch.__new__(Batch))
