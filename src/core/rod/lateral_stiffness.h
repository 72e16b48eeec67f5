#pragma once

#include <algorithm>
#include <vector>

#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// A straight part of a cable between two held nodes.
struct StraightSpan {
  int first = 0, last = 0;                                 ///< nodes
  bool clamped_at_first = false, clamped_at_last = false;  ///< directions are held there

  int segments() const { return last - first; }
};

/// What a straight span opposes to small displacements across it, by its bending stiffness (the smaller one) and by its tension:
///   E = sum over joints of EI / (2 l) e^2 + sum over segments of T / (2 l) (w' - w)^2,
/// e being the change of direction. Where its smallest eigenvalue is below zero the span buckles (Euler, De curvis elasticis,
/// 1744).
class LateralStiffness {
 public:
  /// `tension`: a segment of the span [N].
  LateralStiffness(const CableModel& model, const CableState& state, const StraightSpan& span,
                   const std::vector<double>& tension);

  bool is_stable() { return factor(rounding_); }
  /// Whether no shape grows by a factor of more than e in a time [s].
  bool is_stable_for(double time) { return factor(std::max(rounding_, 1 / (time * time))); }
  /// Across the span, of an unstable one: nodes of the span, first and last too, which are 0; of what grows, most of what grows
  /// fastest. Its size is arbitrary.
  std::vector<double> growing_shape();

 private:
  void add_joint(int node, double stiffness, double before, double after);
  void add(int i, int j, double value);
  bool factor(double shift);
  double largest_shift() const;
  void solve(std::vector<double>& load) const;

  double rounding_ = 0;                               // [1/s^2] of an eigenvalue: what just stands, stands
  int unknowns_;                                      // inner nodes of the span
  std::vector<double> masses_;                        // [kg]
  std::vector<double> diagonal_, next_, second_;      // of the matrix: row i, and between i and i + 1, i + 2 [N/m]
  std::vector<double> pivot_, lower_, lower_second_;  // of its factors
};

}  // namespace verlet_cable
