#include <algorithm>
#include <cmath>

#include "law/drag.h"
#include "rod/material_frames.h"
#include "rod/substep.h"
#include "sensitivity/cable_sensitivity.h"
#include "sensitivity/column_algebra.h"

namespace verlet_cable {

namespace {

using Kind = SensitivityColumn::Kind;

constexpr double standard_gravity = 9.81;  // see weight_of_taut

}  // namespace

template <class Change>
void CableSensitivity::each_column(const Columns& columns, Kind kind, const Change& change) const {
  for (std::size_t k = 0; k < columns.parameters.size(); ++k)
    if (columns.parameters[k].kind == kind && (columns.parameters[k].cable < 0 || columns.parameters[k].cable == cable_))
      change(static_cast<int>(k), columns.parameters[k]);
}

CableSensitivity::Numbers CableSensitivity::numbers_of(const Columns& columns, const State& state) const {
  const SimulatedCable& cable = state.cables[cable_];
  const MaterialDesc& material = cable.model->material;
  const CableState& of_cable = cable.state;
  const int n = of_cable.segments();
  Numbers numbers;
  const auto set = [&](Kind kind, double value, Column& number) {
    number = value;
    each_column(columns, kind, [&](int k, const SensitivityColumn&) { number.slope[k] = 1; });
  };
  if (stretches(material)) set(Kind::axial_stiffness, material.axial_stiffness, numbers.axial_stiffness);
  set(Kind::axial_damping, material.axial_damping, numbers.axial_damping);
  set(Kind::bending_stiffness, material.bending_stiffness.largest(), numbers.bending_stiffness);
  set(Kind::bending_damping, material.bending_damping, numbers.bending_damping);
  set(Kind::drag, material.drag, numbers.drag);
  numbers.gravity = constant(state.scene->gravity.acceleration);
  each_column(columns, Kind::gravity,
              [&](int k, const SensitivityColumn& c) { add_slope(k, Vector3::Unit(c.axis), numbers.gravity); });
  numbers.wind = constant(state.scene->fluid.velocity);
  const double length = of_cable.length();
  for (const double rest : of_cable.rest_lengths) {
    numbers.rest_lengths.emplace_back(rest);
    each_column(columns, Kind::length,
                [&](int k, const SensitivityColumn&) { numbers.rest_lengths.back().slope[k] = rest / length; });
  }
  for (int i = 0; i <= n; ++i) {
    const double around = 0.5 * ((i > 0 ? of_cable.rest_lengths[i - 1] : 0) + (i < n ? of_cable.rest_lengths[i] : 0));
    numbers.masses.emplace_back(of_cable.masses[i]);
    Column& mass = numbers.masses.back();
    each_column(columns, Kind::linear_density, [&](int k, const SensitivityColumn&) { mass.slope[k] = around; });
    each_column(columns, Kind::length,
                [&](int k, const SensitivityColumn&) { mass.slope[k] = material.linear_density * around / length; });
  }
  return numbers;
}

ColumnVector CableSensitivity::wanted_place(const Columns& columns, const State& state, const KinematicTarget& target,
                                            const Vector3& place) const {
  const Attachment& attachment = state.attachments[target.attachment];
  const Pose& frame = state.frames.poses[attachment.frame];
  ColumnVector wanted = constant(place);
  const auto is_its_frame = [&](const SensitivityColumn& c) { return c.frame == attachment.frame; };
  each_column(columns, Kind::translation, [&](int k, const SensitivityColumn& c) {
    if (is_its_frame(c)) add_slope(k, Vector3::Unit(c.axis), wanted);
  });
  each_column(columns, Kind::rotation, [&](int k, const SensitivityColumn& c) {
    if (is_its_frame(c)) add_slope(k, Vector3::Unit(c.axis).cross(place - frame.position), wanted);
  });
  // A clamp of a chain holds the nodes beside its own, too.
  if (target.node != attachment.node)
    each_column(columns, Kind::length, [&](int k, const SensitivityColumn&) {
      add_slope(k, (place - (frame * attachment.pose).position) / state.cables[cable_].state.length(), wanted);
    });
  return wanted;
}

ColumnVector CableSensitivity::wanted_axis(const Columns& columns, const State& state, const DirectionTarget& target,
                                           const Quaternion& orientation) const {
  const Attachment& attachment = state.attachments[target.attachment];
  const Vector3 axis = orientation * Vector3::UnitX();
  ColumnVector wanted = constant(axis);
  each_column(columns, Kind::rotation, [&](int k, const SensitivityColumn& c) {
    if (c.frame == attachment.frame) add_slope(k, Vector3::Unit(c.axis).cross(axis), wanted);
  });
  return wanted;
}

void CableSensitivity::set_equations(const State& state, const Numbers& numbers, const KinematicTargets& targets, double h,
                                     bool is_static, Columns& columns) const {
  const SimulatedCable& cable = state.cables[cable_];
  const MaterialDesc& material = cable.model->material;
  const int n = cable.state.segments();
  PlainEquations& e = columns.equations;
  e.is_static = is_static;
  e.part = is_static ? 1 : 0.5;
  e.movable.assign(n + 1, 1);
  e.fixed_density.assign(n, 0);
  for (const KinematicTarget& target : targets.nodes) e.movable[target.node] = 0;
  e.segments.resize(n);
  e.joints.assign(n + 1, {});
  e.inertia.resize(n + 1);
  e.load.resize(n + 1);
  e.start.resize(n);
  const double rate = is_static ? 0 : 1 / h;
  for (int i = 0; i < n; ++i) {
    e.start[i] = columns.positions[i + 1] - columns.positions[i];
    PlainSegment<Column>& segment = e.segments[i];
    segment.is_elastic = stretches(material);
    segment.rest_length = numbers.rest_lengths[i];
    segment.axial_stiffness = numbers.axial_stiffness;
    segment.axial_damping = rate * numbers.axial_damping;
    segment.compliance = 0;
    if (!segment.is_elastic && e.movable[i] == 0 && e.movable[i + 1] == 0) e.fixed_density[i] = 1;
  }
  for (int i = 0; i <= n; ++i) {
    Column around;
    if (i > 0) around += 0.5 * numbers.rest_lengths[i - 1];
    if (i < n) around += 0.5 * numbers.rest_lengths[i];
    const LinearDrag<Column> drag{numbers.drag * around, numbers.wind, rate};
    const Column inertia = is_static ? Column() : (2 * rate) * numbers.masses[i];
    e.inertia[i] = rate * inertia + drag.resistance();
    e.load[i] = numbers.masses[i] * numbers.gravity + drag.load();
    if (!is_static) e.load[i] = e.load[i] + inertia * columns.velocities[i];
    if (i == 0 || i == n || !bends(material)) continue;
    PlainJoint<Column>& joint = e.joints[i];
    joint.inverse_before = 1.0 / numbers.rest_lengths[i - 1];
    joint.inverse_after = 1.0 / numbers.rest_lengths[i];
    joint.stiffness = numbers.bending_stiffness / around;
    joint.damping = rate * numbers.bending_damping / around;
  }
  double applied = 0;
  for (const Load& load : state.loads) {
    if (load.body != cable_id(cable_)) continue;
    e.load[load.node] = e.load[load.node] + constant(load.force);
    if (e.movable[load.node] != 0) applied += load.force.norm();
  }
  if (targets.nodes.size() > 1 && !stretches(material)) {
    // What it would weigh is a part of the stiffness of a chain that is pulled straight; see stiffness_of_taut.
    Boundary boundary = boundary_now(targets);
    for (const Load& load : state.loads)
      if (load.body == cable_id(cable_)) boundary.loads.push_back({load.node, load.force});
    std::vector<TwistSpan> spans;
    const Environment environment{state.scene->gravity, state.scene->fluid, no_waves};
    const Substep substep{*cable.model, environment, boundary, spans, h, is_static};
    Column mass, length;
    for (const Column& m : numbers.masses) mass += m;
    for (const Column& rest : numbers.rest_lengths) length += rest;
    const Column gravity = norm(numbers.gravity);
    const Column weight = (gravity.value > standard_gravity ? gravity : Column(standard_gravity)) * mass;
    const Column load = weight + numbers.bending_stiffness / (length * length) + applied;
    const Column stiffness = stiffness_of_taut(substep, cable.state) / load.value * load;
    for (int i = targets.nodes.front().node; i < targets.nodes.back().node; ++i) {
      const Column& rest = numbers.rest_lengths[i];
      e.segments[i].compliance = rest * rest * rest / stiffness;
    }
  }
  set_clamps(state, numbers, targets, h, is_static, columns);
  e.is_damped = !is_static && damps_bending(material);
  if (e.is_damped) set_spin(numbers, h, columns);
}

void CableSensitivity::set_clamps(const State& state, const Numbers& numbers, const KinematicTargets& targets, double h,
                                  bool is_static, Columns& columns) const {
  const int n = state.cables[cable_].state.segments();
  PlainEquations& e = columns.equations;
  e.clamps.clear();
  const KinematicTargets& now = state.cable_progress[cable_].targets;
  for (std::size_t k = 0; k < targets.directions.size(); ++k) {
    const DirectionTarget& target = targets.directions[k];
    e.joints[target.node] = {};
    for (const int i : {target.node - 1, target.node}) {
      if (i < 0 || i >= n) continue;
      PlainClamp<Column> clamp;
      clamp.direction = static_cast<int>(k);
      clamp.segment = i;
      clamp.is_elastic = e.segments[i].is_elastic;
      clamp.inverse_length = 1.0 / numbers.rest_lengths[i];
      const Column joint = 2.0 * clamp.inverse_length;
      clamp.stiffness = numbers.bending_stiffness * joint;
      clamp.damping = is_static ? Column() : (1 / h) * numbers.bending_damping * joint;
      clamp.start_axis = wanted_axis(columns, state, target, target.orientation);
      clamp.end_axis = wanted_axis(columns, state, target, now.directions[k].orientation);
      e.clamps.push_back(clamp);
    }
  }
}

/// How the material of joints turns: see MaterialSpin, of a cable that clamps do not turn.
void CableSensitivity::set_spin(const Numbers& numbers, double h, Columns& columns) const {
  PlainEquations& e = columns.equations;
  const int n = static_cast<int>(e.start.size());
  std::vector<ColumnVector> directions(n), rates(n);
  for (int i = 0; i < n; ++i) {
    const Column inverse = 1.0 / norm(e.start[i]);
    const ColumnVector velocity = columns.velocities[i + 1] - columns.velocities[i];
    const ColumnVector mean = velocity - times(0.5 * h, columns.accelerations[i + 1] - columns.accelerations[i]);
    directions[i] = inverse * e.start[i];
    const ColumnVector rate = inverse * mean;
    rates[i] = rate - dot(directions[i], rate) * directions[i];
  }
  std::vector<Column> own(n);
  Column square, along;
  for (int i = 1; i < n; ++i) {
    Column cosine = 1.0 + dot(directions[i - 1], directions[i]);
    if (cosine.value < smallest_turn) cosine = smallest_turn;
    const ColumnVector half_binormal = (1.0 / cosine) * cross(directions[i - 1], directions[i]);
    own[i] = own[i - 1] - dot(half_binormal, rates[i - 1] + rates[i]);
    const ColumnVector turned = root(2.0 * cosine) * half_binormal;
    const Column& damping = e.joints[i].damping;
    square += damping * dot(turned, turned);
    along += damping * dot(turned, rates[i] - rates[i - 1] - 0.5 * (own[i - 1] + own[i]) * turned);
  }
  const Column common = square.value > 0 ? along / square : Column();
  for (int i = 1; i < n; ++i) {
    PlainJoint<Column>& joint = e.joints[i];
    if (joint.damping.value == 0) continue;
    const ColumnVector bend = (1.0 / numbers.rest_lengths[i]) * e.start[i] - (1.0 / numbers.rest_lengths[i - 1]) * e.start[i - 1];
    const ColumnVector turn = cross(normalized(e.start[i - 1] + e.start[i]), bend);
    joint.turned = h * (0.5 * (own[i - 1] + own[i]) + common) * turn;
  }
}

}  // namespace verlet_cable
