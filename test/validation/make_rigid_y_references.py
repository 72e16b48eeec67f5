#!/usr/bin/env python3
"""Solves Kirchhoff's equations of three rods that are welded together at one end each (needs python3-numpy).

Usage: make_rigid_y_references.py > rigid_y_references.h

Rods of length 1 that cannot stretch, EI = 1, GJ = 0.75, straight at rest, welded at the origin; their outer ends, in the
DIRECTIONS from there, are clamped. That of the first one is turned by 0.5 rad about an axis of its own, x along the rod towards
the weld. (Three directions in a plane would leave no room to bend without stretching.) Each rod: r' = t, frame R = (t, d2, d3) with R' = R [u]x, R B u = M, the force F constant,
M(s) = M(0) - (r(s) - r(0)) x F. Unknowns: F and M(0) of each rod, and the pose of the weld; equations: the pose of each rod's
end, and the balance of forces and moments there. Nothing here comes from the simulation.
"""
import numpy as np

DIRECTIONS = np.array([[-1, 0, 0], [0.36, 0.48, 0.8], [0.48, -0.8, 0.36]])  # from the weld to the clamps
STIFFNESS = np.array([0.75, 1, 1])
TURN, STEPS, SUBSTEPS = 0.5, 10, 200


def product(p, q):
    """Of quaternions w, x, y, z; rows."""
    w = p[..., :1] * q[..., :1] - (p[..., 1:] * q[..., 1:]).sum(-1, keepdims=True)
    return np.concatenate([w, p[..., :1] * q[..., 1:] + q[..., :1] * p[..., 1:] + np.cross(p[..., 1:], q[..., 1:])], -1)


def conjugate(q):
    return q * np.array([1, -1, -1, -1])


def about(axis, angle):
    return np.concatenate([[np.cos(angle / 2)], np.sin(angle / 2) * np.asarray(axis, float)])


def rotate(q, v):
    return product(product(q, np.concatenate([np.zeros(q.shape[:-1] + (1,)), v], -1)), conjugate(q))[..., 1:]


def ends(places, turns, force, moment):
    """Of rods from their clamps: Runge and Kutta's method; rows."""
    def slope(r, q):
        m = moment - np.cross(r - places, force)
        u = rotate(conjugate(q), m) / STIFFNESS
        return rotate(q, np.broadcast_to([1.0, 0, 0], r.shape)), 0.5 * product(q, np.concatenate([0 * u[..., :1], u], -1))
    r, q, h = places, turns, 1 / SUBSTEPS
    for _ in range(SUBSTEPS):
        a = slope(r, q)
        b = slope(r + h / 2 * a[0], q + h / 2 * a[1])
        c = slope(r + h / 2 * b[0], q + h / 2 * b[1])
        d = slope(r + h * c[0], q + h * c[1])
        r = r + h / 6 * (a[0] + 2 * b[0] + 2 * c[0] + d[0])
        q = q + h / 6 * (a[1] + 2 * b[1] + 2 * c[1] + d[1])
    return r, q, moment - np.cross(r - places, force)


def towards(direction):
    """Yaw, then pitch, from x."""
    return product(about([0, 0, 1], np.arctan2(direction[1], direction[0])), about([0, 1, 0], -np.arcsin(direction[2])))


def residuals(x, turns, rest):
    """Of several sets of unknowns, as rows: force and moment of each rod, place of the weld, vector of its quaternion."""
    sets = len(x)
    force, moment = x[:, :9].reshape(-1, 3), x[:, 9:18].reshape(-1, 3)
    weld = np.concatenate([np.sqrt(1 - (x[:, 21:] ** 2).sum(1, keepdims=True)), x[:, 21:]], 1)
    r, q, m = ends(np.tile(DIRECTIONS, (sets, 1)), np.tile(turns, (sets, 1)), force, moment)
    wanted = product(np.repeat(weld, 3, 0), np.tile(rest, (sets, 1)))
    gap = (r - np.repeat(x[:, 18:21], 3, 0)).reshape(sets, 9)
    turn = product(conjugate(wanted), q)[:, 1:].reshape(sets, 9)
    return np.concatenate([gap, turn, force.reshape(sets, 3, 3).sum(1), m.reshape(sets, 3, 3).sum(1)], 1)


def solve(axis):
    rest = np.array([towards(-d) for d in DIRECTIONS])
    x = np.zeros(24)
    for step in range(1, STEPS + 1):
        turns = rest.copy()
        turns[0] = product(rest[0], about(np.eye(3)[axis], TURN * step / STEPS))
        for _ in range(20):
            d = 1e-6
            all_of_them = residuals(np.vstack([x, x + d * np.eye(24), x - d * np.eye(24)]), turns, rest)
            x = x - np.linalg.solve((all_of_them[1:25] - all_of_them[25:]).T / (2 * d), all_of_them[0])
            if np.abs(all_of_them[0]).max() < 1e-11:
                break
        else:
            raise RuntimeError('no solution')
    return x


def vector(v):
    return '{' + ', '.join(f'{x + 0:.10f}' for x in v) + '}'


def main():
    print('''#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable::validation {

/// Three welded rods of which one end is turned by 0.5 rad about an axis of its own, as make_rigid_y_references.py finds them
/// (see there), which prints this file.
struct RigidY {
  Vector3 place;       ///< [m] of the weld
  Vector3 forces[3];   ///< [N] on the clamps of the rods
  Vector3 moments[3];  ///< [N m] likewise
};

/// From the weld at the origin to the clamps
inline const Vector3 rigid_y_directions[] = {''' + ', '.join('{' + ', '.join(f'{x:g}' for x in d) + '}' for d in DIRECTIONS) + '''};

/// About x, y and z
inline const RigidY rigid_y[] = {''')
    for axis in range(3):
        x = solve(axis)
        force, moment = x[:9].reshape(3, 3), x[9:18].reshape(3, 3)
        print(f'    {{{vector(x[18:21])},')
        print('     {' + ',\n      '.join(vector(f) for f in force) + '},')
        print('     {' + ',\n      '.join(vector(m) for m in moment) + '}}' + (',' if axis < 2 else '};'))
    print('''
}  // namespace verlet_cable::validation''')


if __name__ == '__main__':
    main()
