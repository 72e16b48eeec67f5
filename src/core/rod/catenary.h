#pragma once

#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Static equilibrium of a chain of straight links between two points: `lengths` [m] at rest (n), `weights` of its inner nodes
/// [N] (n - 1), `down` the direction of gravity, `axial_stiffness` [N] (n, or one for all),
/// infinite for rigid links. Node positions (n + 1). Where
/// the points are as far apart as a rigid chain is long, or further: a straight line.
std::vector<Vector3> hanging_chain(const Vector3& from, const Vector3& to, const std::vector<double>& lengths,
                                   const std::vector<double>& weights, const Vector3& down,
                                   const std::vector<double>& axial_stiffness);

}  // namespace verlet_cable
