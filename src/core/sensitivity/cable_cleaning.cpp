#include <algorithm>

#include "sensitivity/band_matrix.h"
#include "sensitivity/cable_sensitivity.h"
#include "sensitivity/column_algebra.h"

namespace verlet_cable {

/// What alternates from step to step is taken out of the velocities: see MotionCleaner and CableStepper::take_out_unresolved.
/// `forces`: on holders, which feel it, too.
std::string CableSensitivity::clean(const Numbers& numbers, const std::vector<Column>& start_multipliers, double h,
                                    std::vector<ColumnVector>& forces, Columns& columns) const {
  const MaterialDesc& material = before_.model->material;
  const PlainEquations& e = columns.equations;
  const int n = static_cast<int>(e.start.size());
  const std::vector<ColumnVector> ways = e.displacement;
  std::vector<ColumnVector> segments(n), alternating(n + 1);
  std::vector<Column> stiffness(n), compliance(n), gap(n), joint_stiffness(n + 1);
  for (int i = 0; i <= n; ++i) alternating[i] = times(0.25 * h * e.movable[i], columns.turns[i]);
  for (int i = 0; i < n; ++i) {
    segments[i] = columns.positions[i + 1] - columns.positions[i];
    const Column length = stretches(material) ? norm(segments[i]) : numbers.rest_lengths[i];
    const Column now = columns.multipliers[i] / length, mean = 0.5 * (start_multipliers[i] / length + now);
    if (mean.value > 0) stiffness[i] = 0.5 * mean;
    compliance[i] = stretching(e.segments[i], segments[i], zero_vector<Column>(), now, 0.5).row.compliance;
    if (!stretches(material))
      gap[i] = -1.0 * dot(segments[i], columns.velocities[i + 1] - columns.velocities[i] - alternating[i + 1] + alternating[i]);
  }
  for (int i = 1; i < n; ++i) {
    const PlainJoint<Column>& joint = e.joints[i];
    const ColumnVector bent = bend_of(joint, segments[i - 1], segments[i]);
    const Bend<Column> bend = joint_bend(joint, bent, zero_vector<Column>(), Column(), 0.5);
    joint_stiffness[i] = 0.5 * bend.slope + joint.damping;
  }
  for (const PlainClamp<Column>& clamp : e.clamps)
    stiffness[clamp.segment] += clamp_bend(clamp, segments[clamp.segment], zero_vector<Column>(), 0.5).stiffness;
  // The part that is resolved, and the multipliers that go with it
  std::vector<ColumnVector> resolved(n + 1, zero_vector<Column>()), lacking(n + 1);
  std::vector<Column> multiplier(n), lacking_rows(n);
  const auto evaluate = [&] {
    std::vector<ColumnVector> force(n, zero_vector<Column>());
    for (int i = 0; i < n; ++i) {
      const ColumnVector change = resolved[i + 1] - resolved[i];
      force[i] = force[i] + stiffness[i] * change + multiplier[i] * segments[i];
      lacking_rows[i] = gap[i] - (dot(segments[i], change) - compliance[i] * multiplier[i]);
      if (i == 0) continue;
      const PlainJoint<Column>& joint = e.joints[i];
      const ColumnVector moment = joint_stiffness[i] * bend_of(joint, resolved[i] - resolved[i - 1], change);
      force[i] = force[i] + joint.inverse_after * moment;
      force[i - 1] = force[i - 1] - joint.inverse_before * moment;
    }
    for (int i = 0; i <= n; ++i) {
      lacking[i] = e.inertia[i] * (alternating[i] - resolved[i]);
      if (i < n) lacking[i] = lacking[i] + force[i];
      if (i > 0) lacking[i] = lacking[i] - force[i - 1];
    }
  };
  BandMatrix matrix;
  matrix.assign(unknowns_a_node * (n + 1), coupling_reach);
  const auto add = [&](int row, int column, double value) {
    for (int k = 0; k < 3; ++k) matrix.at(unknowns_a_node * row + k, unknowns_a_node * column + k) += value;
  };
  const auto add_bend = [&](int row, int i, double factor) {
    const PlainJoint<Column>& joint = e.joints[i];
    const double before = joint.inverse_before.value, after = joint.inverse_after.value;
    const double moment = factor * joint_stiffness[i].value;
    add(row, i - 1, moment * before);
    add(row, i, -moment * (before + after));
    add(row, i + 1, moment * after);
  };
  for (int i = 0; i <= n; ++i) add(i, i, -e.inertia[i].value);
  for (int i = 0; i < n; ++i) {
    const double s = stiffness[i].value;
    add(i, i, -s);
    add(i, i + 1, s);
    add(i + 1, i, s);
    add(i + 1, i + 1, -s);
    const Vector3 d = values_of(segments[i]);
    const int row = unknowns_a_node * i + density_place;
    for (int k = 0; k < 3; ++k) {
      matrix.at(unknowns_a_node * i + k, row) += d[k];
      matrix.at(unknowns_a_node * (i + 1) + k, row) -= d[k];
      matrix.at(row, unknowns_a_node * i + k) += d[k];
      matrix.at(row, unknowns_a_node * (i + 1) + k) -= d[k];
    }
    matrix.at(row, row) += compliance[i].value;
    if (i == 0) continue;
    const double before = e.joints[i].inverse_before.value, after = e.joints[i].inverse_after.value;
    add_bend(i - 1, i, -before);
    add_bend(i, i, before + after);
    add_bend(i + 1, i, -after);
  }
  const auto fix = [&matrix](int row) {
    matrix.clear_row(row);
    matrix.at(row, row) = 1;
  };
  for (int i = 0; i <= n; ++i)
    for (int k = 0; k < 3 && e.movable[i] == 0; ++k) fix(unknowns_a_node * i + k);
  for (int i = 0; i < n; ++i)
    if (e.fixed_density[i] != 0) fix(unknowns_a_node * i + density_place);
  fix(unknowns_a_node * n + density_place);
  if (!matrix.factor()) return "the equations of its numerical damping have no unique solution";
  constexpr int width = columns_at_once + 1;
  std::vector<double> right;
  // First the numbers, then, with them, their derivatives.
  for (const bool numbers_only : {true, false}) {
    evaluate();
    right.assign(static_cast<std::size_t>(matrix.rows()) * width, 0.0);
    const auto put = [&](int row, const Column& from) {
      for (int k = 0; k < columns_at_once; ++k) right[row * width + k] = -from.slope[k];
      right[row * width + columns_at_once] = -from.value;
    };
    for (int i = 0; i <= n; ++i) {
      if (e.movable[i] != 0) {
        put(unknowns_a_node * i, lacking[i].x);
        put(unknowns_a_node * i + 1, lacking[i].y);
        put(unknowns_a_node * i + 2, lacking[i].z);
      }
      if (i < n && e.fixed_density[i] == 0) put(unknowns_a_node * i + density_place, lacking_rows[i]);
    }
    matrix.solve(right.data(), width);
    const auto take = [&](int row, Column& to) {
      if (numbers_only) {
        to.value += right[row * width + columns_at_once];
        return;
      }
      for (int k = 0; k < columns_at_once; ++k) to.slope[k] += right[row * width + k];
    };
    for (int i = 0; i <= n; ++i) {
      take(unknowns_a_node * i, resolved[i].x);
      take(unknowns_a_node * i + 1, resolved[i].y);
      take(unknowns_a_node * i + 2, resolved[i].z);
      if (i < n) take(unknowns_a_node * i + density_place, multiplier[i]);
    }
  }
  evaluate();
  Column along, square;
  for (int i = 0; i <= n; ++i) {
    alternating[i] = alternating[i] - resolved[i];
    along += numbers.masses[i] * dot(alternating[i], columns.velocities[i]);
    square += 0.5 * numbers.masses[i] * dot(alternating[i], alternating[i]);
    if (e.movable[i] == 0) along -= 0.5 * h * dot(lacking[i], ways[i]);
  }
  const Column share = losing_share(0, along, square);
  for (int i = 0; i <= n; ++i) {
    const ColumnVector taken = share * alternating[i];
    columns.velocities[i] = columns.velocities[i] - taken;
    columns.accelerations[i] = columns.accelerations[i] - times(2 / h, taken);
    columns.changes[i] = columns.changes[i] - times(4 / h, taken);
    columns.turns[i] = columns.turns[i] - times(4 / h, taken);
    if (e.movable[i] == 0) forces[i] = forces[i] + 0.5 * h * share * lacking[i];
  }
  return {};
}

}  // namespace verlet_cable
