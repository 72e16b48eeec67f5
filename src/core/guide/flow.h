#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What is given of a cable's way through a guide at a substep, and what the substep finds.
struct GuidedFlow {
  int first = 0, last = 0;  ///< the held nodes at which the cable comes to the guide and leaves it: of an eyelet the same
  double friction = 0;      ///< Coulomb coefficient
  double inertia = 0;       ///< [kg] that moves with the cable besides its own: of a wheel
  double resistance = 0;    ///< [N] that does not depend on the tension: of a bearing
  double grip = infinity;   ///< Coulomb coefficient between cable and wheel: the bearing resists no more than that holds
  bool is_blocked[2] = {false, false};  ///< whether no more material can come from before, from after
  double rate = 0;                      ///< [m/s] of rest length, from before to after; in: at the start, out: at the end
  double acceleration = 0;              ///< [m/s^2] in and out: mean over the last substep
  double held_energy = 0;               ///< [J] of passed nodes, see SimulatedGuide
  double held_way = 0;                  ///< [m] in and out: that has flowed since
  double held_length = 1;               ///< [m] over which it is given back
};

/// From one to another by a part of the way.
inline double mean(double a, double b, double part) {
  return a + part * (b - a);
}
inline std::array<double, 2> mean(const std::array<double, 2>& a, const std::array<double, 2>& b, double part) {
  return {mean(a[0], b[0], part), mean(a[1], b[1], part)};
}

/// Whether something holds a flow.
inline bool resists(const GuidedFlow& flow) {
  return flow.friction > 0 || flow.resistance > 0 || flow.is_blocked[0] || flow.is_blocked[1];
}

/// [m] Of rest length, that flows as one through a guide: half of the segments beside it, and what lies on it.
inline double flowing_length(const std::vector<double>& rest_lengths, int first, int last) {
  double length = 0.5 * (rest_lengths[first - 1] + rest_lengths[last]);
  for (int i = first; i < last; ++i) length += rest_lengths[i];
  return length;
}

/// Which part is left of what a guide holds after a part of the way over which it gives that back: its force does not jump.
inline double held_part(double part) {
  const double left = 1 - std::min(part * part, 1.0);
  return left * left;
}

/// Changes of the loads on the nodes around a guide, from that before the segment before it on [N].
using FlowColumn = std::array<Vector3, 6>;

/// A flow while a substep is solved for it. Its way is one more unknown; the equation of motion of what flows, with the
/// generalised forces of the cable's energy, is one more equation:
///   mass (2 / h) (way / h - rate) = T_after - T_before + gravity + friction
/// What is against it is a function of the way that rises, and never of another sign: against a flow forward where it goes on to
/// the end of the substep, against one backward where it does so, and nothing between where it turns round. At either end of that
/// the flow stops with any force from nothing to the whole one; where it stood at the start both ends are the same.
struct Flow {
  enum class Mode { free, forward, stops_forward, turns, stops_backward, backward };
  int first = 0, last = 0;    // held nodes
  int before = 0, after = 0;  // the segments that shrink and grow
  Mode mode = Mode::free;
  bool changed = false;                      // whether the mode did in this iteration
  int changes = 0;                           // of the mode, in the substep
  double density = 0;                        // [kg/m] of what flows: the segments beside a guide are of one material
  double mass = 0;                           // [kg]
  double drag = 0;                           // [N s/m]
  double resistance = 0;                     // [N] of what is against a flow forward, in the present iterate
  double rate = 0;                           // [m/s] at the start
  double acceleration = 0;                   // [m/s^2] over the substep before
  std::array<double, 2> start_length{0, 0};  // [m] at rest, of the segments before and after
  std::array<double, 2> stretch{1, 1};       // of target lengths
  Vector3 velocity = Vector3::Zero();        // [m/s] of the guide, mean
  Vector3 velocity_change = Vector3::Zero();
  bool moves = false;     // whether a body holds the guide, whose motion is found with the cable's
  double way = 0;         // the unknown [m]
  double correction = 0;  // of it [m]
  // Its row of the matrix: for the multipliers of the two segments and for the way
  std::array<double, 2> row{0, 0};
  double diagonal = 0;
  std::array<double, 2> gap{0, 0};  // its column: in the rows of the two segments
  /// Of the nodes, where the cable bends; but for friction the same in its row
  FlowColumn column{};
  FlowColumn rubbing{};  // what friction takes of that in the row
  int first_node() const { return before - 1; }
};

inline bool is_stopped(const Flow& flow) {
  return flow.mode == Flow::Mode::stops_forward || flow.mode == Flow::Mode::stops_backward;
}

/// Whether something is against it.
inline bool is_resisted(const Flow& flow) {
  return flow.mode != Flow::Mode::free && flow.mode != Flow::Mode::turns;
}

}  // namespace verlet_cable
