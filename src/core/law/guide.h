#pragma once

#include <cmath>

#include "law/resistance.h"
#include "law/stretch.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// An elastic segment that material flows into or out of, at the start and the end of a substep [m].
struct FlowingLength {
  double start_rest = 0, rest = 0;      ///< at rest
  double start_length = 0, length = 0;  ///< as it is strained
};

/// What it does to the nodes and to what flows.
struct DrawnLength {
  LengthRow<double> row;  ///< that gives it its tension
  double force = 0;       ///< [N] with which it draws what flows
  double strain = 0;      ///< where forces are taken
  double slope = 0;       ///< [N/m] by which more rest length at the end lessens its tension
};

/// With lengths s, rest lengths l and strains e = s / l - 1 at the start and (') the end, means over the substep (-), the energy
/// EA l e^2 / 2 changes by
///   T (s' - s) - F (l' - l),   T = EA e- l-^2 / (l l'),   F = T s- / l- - EA (e^2)- / 2,
/// exactly: T pulls the nodes, F the flow. A tension from s- and a mean of 1 / l would be another one with the way, even of
/// material that is strained alike everywhere. `resistance`: EA [N], and what damps the strain over the time of the substep;
/// `density`: the segment's multiplier [N/m]; `part`: where in the substep forces are taken, 1/2 or 1.
inline DrawnLength draw(const Resistance<double>& resistance, const FlowingLength& flowing, double density, double part) {
  const auto mean = [part](double start, double end) { return start + part * (end - start); };
  const auto& [start, end, start_length, length] = flowing;
  const double mean_length = mean(start_length, length), mean_rest = mean(start, end);
  const double strain_at_start = start_length / start - 1, strain_at_end = length / end - 1;
  const double stretching = part == 1 ? 1 : mean_rest * mean_rest / (start * end);
  const Resistance<double> law{resistance.stiffness * stretching, resistance.damping};
  const double stress = law.stress(mean(strain_at_start, strain_at_end), strain_at_end - strain_at_start);
  const double rise = law.slope(part) / end;
  DrawnLength drawn;
  drawn.row = elastic_row(stress, rise, density, mean_length, length, part);
  const double square = mean(strain_at_start * strain_at_start, strain_at_end * strain_at_end);
  drawn.force = density * mean_length * mean_length / mean_rest - 0.5 * resistance.stiffness * square;
  drawn.strain = mean(strain_at_start, strain_at_end);
  drawn.slope = rise * length / end * drawn.row.compliance / mean_length;
  return drawn;
}

/// [rad] A cable that turns by less does not turn.
constexpr double smallest_angle = 1e-6;

/// By the force with which a guide presses on a cable [N], across it: the friction of what is drawn over a round, so that
/// tensions differ by the factor exp(friction angle). With them the force is sin(angle / 2) times their sum, and friction, their
/// difference, is tanh(friction angle / 2) times that. Where the cable does not turn it is the coefficient.
inline double rubbing_part(double friction, double angle) {
  if (friction == infinity) return infinity;
  return angle > smallest_angle ? std::tanh(0.5 * friction * angle) / std::sin(0.5 * angle) : friction;
}

}  // namespace verlet_cable
