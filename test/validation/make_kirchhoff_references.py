#!/usr/bin/env python3
"""Solves the boundary value problems of Kirchhoff's rod that the validation cases are compared with (needs python3-scipy).

Usage: make_kirchhoff_references.py > kirchhoff_references.h

A rod of length 1: r' = t, frame R = (t, d2, d3) with R' = R [u]x, moment R B (u - u0) with B = diag(GJ, EI2, EI3) and
u0 = (rest twist, rest curvatures about d2 and d3); the force F is constant, M' = -t x F, so M(s) = M(0) - (r(s) - r(0)) x F.
(Antman, Nonlinear Problems of Elasticity, 2005, chapter 8.) Nothing here comes from the simulation.
"""
import numpy as np
from scipy.integrate import solve_bvp, solve_ivp
from scipy.optimize import brentq

INTERVALS = 20  # of the rod, at whose ends its shape is written: every number of segments that these divide has nodes there


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def product(p, q):
    """Of quaternions w, x, y, z; columns."""
    w = p[0] * q[0] - p[1] * q[1] - p[2] * q[2] - p[3] * q[3]
    v = p[0] * q[1:] + q[0] * p[1:] + cross(p[1:], q[1:])
    return np.array([w, *v])


def conjugate(q):
    return np.array([q[0], -q[1], -q[2], -q[3]])


def axes(q):
    """Directors of a frame."""
    w, x, y, z = q
    return (np.array([1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)]),
            np.array([2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)]),
            np.array([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)]))


def turn(axis, angle):
    q = np.zeros(4)
    q[0] = np.cos(angle / 2)
    q[1 + axis] = np.sin(angle / 2)
    return q


def strain(q, moment, stiffness, rest):
    return np.array([(moment * d).sum(0) / b + u0 for d, b, u0 in zip(axes(q), stiffness, rest)])


# --- A rod between two clamps -----------------------------------------------------------------------------------------------

ARC = 2.0  # [rad] of the arc in the xy plane that the rod starts as, from the origin along x
# Of the end clamp's frame, x, y, z, roll, pitch, yaw: at the arc's end, and where the shape is taken; `roll` comes on top
START = np.array([np.sin(ARC) / ARC, (1 - np.cos(ARC)) / ARC, 0, 0, 0, ARC])
END = np.array([0.6, 0.35, 0.2, 0, -0.4, 1.2])


def end_pose(way, roll):
    pose = START + way * (END - START)
    return pose[:3], product(product(turn(2, pose[5]), turn(1, pose[4])), turn(0, pose[3] + roll * way))


def stable(parameters, stiffness, rest):
    """Whether no place is conjugate to the start: whether the pose there follows the force and moment at the start one to one.
    (Bretl and McCarthy, Quasi-static manipulation of a Kirchhoff elastic rod, 2014, theorem 8.)"""
    places = np.linspace(0.05, 1, 96)

    def poses(p):
        def slope(_, y):
            u = strain(y[3:], p[3:] - cross(y[:3], p[:3]), stiffness, rest)
            return np.concatenate([axes(y[3:])[0], 0.5 * product(y[3:], np.array([0, *u]))])
        return solve_ivp(slope, (0, 1), [0, 0, 0, 1, 0, 0, 0], t_eval=places, rtol=1e-11, atol=1e-13, method='DOP853').y

    d, middle = 1e-4, poses(parameters)
    columns = []
    for e in np.eye(6):
        step = (poses(parameters + d * e) - poses(parameters - d * e)) / (2 * d)
        columns.append(np.vstack([step[:3], product(conjugate(middle[3:]), step[3:])[1:]]))
    signs = np.sign(np.linalg.det(np.moveaxis(np.array(columns), 2, 0)))
    return bool(np.all(signs == signs[0]))


def clamped(stiffness, rest, roll):
    """Follows the solution from an arc that is straight at rest: first its rest strains grow, then the clamp goes its way."""
    stiffness, rest = np.array(stiffness, float), np.array(rest, float)
    s = np.linspace(0, 1, 41)
    shape = np.array([np.sin(ARC * s) / ARC, (1 - np.cos(ARC * s)) / ARC, 0 * s,
                      np.cos(ARC * s / 2), 0 * s, 0 * s, np.sin(ARC * s / 2)])
    parameters = np.array([0, 0, 0, 0, 0, stiffness[2] * ARC])
    path = [(grown, 0.0) for grown in np.linspace(0, 1, 11)] + [(1.0, way) for way in np.linspace(0, 1, 41)[1:]]
    for grown, way in path:
        position, orientation = end_pose(way, roll)
        orientation = product(orientation, turn(0, rest[0] * grown))  # the clamp took the rod with its rest twist

        def slope(_, y, p):
            u = strain(y[3:], p[3:, None] - cross(y[:3], p[:3, None] * np.ones_like(y[:3])), stiffness, rest * grown)
            return np.vstack([axes(y[3:])[0], 0.5 * product(y[3:], np.array([0 * u[0], *u]))])

        def conditions(first, last, _):
            return np.concatenate([first[:3], first[3:] - [1, 0, 0, 0], last[:3] - position,
                                   product(conjugate(orientation), last[3:])[1:]])

        tolerance = 1e-10 if way == 1 else 1e-6
        solution = solve_bvp(slope, conditions, s, shape, parameters, tol=tolerance, max_nodes=20000)
        if solution.status != 0:
            raise RuntimeError(f'grown {grown}, way {way}: {solution.message}')
        s, shape, parameters = solution.x, solution.y, solution.p
        if len(s) > 400:
            s = s[::2] if len(s) % 2 else np.append(s[:-1:2], 1.0)
            shape = solution.sol(s)
    if not stable(parameters, stiffness, rest):
        raise RuntimeError('not a minimum of energy')
    points = solution.sol(np.linspace(0, 1, INTERVALS + 1))[:3].T
    force, moment = parameters[:3], parameters[3:]
    end_moment = moment - cross(points[-1], force)
    # On the holders: the rod pulls the one at its start by its internal force and moment, the one at its end by their opposites.
    return points, np.array([force, moment, -force, -end_moment])


