#include "rod/substep.h"

#include <algorithm>
#include <numeric>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Of a free cable nothing but the solution keeps the angular momentum: so much of the tolerance is allowed.
constexpr double free_part = 0.1;
/// [1/s] Of what stands: errors times the stiffness are loads that would set it moving.
constexpr double static_velocity_tolerance = 1e-8;
/// A matrix that is kept does not make corrections shrink faster than this for long, however fast the first one shrank.
constexpr double fastest_convergence = 0.03;
/// Of the weight.
constexpr double taut_stiffness = 1e7;
/// Of the inertia in a substep, where bodies give way.
constexpr double taut_inertia = 1e3;
constexpr double standard_gravity = 9.81;
/// A holder's change of velocity that moves a node by less in a substep, in segment lengths, goes unnoticed.
constexpr double noticed_jerk = 1e-9;

}  // namespace

Convergence::Convergence(const Substep& s)
    : Convergence(s.boundary.nodes.empty() ? free_part * s.tolerance : s.tolerance, s.h, s.statics) {}

Convergence::Convergence(double tolerance, double h, bool statics)
    : tolerance_((statics ? static_velocity_tolerance : tolerance) * std::min(h, longest_tolerated)) {}

bool Convergence::is_reached(double size) {
  ratio_ = last_ > 0 ? size / last_ : 1;
  last_ = size;
  // The next correction would be about the last one times the ratio of the last two.
  return size * std::clamp(ratio_, fastest_convergence, 1.0) < tolerance_;
}

double stiffness_of_taut(const Substep& s, const CableState& state) {
  const double own = std::accumulate(state.masses.begin(), state.masses.end(), 0.0);
  const double mass = s.boundary.is_on_bodies() ? s.boundary.joined_mass : own;
  const double length = state.length();
  const double weight = std::max(s.environment.gravity.at(state.positions[0]).norm(), standard_gravity) * mass;
  double inertia = 0;
  if (s.boundary.is_on_bodies()) inertia = taut_inertia * s.inertia() * mass * length / (s.h * s.h);
  return inertia + taut_stiffness * (weight + CableMaterials(s.model, state).largest_bending_stiffness() / (length * length));
}

bool holders_accelerate(const Substep& s, const CableState& state) {
  const double noticed = noticed_jerk * state.rest_lengths[0] / s.h;
  return std::any_of(s.boundary.nodes.begin(), s.boundary.nodes.end(), [&](const HeldNode& target) {
    return target.body < 0 && (target.velocity - state.velocities[target.node]).squaredNorm() > noticed * noticed;
  });
}

}  // namespace verlet_cable
