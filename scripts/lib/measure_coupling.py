#!/usr/bin/python3
"""measure_coupling.py OUTPUT_DIRECTORY: when a vehicle that another simulator moves stays stable on its tether, a table in measured.md.

What doc/how_to/vehicles.md shows, by the Python module, in a minute.
"""
import math
import pathlib
import sys

import numpy
from markdown_table import table
from verlet_cable.sim import Scene, World

TETHER = 0.5      # [kg]
LENGTH = 5.0      # [m]
HEIGHT = 4.5      # [m] at which the vehicle hovers, a metre to the side
SWAY = 0.5, 0.3   # [m], [Hz] of the place that it is to keep
GAINS = 4.0, 4.0  # [1/s^2], [1/s] of its controller
SECONDS = 6.0
STEP = 0.001      # [s] of the tether
GRAVITY = numpy.array([0, 0, -9.81])
IDENTITY = [0, 0, 0, 1]
RATIOS = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 100.0]  # of the vehicle's mass to the tether's
RATES = [100, 1000]  # [Hz]
ROPES = {'inextensible': {}, 'EA = 1 kN': {'axial_stiffness': 1e3, 'axial_damping': 2.0}}
ALIKE = 0.05  # of the acceleration, by which it may differ from that of the vehicle in one solve with its tether

INTRODUCTION = """# Explicit coupling: when it is stable

By `scripts/pictures` (`scripts/lib/measure_coupling.py`): a vehicle hovers 4.5 m above the point where its tether of 5 m and 0.5 kg is held, a
metre to the side, and sways by 0.5 m at 0.3 Hz; steps of 1 ms. In the rows "frame" another simulator moves it: at the rate, it takes the mean
force of the last interval, and gives where the vehicle's frame goes next. "Added mass" is that with a tether's mass on both sides of its
equation. In the row "body" the vehicle is a body here, and its thrust comes at the rate (`apply_wrench`). The columns are the vehicle's mass in
masses of its tether. "ok": its acceleration is within 5 % of that of the body with thrust in every step; a number: so many times as large, mostly
noise; "-": it flies away."""


def tethered(rope, vehicle):
    """A world; the vehicle is a body of this mass [kg], or a frame where that is None."""
    held = {'name': 'vehicle', 'at': 'end'}
    held.update({'frame': 'vehicle', 'initial_pose': [1, 0, HEIGHT, 0, 0, 0]} if vehicle is None else {'body': 'vehicle'})
    scene = {'time_step': STEP, 'materials': {'tether': {'linear_density': TETHER / LENGTH, 'radius': 0.004, **rope}},
             'cables': [{'name': 'tether', 'length': LENGTH, 'segments': 50, 'material': 'tether',
                         'attachments': [{'name': 'ground', 'at': 'start'}, held]}]}
    if vehicle is not None:
        scene['bodies'] = [{'name': 'vehicle', 'mass': vehicle, 'inertia': [vehicle] * 3, 'pose': [1, 0, HEIGHT, 0, 0, 0]}]
    return World(Scene.from_dict(scene))


def thrust(mass, time, place, velocity):
    """(3,) [N] What carries the weight, and keeps the vehicle where it is to be."""
    target = numpy.array([1 + SWAY[0] * math.sin(2 * math.pi * SWAY[1] * time), 0, HEIGHT])
    return mass * (GAINS[0] * (target - place) - GAINS[1] * velocity - GRAVITY)


def spread(velocities, rate):
    """[m/s^2] Root mean square of the acceleration in the second half."""
    accelerations = numpy.diff(velocities[len(velocities) // 2:], axis=0) * rate
    return math.sqrt((accelerations**2).sum(axis=1).mean())


def as_body(rope, mass, rate):
    """[m/s^2] Of one solve with the tether, at the thrust's rate."""
    world, velocities, steps = tethered(rope, mass), [], round(1 / rate / STEP)
    for tick in range(round(SECONDS * rate)):
        place, velocity = world.body_pose('vehicle')[:3], world.body_twist('vehicle')[:3]
        velocities.append(velocity)
        world.apply_wrench('vehicle', force=thrust(mass, tick / rate, place, velocity), torque=[0, 0, 0])
        world.step(steps)
    return spread(velocities, rate)


def as_frame(rope, mass, rate, added):
    """Likewise, of a vehicle that is simulated elsewhere. `added` [kg]: on both sides of its equation. Infinite where it flies away."""
    world, velocities, steps = tethered(rope, None), [], round(1 / rate / STEP)
    place, velocity, acceleration = numpy.array([1, 0, HEIGHT]), numpy.zeros(3), numpy.zeros(3)
    pull = numpy.zeros(3)  # on the vehicle, mean over the last interval
    for tick in range(round(SECONDS * rate)):
        force = thrust(mass, tick / rate, place, velocity) + mass * GRAVITY + pull
        acceleration = (force + added * acceleration) / (mass + added)
        velocity = velocity + acceleration / rate
        velocities.append(velocity)
        target = place + velocity / rate
        if numpy.linalg.norm(target) > 10 * LENGTH:
            return math.inf
        pull = numpy.zeros(3)
        for step in range(steps):
            world.set_frame('vehicle', place + (step + 1) / steps * (target - place), IDENTITY)
            world.step()
            pull += world.wrench('vehicle')[:3] / steps
        place = target
    return spread(velocities, rate)


def cell(value, right):
    if not value < 1e3 * right:
        return '-'
    return 'ok' if abs(value / right - 1) < ALIKE else f'{value / right:.2g}'


def main():
    folder = pathlib.Path(sys.argv[1])
    rows = []
    for name, rope in ROPES.items():
        rights = [as_body(rope, ratio * TETHER, 1 / STEP) for ratio in RATIOS]
        for rate in RATES:
            for kind, run in (('frame', lambda mass: as_frame(rope, mass, rate, 0.0)),
                              ('frame, added mass', lambda mass: as_frame(rope, mass, rate, TETHER)),
                              ('body', lambda mass: as_body(rope, mass, rate))):
                rows.append([name, f'{rate} Hz', kind] +
                            [cell(run(ratio * TETHER), right) for ratio, right in zip(RATIOS, rights)])
    head = ['tether', 'rate', 'vehicle', *(f'{ratio:g}' for ratio in RATIOS)]
    (folder / 'measured.md').write_text('\n'.join([INTRODUCTION, '', *table(head, rows), '']), encoding='utf-8')


if __name__ == '__main__':
    main()