# --- A ribbon clamped at one end, upright, with a load on the other one -------------------------------------------------------

def buckling_load(stiffness, weight):
    """Tip load at which it leaves its plane; `weight` of the rod itself in tip loads. The rows are its end's moment, which
    vanishes, over the moment at the clamp."""

    def integrate(moment, load, dense=False):
        def slope(s, y):
            force = np.array([0, 0, -load * (1 + weight * (1 - s))])
            u = strain(y[3:7], y[7:], stiffness, np.zeros(3))
            t = axes(y[3:7])[0]
            return np.concatenate([t, 0.5 * product(y[3:7], np.array([0, *u])), -cross(t, force)])
        end = solve_ivp(slope, (0, 1), np.concatenate([[0, 0, 0, 1, 0, 0, 0], moment]), rtol=1e-12, atol=1e-14, method='DOP853')
        return end.y[7:, -1]

    def determinant(load):
        moment = np.array([0, load * (1 + 0.5 * weight), 0])
        for _ in range(6):  # the plane shape, by secants
            d = 1e-5
            slope = (integrate(moment + [0, d, 0], load)[1] - integrate(moment - [0, d, 0], load)[1]) / (2 * d)
            moment[1] -= integrate(moment, load)[1] / slope
        d = 1e-4
        columns = [(integrate(moment + d * e, load) - integrate(moment - d * e, load)) / (2 * d) for e in np.eye(3)[[0, 2]]]
        return np.linalg.det(np.array(columns)[:, [0, 2]])

    return brentq(determinant, 3.5, 4.5, xtol=1e-9)


CLAMPED = [  # name, (GJ, EI about y, EI about z), (rest twist, rest curvatures about y and z), roll
    ('straight', (0.75, 1, 1), (0, 0, 0), 2),
    ('curved', (0.75, 1, 1), (0, 0.5, 2), 2),
    ('curved and twisted', (0.75, 1, 1), (1.5, 1, 2), 2),
    ('flat', (0.5, 1, 0.2), (0, 0, 0), 2),
    ('flat, curved and twisted', (0.5, 1, 0.3), (1.5, 1, 2), 2),
    ('flat, curved and twisted, rolled back', (0.5, 1, 0.3), (1.5, 1, 2), -2),
]
RIBBON = (1.0, 1000.0, 1.0)
RIBBON_WEIGHT = 1e-3


def numbers(values):
    return '{' + ', '.join(f'{v + 0.0:.9f}' for v in values) + '}'


def main():
    print('#pragma once\n\n#include <array>\n#include <vector>\n')
    print('/// Written by make_kirchhoff_references.py: solutions of boundary value problems of Kirchhoff\'s rod, of length 1.')
    print('namespace verlet_cable::validation::references {\n')
    print('struct ClampedRod {\n  const char* name;')
    print('  double torsional_stiffness;\n  std::array<double, 2> bending_stiffness;')
    print('  double rest_twist;\n  std::array<double, 2> rest_curvature;\n  double roll;')
    print('  std::array<std::array<double, 3>, 4> holders;  ///< force and moment on the one at the start, on the one at the end')
    print('  std::vector<std::array<double, 3>> points;     ///< evenly along the rod\n};\n')
    print(f'constexpr double arc = {ARC};  ///< [rad] that the rods start as, from the origin along x')
    print("/// Of the end clamp's frame: x, y, z, roll, pitch, yaw; at the arc's end, and where the shape is taken, the rod's roll added")
    print(f'constexpr std::array<double, 6> arc_end{numbers(START)};')
    print(f'constexpr std::array<double, 6> goal{numbers(END)};\n')
    print('// clang-format off\ninline const std::vector<ClampedRod> clamped_rods{')
    for name, stiffness, rest, roll in CLAMPED:
        points, holders = clamped(stiffness, rest, roll)
        print(f'    {{"{name}", {stiffness[0]}, {{{stiffness[1]}, {stiffness[2]}}}, {rest[0]}, {{{rest[1]}, {rest[2]}}}, {roll},')
        print('     {{' + ',\n       '.join(numbers(v) for v in holders) + '}},')
        print('     {' + ',\n      '.join(numbers(v) for v in points) + '}},')
    print('};\n// clang-format on\n')
    print(f'/// Tip load at which a ribbon of EI = {RIBBON[1]:g} and {RIBBON[2]:g} and GJ = {RIBBON[0]:g} buckles, which weighs '
          f'{RIBBON_WEIGHT:g} of it')
    print(f'constexpr double ribbon_weight = {RIBBON_WEIGHT:g};')
    print(f'constexpr double ribbon_buckling_load = {buckling_load(RIBBON, RIBBON_WEIGHT):.8f};\n')
    print('}  // namespace verlet_cable::validation::references')


if __name__ == '__main__':
    main()
