#pragma once

#include <vector>

#include "geometry/vector_array.h"
#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// How the material of a cable without frames spins about its segments' directions, one a segment [rad/s]: it twists as under one
/// torque between clamps that pass their roll on, not at all beyond them. Where there are none it spins as it has to bend least:
/// bending that only turns with the material is not damped. `segment`: [m]; `damping`: what resists bending, a node; `h`: the
/// substep [s].
void find_material_spin(const CableModel& model, const CableState& state, const VectorArray& segment,
                        const std::vector<HeldDirection>& directions, const std::vector<double>& damping, double h,
                        std::vector<double>& spin);

/// Of a direction that is held [rad/s], about itself.
double spin_of(const HeldDirection& target, double h);

/// The rate [1/s] at which e, the change of direction at a node, turns with the material.
inline Vector3 turning_rate(const Vector3& before, const Vector3& after, double spin, const Vector3& e) {
  return spin * (before + after).normalized().cross(e);
}

}  // namespace verlet_cable
