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
/// Less of its length is as good as straight.
constexpr double straight_slack = 1e-4;
constexpr double standard_gravity = 9.81;
/// Of the weight.
constexpr double overstretched_stiffness = 1e4;
constexpr double greatest_load = 1e3;
constexpr double greatest_velocity = 30;  // [m/s]
constexpr double greatest_growth = 10;
/// More than its length is what bodies have drawn out.
constexpr double drawn_stretch = 1e-4;
/// [m/s] At which what bodies have drawn out is drawn in again, once they let it.
constexpr double recovery_velocity = 1;
/// Of the time in which something falls by the length of the cable, about.
constexpr double warning_time = 0.05;
/// A holder's change of velocity that moves a node by less in a substep, in segment lengths, goes unnoticed.
constexpr double noticed_jerk = 1e-9;

/// Whether of any part of what cannot stretch, between holders one of which is a body, this is so.
template <typename Predicate>
bool any_on_bodies(const Substep& s, const CableState& state, Predicate is_so) {
  const CableMaterials materials(s.model, state);
  const std::vector<HeldNode>& held = s.boundary.nodes;
  for (std::size_t k = 0; k + 1 < held.size(); ++k) {
    const int first = held[k].node, last = held[k + 1].node;
    if ((held[k].body < 0 && held[k + 1].body < 0) || materials.any_elastic_between(first, last)) continue;
    if (is_so((state.positions[last] - state.positions[first]).norm(), state.length(first, last))) return true;
  }
  return false;
}

/// [kg]
double mass_of_taut(const Substep& s, const CableState& state) {
  return s.boundary.is_on_bodies() ? s.boundary.joined_mass : std::accumulate(state.masses.begin(), state.masses.end(), 0.0);
}

/// [N]
double weight_of_taut(const Substep& s, const CableState& state) {
  return std::max(s.environment.gravity.at(state.positions[0]).norm(), standard_gravity) * mass_of_taut(s, state);
}

/// [N] The weight, what acts from outside on nodes that move, and what bends the cable.
double load_of_taut(const Substep& s, const CableState& state) {
  const double length = state.length();
  double load = weight_of_taut(s, state) + CableMaterials(s.model, state).largest_bending_stiffness() / (length * length);
  const std::vector<HeldNode>& held = s.boundary.nodes;
  for (const NodeLoad& applied : s.boundary.loads)
    if (std::none_of(held.begin(), held.end(), [&](const HeldNode& target) { return target.node == applied.node; }))
      load += applied.force.norm();
  return load;
}

}  // namespace

DrawnOut Substep::drawn_out() const {
  DrawnOut drawn_out;
  if (!gives_in_on_bodies) drawn_out.drawn_in = recovery_velocity * h;
  drawn_out.is_reported = gives_in_on_bodies;
  return drawn_out;
}

Convergence::Convergence(const Substep& s)
    : Convergence(s.boundary.nodes.empty() ? free_part * s.tolerance : s.tolerance, s.h, s.statics) {}

Convergence::Convergence(double tolerance, double h, bool statics)
    : tolerance_((statics ? static_velocity_tolerance : tolerance) * std::min(h, longest_tolerated)) {}

bool Convergence::is_reached(double size) {
  ratio_ = last_ > 0 ? size / last_ : 1;
  last_ = size;
  // The next correction would be about the last one times the ratio of the last two.
  return size * left() < tolerance_;
}

double Convergence::left() const {
  return std::clamp(ratio_, fastest_convergence, 1.0);
}

double stiffness_of_taut(const Substep& s, const CableState& state) {
  double inertia = 0;
  if (s.boundary.is_on_bodies()) inertia = taut_inertia * s.inertia() * mass_of_taut(s, state) * state.length() / (s.h * s.h);
  return inertia + taut_stiffness * load_of_taut(s, state);
}

YieldingAhead yielding_ahead(const Substep& s, const CableState& state) {
  if (s.statics) return {};
  const double gravity = std::max(s.environment.gravity.at(state.positions[0]).norm(), standard_gravity);
  return {warning_time * std::sqrt(state.length() / gravity), s.h};
}

bool is_overstretched(const Substep& s, const CableState& state) {
  return any_overstretched(s.model, state, s.boundary, yielding_ahead(s, state));
}

double compliance_of(const OverstretchedSpan& span, const Substep& s, const CableState& state) {
  // Tension is the length times its multiplier, which strains half of the square of the length.
  return span.share * (1 + span.strain) * (1 + 0.5 * span.strain) / (overstretched_stiffness * weight_of_taut(s, state));
}

bool is_drawn_out_on_bodies(const Substep& s, const CableState& state) {
  return any_on_bodies(s, state, [](double distance, double length) { return distance > (1 + drawn_stretch) * length; });
}

double stiffness_of_overstretched(const Substep& s, const CableState& state) {
  return overstretched_stiffness * load_of_taut(s, state);
}

double greatest_tension_on_bodies(const Substep& s, const CableState& state) {
  const double before = is_drawn_out_on_bodies(s, state) ? 0 : *std::max_element(state.tension.begin(), state.tension.end());
  return greatest_growth * before + greatest_load * load_of_taut(s, state) + mass_of_taut(s, state) * greatest_velocity / s.h;
}

bool is_straight_on_bodies(const Substep& s, const CableState& state) {
  return any_on_bodies(s, state, [](double distance, double length) { return distance > (1 - straight_slack) * length; });
}

bool holders_accelerate(const Substep& s, const CableState& state) {
  const double noticed = noticed_jerk * state.rest_lengths[0] / s.h;
  return std::any_of(s.boundary.nodes.begin(), s.boundary.nodes.end(), [&](const HeldNode& target) {
    return target.body < 0 && (target.velocity - state.velocities[target.node]).squaredNorm() > noticed * noticed;
  });
}

}  // namespace verlet_cable
