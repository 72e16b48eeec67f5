"""Simulation without ROS: scenes, worlds and batches of worlds.

    from verlet_cable.sim import Scene, World

    # The scene (a file of the package) has two grippers without poses. The motion gives them; here, they are at rest.
    still = {'left_gripper': ([0], [[-0.4, 0, 1, 0, 0, 0, 1]]), 'right_gripper': ([0], [[0.4, 0, 1, 0, 0, 0, 1]])}
    world = World(Scene.load('config/hose.yaml'), still)
    status = world.step(100)          # 'ok', and world.time is 0.1 s
    nodes = world.positions('hose')   # (61, 3)
    force = world.wrench('left')[:3]  # [N] on the gripper

    # Move a gripper up at 0.1 m/s: before every step, set its pose at the end of the step.
    for k in range(1000):
        world.set_frame('left_gripper', [-0.4, 0, 1 + 0.0001 * (k + 1)], [0, 0, 0, 1])
        status = world.step()

A frame with a pose neither in the motion nor as `initial_pose` in the scene starts at the origin.

World.step returns the worst status of its steps. From good to bad:

    ok             all is well
    overstretched  held points are further apart than the cable or net between them is long; it was lengthened
    jumped         the velocity of a frame changed too much for a motion; what the frame holds was carried along
    degraded       no solution was found with the shortest substeps or within the budget of work, or a net is held where it cannot
                   be: it lost its velocity and continues from rest; or cables are inside each other without room to separate
    fault          that failed, too: the cable stays in its last state

All units are SI units. Poses are x, y, z, qx, qy, qz, qw in the fixed frame of the scene.
"""
from verlet_cable._simulation import Batch, Event, Pieces, Pinned, Scene, SceneError, World

__all__ = ['Batch', 'Event', 'Pieces', 'Pinned', 'Scene', 'SceneError', 'World']
