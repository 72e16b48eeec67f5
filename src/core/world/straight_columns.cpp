#include "world/straight_columns.h"

#include <algorithm>
#include <cmath>

#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

constexpr double straightness = 1e-8;  // of a segment
constexpr double disturbance = 1e-4;   // of a segment, in a step

/// A cable between two of its holders.
struct Span {
  const KinematicTarget &from, &to;
  const SimulatedCable& cable;
  int first() const { return from.node; }
  int last() const { return to.node; }
  double length() const { return cable.state.length(first(), last()); }
  Vector3 reach() const { return cable.state.positions[last()] - cable.state.positions[first()]; }
};

/// [rad^2] Of the first mode between ends of which so many are clamped: the load is that times EI / l^2.
double buckling_number(int clamps) {
  return M_PI * M_PI * (clamps == 0 ? 1 : clamps == 1 ? 2.0457 : 4);
}

bool is_compressed(const Span& span, double force) {
  const std::vector<double>& tension = span.cable.state.tension;
  return std::all_of(tension.begin() + span.first(), tension.begin() + span.last(), [force](double t) { return t < -force; });
}

bool is_overloaded(const Span& span, const std::vector<DirectionTarget>& clamps) {
  if (!is_compressed(span, 0)) return false;
  const auto count = std::count_if(clamps.begin(), clamps.end(), [&](const DirectionTarget& clamp) {
    return clamp.node == span.first() || clamp.node == span.last();
  });
  const double length = span.length();
  return is_compressed(span, buckling_number(static_cast<int>(count)) * CableMaterials(span.cable).largest_bending_stiffness() /
                                 (length * length));
}

bool is_straight(const Span& span) {
  const std::vector<Vector3>& positions = span.cable.state.positions;
  const Vector3 direction = span.reach().normalized();
  for (int i = span.first() + 1; i < span.last(); ++i) {
    const Vector3 from_start = positions[i] - positions[span.first()];
    const double aside = (from_start - direction.dot(from_start) * direction).norm();
    if (aside > straightness * span.cable.state.rest_lengths[i]) return false;
  }
  return true;
}

Vector3 next_place(const KinematicTarget& holder, const State& state) {
  const Attachment& attachment = state.attachments[holder.attachment];
  return (state.frames.poses[attachment.frame] * attachment.pose).position;
}

/// [m] By which frames push the ends together in this step.
double shortening(const Span& span, const State& state) {
  const auto is_on_body = [&](const KinematicTarget& holder) { return state.attachments[holder.attachment].holder >= 0; };
  if (is_on_body(span.from) || is_on_body(span.to)) return 0;
  return span.reach().norm() - (next_place(span.to, state) - next_place(span.from, state)).norm();
}

/// [m] How far the middle is to go aside in this step; 0: nowhere.
double deflection(const Span& span, const std::vector<DirectionTarget>& clamps, const State& state) {
  if (span.last() - span.first() < 2) return 0;
  if (CableMaterials(span.cable).any_elastic_between(span.first(), span.last()))
    return is_overloaded(span, clamps) ? disturbance * span.length() / (span.last() - span.first()) : 0;
  // An arc of half a sine wave is longer than its chord l by pi^2 a^2 / (4 l).
  const double length = span.length(), less = shortening(span, state);
  return less > straightness * length ? 2 / M_PI * std::sqrt(length * less) : 0;
}

}  // namespace

void disturb_straight_columns(State& state) {
  for (std::size_t index = 0; index < state.cables.size(); ++index) {
    const KinematicTargets& targets = state.cable_progress[index].targets;
    for (std::size_t k = 0; k + 1 < targets.nodes.size(); ++k) {
      const Span span{targets.nodes[k], targets.nodes[k + 1], state.cables[index]};
      const double aside = deflection(span, targets.directions, state);
      if (aside == 0 || !is_straight(span)) continue;
      const Vector3 velocity = aside / state.scene->time_step * span.reach().unitOrthogonal();
      std::vector<Vector3>& velocities = state.cables[index].state.velocities;
      for (int i = span.first() + 1; i < span.last(); ++i)
        velocities[i] += std::sin(M_PI * static_cast<double>(i - span.first()) / (span.last() - span.first())) * velocity;
    }
  }
}

}  // namespace verlet_cable
