"""Simulation without ROS: scenes, worlds and batches of worlds.

    from verlet_cable.sim import Scene, World

    # The scene (a file of the package) has two grippers. The motion says where they are; here, they are at rest.
    still = {'left_gripper': ([0], [[-0.4, 0, 1, 0, 0, 0, 1]]), 'right_gripper': ([0], [[0.4, 0, 1, 0, 0, 0, 1]])}
    world = World(Scene.load('config/hose.yaml'), still)
    status = world.step(100)          # 'ok', and world.time is 0.1 s
    nodes = world.positions('hose')   # (61, 3)
    force = world.wrench('left')[:3]  # [N] on the gripper

    # Move a gripper up at 0.1 m/s: before every step, set its pose at the end of the step.
    for k in range(1000):
        world.set_frame('left_gripper', [-0.4, 0, 1 + 0.0001 * (k + 1)], [0, 0, 0, 1])
        status = world.step()

A frame of an attachment or guide needs a pose before the first step: by the motion, as `initial_pose` in the scene, or by set_frame.

World.step returns the worst status of its steps. From good to bad, with the numbers of Batch.status:

    0 ok               all is well
    1 jumped           the velocity of a frame changed too much for a motion; what the frame holds was carried along
    2 overstretched    held points are further apart than the cable or net between them is long; it was lengthened
    3 inside_obstacle  a cable is inside an obstacle, deeper than half its radius, or a body is; it is pushed out
    4 not_settled      no equilibrium was found to start from, or by settle(); said until the first step after that is done
    5 degraded         no solution was found with the shortest substeps or within the budget of work, or a net is held where it cannot
                       be: it lost its velocity and continues from rest; or cables are inside each other without room to separate
    6 fault            that failed, too: the cable stays in its last state

When each begins and ends is in World.events() and Batch.events(world), under the names that cable_sim prints. Arrays are read-only.

All units are SI units. Poses are x, y, z, qx, qy, qz, qw in the fixed frame of the scene.
"""
try:
    from verlet_cable._simulation import Batch, Event, Load, Pieces, Pinned, Scene, SceneError, World, Worlds
except ImportError as error:
    raise ImportError(f'verlet_cable.sim: {error}; its compiled part is not where this file is: build the ROS workspace and source its '
                      'setup.bash, or type `pip install .` in the checkout, and import it from another directory') from error

__all__ = ['Batch', 'Event', 'Load', 'Pieces', 'Pinned', 'Scene', 'SceneError', 'World', 'Worlds']
