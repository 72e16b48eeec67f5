"""What bench/python.cpp does, from Python. Prints seconds: of importing, a step, and the rollouts; and the last world's hash."""
import math
import sys
import time

import numpy

begin = time.perf_counter()
from verlet_cable.sim import Batch, Scene, World  # noqa: E402: timed
importing = time.perf_counter() - begin

STEPS, TIME_STEP = 200, 0.005


def start_of(segments):
    """A settled cable that is held by a hand, as start_of in rollouts.cpp."""
    attachments = [{'name': 'base', 'at': 'start', 'offset': [0, 0, 0]},
                   {'name': 'grip', 'at': 'end', 'frame': 'hand', 'initial_pose': [0.6, 0, 0, 0, 0, 0]}]
    world = World(Scene.from_dict({
        'time_step': TIME_STEP, 'materials': {'rope': {'linear_density': 0.1, 'radius': 0.005}},
        'cables': [{'name': 'cable', 'length': 1.0, 'segments': segments, 'material': 'rope', 'attachments': attachments}]}))
    world.settle()
    return world


def time_a_step(world, times):
    begin = time.perf_counter()
    for _ in range(times):
        world.step()
    return (time.perf_counter() - begin) / times


def time_rollouts(world, count):
    poses = numpy.zeros((count, STEPS, 7))
    poses[..., 6] = 1
    for i in range(count):
        frequency = 1 + 0.5 * i / count
        poses[i, :, 0] = [0.6 + 0.1 * (1 - math.cos(2 * math.pi * frequency * (k * TIME_STEP))) for k in range(1, STEPS + 1)]
    batch = Batch(world, count)
    begin = time.perf_counter()
    batch.set_frames('hand', poses)
    batch.step(STEPS)
    return time.perf_counter() - begin, batch.state_hash[-1]


count, segments, times = map(int, sys.argv[1:])
start = start_of(segments)
step = min(time_a_step(start.copy(), times) for _ in range(50))
print(importing, step, *time_rollouts(start, count))
