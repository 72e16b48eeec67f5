#!/usr/bin/env python3
"""What cable_sweep costs beside the same samples in C++, kept in memory: the same values, on as many threads as cable_sweep has workers.

Usage: sweep_cost.py RUNS CABLE_SWEEP [--quick]    (bench/sweep_runs.cpp as it was built, the program)
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import zarr

SCENE = """
time_step: 0.005
materials: {m: {linear_density: 0.1, radius: 0.005, drag: 0.02}}
cables:
  - {name: hose, length: 1.0, segments: 50, material: m, attachments: [
      {name: left, at: start}, {name: right, at: end, initial_pose: [0.6, 0, 0, 0, 0, 0], frame: hand}]}
fluid: {velocity: [0.3, 1, 0]}
"""
SWEEP = """
scene: scene.yaml
duration: 1.0
record: {rate: 50, fields: [positions, tension]}
samples: %d
seed: 1
vary:
  cables[0].length: {uniform: [0.9, 1.1]}
  materials.m.drag: {log_uniform: [0.01, 0.1]}
  materials.m.linear_density: {log_uniform: [0.05, 0.2]}
"""
VARIED = ('cables[0].length', 'materials.m.drag', 'materials.m.linear_density')  # in the order in which the C++ program reads them
TIMES = 3  # each is run, in turn; the least counts
MOST = 1.15  # the time of a sweep over that of the runs


def output_of(*command, **options):
    return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True, **options).stdout


def sweep(cable_sweep, workers):
    output = output_of(cable_sweep, 'sweep.yaml', '--output', 'store', '--workers', str(workers), stderr=subprocess.DEVNULL)
    return float(re.search(r'simulated now in ([0-9.]+) s', output).group(1))


def runs(program, store, workers):
    """(seconds world after world, seconds of many at once)."""
    np.savetxt('values', np.column_stack([store[f'vary/{key}'][:] for key in VARIED]), fmt='%r')
    one_by_one, together = output_of(program, 'scene.yaml', 'values', str(workers), 'rows').split()
    return float(one_by_one), float(together)


def same_numbers(store):
    positions, tension = store['hose/positions'], store['hose/tension']
    samples, rows = positions.shape[:2]
    numbers = np.fromfile('rows').reshape(samples, rows, -1)
    nodes = positions.shape[2] * 3
    return np.array_equal(numbers[:, :, :nodes], positions[:].reshape(samples, rows, nodes)) and \
        np.array_equal(numbers[:, :, nodes:], tension[:])


def main():
    program, cable_sweep = (str(Path(path).resolve()) for path in sys.argv[1:3])
    samples = 2000 if '--quick' in sys.argv else 10000
    workers = len(os.sched_getaffinity(0))
    with tempfile.TemporaryDirectory(prefix='sweep_cost-') as folder:
        os.chdir(folder)
        Path('scene.yaml').write_text(SCENE)
        Path('sweep.yaml').write_text(SWEEP % samples)
        seconds = []
        for _ in range(TIMES):
            shutil.rmtree('store', ignore_errors=True)
            swept = sweep(cable_sweep, workers)
            store = zarr.open_group('store', mode='r')
            seconds.append((swept, *runs(program, store, workers)))
        swept, one_by_one, together = (min(column) for column in zip(*seconds))
        if not same_numbers(store):
            sys.exit('sweep_cost.py: cable_sweep and the C++ program do not compute the same numbers')
        os.chdir('/')
    print(f'## A sweep: {samples} samples of 1 s, 50 segments, 5 ms, 50 rows a second; {workers} workers or threads\n')
    print('| | s | cable_sweep over it | target | verdict |\n|---|---|---|---|---|')
    print(f'| cable_sweep, into a Zarr store, start-up not counted | {swept:.2f} | | | |')
    ratio = swept / one_by_one
    print(f'| C++, world after world, into memory | {one_by_one:.2f} | {ratio:.2f} | {MOST} | {"reached" if ratio <= MOST else "MISSED"} |')
    print(f'| C++, many worlds at once, into memory | {together:.2f} | {swept / together:.2f} | | |')


if __name__ == '__main__':
    main()
