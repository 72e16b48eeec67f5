#!/usr/bin/env python3
"""camera_speed.py [THREADS]: how many images verlet_cable.camera makes in a second: of 20 cables on a table below an arm, and of batches of
64 worlds."""
import sys
import time

import numpy as np

from verlet_cable.camera import Camera
from verlet_cable.sim import Batch, Scene, World

REPEATS = 10
MATERIALS = {'wire': {'linear_density': 0.05, 'radius': 0.006, 'bending_stiffness': 0.001, 'torsional_stiffness': 0.001}}


def cable(name, y, segments=60):
    return {'name': name, 'length': 1.0, 'segments': segments, 'material': 'wire', 'color': [*np.random.default_rng(len(name)).random(3), 1],
            'initial': {'type': 'straight', 'from': [-0.5, y, 0.77], 'to': [0.5, y + 0.1, 0.77]}}


def table():
    arm = [{'name': f'link_{k}', 'type': 'capsule', 'radius': 0.06, 'length': 0.2, 'pose': [0.1 * k - 0.2, 0.5, 0.85 + 0.15 * k, 0, 0.5, 0]}
           for k in range(7)]
    return Scene.from_dict({
        'frame_id': 'world', 'time_step': 0.005, 'materials': MATERIALS, 'cables': [cable(f'cable_{k}', 0.05 * k - 0.5) for k in range(20)],
        'obstacles': [{'name': 'floor', 'type': 'plane'}, {'name': 'table', 'type': 'box', 'size': [1.4, 1.6, 0.05],
                                                           'pose': [0, 0, 0.725, 0, 0, 0]}, *arm]})


def rope():
    return Scene.from_dict({'frame_id': 'world', 'time_step': 0.005, 'materials': MATERIALS, 'cables': [cable('rope', 0)],
                            'obstacles': [{'name': 'floor', 'type': 'plane'}]})


def images_in_a_second(camera, worlds, images, count):
    times = []
    for _ in range(REPEATS):
        begin = time.perf_counter()
        camera.render(worlds, images)
        times.append(time.perf_counter() - begin)
    return count / min(times)


def main():
    threads = int(sys.argv[1]) if len(sys.argv) > 1 else 1
    noise = {'axial': [0.001, 0, 0.002], 'dropout_angle': 80}
    world, batch = World(table()), Batch(rope(), 64)
    for size in ((640, 480), (1280, 720)):
        camera = Camera(*size, noise=noise, threads=threads).look_at([0.9, -1.3, 1.5], [0, 0.05, 0.8])
        for images in (['depth'], ['depth', 'mask', 'points', 'truth'], ['depth', 'rgb', 'mask', 'points', 'truth']):
            print(f'{size[0]} x {size[1]}: {images_in_a_second(camera, world, images, 1):6.1f} of {", ".join(images)}', flush=True)
    small = Camera(128, 128, threads=threads).look_at([0.9, -1.3, 1.5], [0, 0.05, 0.8])
    for images in (['depth'], ['depth', 'mask'], ['depth', 'rgb', 'mask', 'truth']):
        print(f'64 worlds at 128 x 128: {images_in_a_second(small, batch, images, 64):6.0f} of {", ".join(images)}', flush=True)


if __name__ == '__main__':
    main()
