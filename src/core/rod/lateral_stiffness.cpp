#include "rod/lateral_stiffness.h"

#include <algorithm>
#include <cmath>

#include "rod/joint_material.h"

namespace verlet_cable {

namespace {

constexpr int bisections = 40;
/// Of what tension does to a single node.
constexpr double rounding_of_stiffness = 1e-9;
/// The shift of the matrix, as a multiple of the one at which it is just positive: modes that grow slowly have their part, too.
constexpr double beyond_singular = 1.5;

}  // namespace

LateralStiffness::LateralStiffness(const CableModel& model, const CableState& state, const StraightSpan& span,
                                   const std::vector<double>& tension)
    : unknowns_(span.segments() - 1), masses_(state.masses.begin() + span.first + 1, state.masses.begin() + span.last) {
  for (std::vector<double>* a : {&diagonal_, &next_, &second_, &pivot_, &lower_, &lower_second_}) a->assign(unknowns_, 0.0);
  const CableMaterials materials(model, state);
  for (int k = 0; k < span.segments(); ++k) {
    const double stiffness = tension[k] / state.rest_lengths[span.first + k];
    add(k - 1, k - 1, stiffness);
    add(k, k, stiffness);
    add(k - 1, k, -stiffness);
    rounding_ =
        std::max(rounding_, rounding_of_stiffness * std::abs(stiffness) / state.masses[std::max(span.first + k, span.first + 1)]);
  }
  for (int i = span.first + 1; i < span.last; ++i) {
    const double before = state.rest_lengths[i - 1], after = state.rest_lengths[i];
    const double stiffness = joint_material(materials, state, i).bending_stiffness.smallest();
    add_joint(i - span.first - 1, stiffness / state.bending_length(i, 0.5 * (before + after)), 1 / before, 1 / after);
  }
  const auto stiffness_at_clamp = [&](int node, int segment) {
    return materials[segment].bending_stiffness.smallest() / state.bending_length(node, 0.5 * state.rest_lengths[segment]);
  };
  if (span.clamped_at_first) add_joint(-1, stiffness_at_clamp(span.first, span.first), 0, 1 / state.rest_lengths[span.first]);
  if (span.clamped_at_last)
    add_joint(unknowns_, stiffness_at_clamp(span.last, span.last - 1), 1 / state.rest_lengths[span.last - 1], 0);
}

/// Stiffness [N m] against e = after (w_(i+1) - w_i) - before (w_i - w_(i-1)).
void LateralStiffness::add_joint(int i, double stiffness, double before, double after) {
  const double weights[] = {before, -before - after, after};
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) add(i - 1 + a, i - 1 + b, stiffness * weights[a] * weights[b]);
}

/// To the entry of the nodes i <= j, unless one is held.
void LateralStiffness::add(int i, int j, double value) {
  if (i < 0 || j >= unknowns_) return;
  (j == i ? diagonal_ : j == i + 1 ? next_ : second_)[i] += value;
}

/// Of the matrix plus `shift` [1/s^2] times the masses; whether it is positive definite.
bool LateralStiffness::factor(double shift) {
  for (int i = 0; i < unknowns_; ++i) {
    double pivot = diagonal_[i] + shift * masses_[i], next = next_[i];
    if (i > 0) {
      pivot -= lower_[i - 1] * lower_[i - 1] * pivot_[i - 1];
      next -= lower_[i - 1] * lower_second_[i - 1] * pivot_[i - 1];
    }
    if (i > 1) pivot -= lower_second_[i - 2] * lower_second_[i - 2] * pivot_[i - 2];
    if (!(pivot > 0)) return false;
    pivot_[i] = pivot;
    lower_[i] = next / pivot;
    lower_second_[i] = second_[i] / pivot;
  }
  return true;
}

/// [1/s^2] After Gershgorin: with it the matrix is positive definite.
double LateralStiffness::largest_shift() const {
  double largest = 0;
  for (int i = 0; i < unknowns_; ++i) {
    double beside = std::abs(next_[i]) + std::abs(second_[i]);
    if (i > 0) beside += std::abs(next_[i - 1]);
    if (i > 1) beside += std::abs(second_[i - 2]);
    largest = std::max(largest, (beside - diagonal_[i]) / masses_[i]);
  }
  return largest;
}

void LateralStiffness::solve(std::vector<double>& x) const {
  for (int i = 0; i < unknowns_; ++i) {
    if (i > 0) x[i] -= lower_[i - 1] * x[i - 1];
    if (i > 1) x[i] -= lower_second_[i - 2] * x[i - 2];
  }
  for (int i = unknowns_; i-- > 0;) {
    x[i] /= pivot_[i];
    if (i + 1 < unknowns_) x[i] -= lower_[i] * x[i + 1];
    if (i + 2 < unknowns_) x[i] -= lower_second_[i] * x[i + 2];
  }
}

std::vector<double> LateralStiffness::growing_shape() {
  double from = 0, to = 2 * largest_shift();
  for (int i = 0; i < bisections; ++i) {
    const double middle = 0.5 * (from + to);
    (factor(middle) ? to : from) = middle;
  }
  factor(beyond_singular * to);
  std::vector<double> shape = masses_;
  solve(shape);
  shape.insert(shape.begin(), 0);
  shape.push_back(0);
  return shape;
}

}  // namespace verlet_cable
