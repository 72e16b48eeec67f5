"""Worlds for tests."""
from verlet_cable.sim import Scene, World

IDENTITY = [0, 0, 0, 1]


def world_of(scene, *options):
    return World(Scene.from_dict(scene), *options)


def quiet(world):
    """At rest: settled, and its forces measured."""
    assert world.settle()
    world.step(5)
    return world
