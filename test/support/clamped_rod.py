#!/usr/bin/env python3
"""Solves Kirchhoff's equations of a rod between two clamps as a boundary value problem with SciPy, and prints the table in
clamped_rod.h. The rod: 1 m, EI = 1 N m^2 about both axes, GJ = 0.75 N m^2, begun as an arc of 2 rad in the xy plane from the
origin along x; its end is carried from there to (0.6, 0.3, 0.2) m, with a yaw of 1 rad and a roll of 2 rad.

Unknowns along the rod: place r, orientation q of the material (w, x, y, z), force F in fixed axes, moment M in the material's.
"""
import numpy as np
from scipy.integrate import solve_bvp

EI, GJ = 1.0, 0.75
STIFFNESS = np.array([GJ, EI, EI])
END = np.array([0.6, 0.3, 0.2])
POINTS = 20  # of the table


def axes(q):
    w, x, y, z = q
    return (np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]),
            np.array([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)]),
            np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]))


def product(p, q):
    return np.array([p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3], p[0] * q[1] + p[1] * q[0] + p[2] * q[3] - p[3] * q[2],
                     p[0] * q[2] - p[1] * q[3] + p[2] * q[0] + p[3] * q[1], p[0] * q[3] + p[1] * q[2] - p[2] * q[1] + p[3] * q[0]])


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def solve(rest, s, y, place, orientation, tolerance):
    def rates(_, y):
        t, a, b = axes(y[3:7])
        force, moment = y[7:10], y[10:13]
        k = moment / STIFFNESS[:, None] + rest[:, None]
        turning = np.array([0 * k[0], k[0], k[1], k[2]])
        inside = np.array([(force * axis).sum(0) for axis in (t, a, b)])
        along = np.zeros_like(inside)
        along[0] = 1
        return np.vstack([t, 0.5 * product(y[3:7], turning), np.zeros_like(force), -cross(k, moment) - cross(along, inside)])

    def ends(first, last):
        # Three of the four components: the length of q is kept.
        largest = np.argmax(np.abs(orientation))
        others = [i for i in range(4) if i != largest]
        return np.concatenate([first[:3], first[3:7] - [1, 0, 0, 0], last[:3] - place, (last[3:7] - orientation)[others]])

    result = solve_bvp(rates, ends, s, y, tol=tolerance, max_nodes=20000)
    if result.status != 0:
        raise RuntimeError(result.message)
    return result


def about(axis, angle):
    return np.concatenate([[np.cos(angle / 2)], np.sin(angle / 2) * np.eye(3)[axis]])


def clamped(rest, steps=40):
    """`rest`: twist and curvature about y and z at rest [1/m]. The rod starts bent to the arc, with its rest twist."""
    rest = np.array(rest)
    s = np.linspace(0, 1, 101)
    y = np.zeros((13, s.size))
    y[0], y[1] = np.sin(2 * s) / 2, (1 - np.cos(2 * s)) / 2
    arc_end = np.array([np.sin(2) / 2, (1 - np.cos(2)) / 2, 0])
    # At first a rod that is unloaded as the arc; then its rest shape and the clamp go where they are to be.
    unloaded = np.array([0.0, 0.0, 2.0])
    y[3:7] = np.array([about(2, 2 * x) for x in s]).T
    for stage in range(1, 2 * steps + 1):
        shape, motion = min(stage / steps, 1), max(stage / steps - 1, 0)
        now = unloaded + shape * (rest - unloaded)
        place = arc_end + motion * (END - arc_end)
        orientation = product(product(about(2, 2 - motion), about(0, 2 * motion)), about(0, shape * rest[0]))
        if orientation @ y[3:7, -1] < 0:
            orientation = -orientation
        result = solve(now, s, y, place, orientation, 1e-10 if stage == 2 * steps else 1e-4)
        s = np.linspace(0, 1, 201)
        y = result.sol(s)
    t, a, b = axes(result.sol(0)[3:7])
    moment = result.sol(0)[10:13]
    return result.sol(np.linspace(0, 1, POINTS + 1))[:3].T, moment[0] * t + moment[1] * a + moment[2] * b, result.sol(0)[7:10]


def main():
    for name, rest in (('straight', (0, 0, 0)), ('curved', (0.5, 1, 2))):
        places, moment, force = clamped(rest)
        print(f'inline const ClampedRod {name}_rod{{')
        print('    {%s}, {%s},' % (', '.join(f'{x:.9f}' for x in moment), ', '.join(f'{x:.9f}' for x in force)))
        print('    {%s}};' % ',\n     '.join('{%s}' % ', '.join(f'{x:.10f}' for x in place) for place in places))


if __name__ == '__main__':
    main()
