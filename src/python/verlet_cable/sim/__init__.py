"""The simulation without ROS: scenes, worlds and batches of worlds.

    from verlet_cable.sim import Scene, World

    # The scene (a file of the package) does not say where its two grippers are: the motion does, here one that stands still.
    still = {'left_gripper': ([0], [[-0.4, 0, 1, 0, 0, 0, 1]]), 'right_gripper': ([0], [[0.4, 0, 1, 0, 0, 0, 1]])}
    world = World(Scene.load('config/hose.yaml'), still)
    status = world.step(100)          # 'ok', and world.time is 0.1 s
    nodes = world.positions('hose')   # (61, 3)
    force = world.wrench('left')[:3]  # on the gripper

    # Move a gripper, here up at 0.1 m/s: where it will be at the end of a step, before every step.
    for k in range(1000):
        world.set_frame('left_gripper', [-0.4, 0, 1 + 0.0001 * (k + 1)], [0, 0, 0, 1])
        status = world.step()

A frame that neither the motion nor `initial_pose` in the scene places begins at the origin.

World.step returns a status, the worst of its steps. From good to bad:

    ok             all is well
    overstretched  held points are further apart than what is between them can be; that was lengthened
    jumped         a frame changed its velocity too much for a motion; what it holds was carried along with it
    degraded       no solution, however short the substeps, or none without too much work, or a net is held where it cannot be:
                   motion was taken away, and it goes on from rest; or cables are in each other, and have no room to get apart
    fault          not even that: the cable stays as it was last

SI units everywhere. Poses are x, y, z, qx, qy, qz, qw in the scene's fixed frame.
"""
from verlet_cable._simulation import Batch, Event, Pieces, Pinned, Scene, SceneError, World

__all__ = ['Batch', 'Event', 'Pieces', 'Pinned', 'Scene', 'SceneError', 'World']
