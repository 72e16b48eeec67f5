"""The simulation without ROS: scenes, worlds and batches of worlds.

    from verlet_cable.sim import Scene, World

    world = World(Scene.load('hose.yaml'))
    world.set_frame('left_gripper', [0, 0, 1], [0, 0, 0, 1])
    world.step(100)
    world.positions('hose')     # (n + 1, 3)

SI units everywhere. Poses are x, y, z, qx, qy, qz, qw in the scene's fixed frame.
"""
from verlet_cable._simulation import Batch, Event, Pieces, Pinned, Scene, SceneError, World

__all__ = ['Batch', 'Event', 'Pieces', 'Pinned', 'Scene', 'SceneError', 'World']
