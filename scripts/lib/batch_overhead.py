#!/usr/bin/python3
"""batch_overhead.py [WORLDS [REPEATS]]: what a Batch takes beside the steps themselves, in processor time: for each call the time of a
world, and set_frames and positions as a part of step.

Needs the workspace's setup sourced.
"""
import sys
import time

import numpy as np

from verlet_cable.sim import Batch, Scene

WORLDS, REPEATS = 10000, 20
SEGMENTS = 50
SCENE = {
    'time_step': 0.005,
    'materials': {'rope': {'linear_density': 0.05, 'radius': 0.004, 'bending_stiffness': 0.001}},
    'cables': [{'name': 'rope', 'length': 1.0, 'segments': SEGMENTS, 'material': 'rope', 'attachments': [
        {'name': 'left', 'at': 'start', 'frame': 'hand', 'initial_pose': [0, 0, 0, 0, 0, 0]},
        {'name': 'right', 'at': 'end', 'offset': [0.8, 0, 0]}]}],
}


def mean_time(call, repeats):
    """[s] of processor time."""
    begin = time.process_time()
    for k in range(repeats):
        call(k)
    return (time.process_time() - begin) / repeats


def main():
    worlds, repeats = [int(argument) for argument in sys.argv[1:]] + [WORLDS, REPEATS][len(sys.argv) - 1:]
    batch = Batch(Scene.from_dict(SCENE), worlds)
    poses = np.zeros((repeats + 1, worlds, 7))
    poses[..., 0] = 1e-4 * np.arange(repeats + 1)[:, None]
    poses[..., 6] = 1
    batch.set_frames('hand', poses[0])
    batch.step(10)
    batch.positions('rope')
    times = {}
    for name, call in (('set_frames', lambda k: batch.set_frames('hand', poses[k])), ('step', lambda k: batch.step()),
                       ('positions', lambda k: batch.positions('rope')), ('status', lambda k: batch.status),
                       ('observations', lambda k: batch.observations([('positions', 'rope', 20), ('wrench', 'left')]))):
        times[name] = mean_time(call, repeats)
        print(f'{name}: {1e6 * times[name] / worlds:.2f} us a world', flush=True)
    beside = times['set_frames'] + times['positions']
    print(f'set_frames and positions: {100 * beside / times["step"]:.1f} % of the step of {SEGMENTS} segments, {worlds} worlds')


if __name__ == '__main__':
    main()
