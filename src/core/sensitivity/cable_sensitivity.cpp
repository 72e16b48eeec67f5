#include "sensitivity/cable_sensitivity.h"

#include <algorithm>
#include <cmath>

#include "law/drag.h"
#include "law/length_rate.h"
#include "rod/material_frames.h"
#include "rod/substep.h"
#include "rod/unresolved_motion.h"

namespace verlet_cable {

namespace {

using Kind = SensitivityColumn::Kind;

/// [segment lengths] An equilibrium is no further from where the cable is, and a step's solution from what it has found.
constexpr double static_error = 1e-4;
constexpr double step_error = 1e-6;
/// [m/s] What moves faster is in no equilibrium.
constexpr double at_rest = 1e-3;
/// [segment lengths a step] Velocities that are retraced are those of the state up to this.
constexpr double velocity_error = 1e-6;
/// [m] Holders are where their attachments want them.
constexpr double holder_error = 1e-9;
/// [m/s] As of frames that start: see follow_aims.
constexpr double fastest_start = 50;
/// Of the impulses that start a cable with its holders: see project_velocities.
constexpr double start_regularisation = 1e-12;
constexpr int newton_iterations = 4;
constexpr double standard_gravity = 9.81;

Column column(double value) {
  return Column(value);
}

/// v with Column's rules: a number times a vector.
ColumnVector times(double a, const ColumnVector& v) {
  return {a * v.x, a * v.y, a * v.z};
}

void add_slope(int k, const Vector3& slope, ColumnVector& v) {
  v.x.slope[k] += slope.x();
  v.y.slope[k] += slope.y();
  v.z.slope[k] += slope.z();
}

/// Impulses over length along the segments that end all change of their lengths: see CableStepper::project. `rates`: of half of
/// their squares.
std::vector<Column> impulses_of(const std::vector<ColumnVector>& directions, const std::vector<Column>& rates,
                                const std::vector<Column>& mobility, const std::vector<char>& unmoved, double regularisation) {
  const int n = static_cast<int>(directions.size());
  std::vector<Column> diagonal(n), off(n), x(n);
  for (int i = 0; i < n; ++i) {
    diagonal[i] = length_rate_diagonal(dot(directions[i], directions[i]), mobility[i] + mobility[i + 1], regularisation);
    if (i + 1 < n) off[i] = length_rate_coupling(dot(directions[i], directions[i + 1]), mobility[i + 1]);
    x[i] = rates[i];
    if (unmoved[i] == 0) continue;
    diagonal[i] = 1;
    x[i] = 0;
  }
  for (int i = 1; i < n; ++i) {
    const Column ratio = off[i - 1] / diagonal[i - 1];
    diagonal[i] -= ratio * off[i - 1];
    x[i] -= ratio * x[i - 1];
  }
  for (int i = n - 1; i >= 0; --i) x[i] = (i + 1 < n ? x[i] - off[i] * x[i + 1] : x[i]) / diagonal[i];
  return x;
}

/// As the function of the same name of numbers.
Column losing_share(const Column& known, const Column& along, const Column& square) {
  if (known.value + along.value >= square.value) return 1;
  const Column inside = along * along + 4 * square * known;
  if (inside.value <= 0) return 0;
  const Column both = root(inside);
  return along.value < 0 ? 2 * known / (both - along) : (along + both) / (2 * square);
}

/// See kinematic_targets.cpp.
ColumnVector velocity_at_end(const ColumnVector& start, const ColumnVector& mean, const ColumnVector& headed) {
  const Vector3 reach = values_of(start) - values_of(mean), change = values_of(headed) - values_of(mean);
  if (!(change.norm() > reach.norm())) return headed;
  if (reach.isZero(0)) return mean;
  return mean + (norm(start - mean) / norm(headed - mean)) * (headed - mean);
}

double greatest_difference(const std::vector<ColumnVector>& a, const std::vector<Vector3>& b) {
  double greatest = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    const double difference = (values_of(a[i]) - b[i]).norm();
    if (!(difference <= greatest)) greatest = difference;
  }
  return greatest;
}

bool is_damped(const MaterialDesc& material) {
  return material.bending_damping > 0;
}

bool bends(const MaterialDesc& material) {
  return material.bending_stiffness.largest() > 0 || is_damped(material);
}

bool stretches(const MaterialDesc& material) {
  return material.axial_stiffness < infinity;
}

}  // namespace

CableSensitivity::CableSensitivity(int cable, const State& state, const std::vector<SensitivityColumn>& columns)
    : cable_(cable), count_(static_cast<int>(columns.size())) {
  const CableState& of_cable = state.cables[cable].state;
  const int n = of_cable.segments();
  for (std::size_t first = 0; first < columns.size(); first += columns_at_once) {
    Columns some;
    const std::size_t last = std::min(columns.size(), first + columns_at_once);
    some.parameters.assign(columns.begin() + static_cast<std::ptrdiff_t>(first),
                           columns.begin() + static_cast<std::ptrdiff_t>(last));
    for (std::vector<ColumnVector>* vectors :
         {&some.positions, &some.velocities, &some.accelerations, &some.changes, &some.turns})
      vectors->assign(n + 1, zero_vector<Column>());
    for (std::vector<Column>* numbers : {&some.multipliers, &some.last_tensions, &some.tensions}) numbers->assign(n, Column());
    const std::size_t held = state.cable_progress[cable].targets.nodes.size();
    some.holder_velocities.assign(held, zero_vector<Column>());
    some.holder_means.assign(held, zero_vector<Column>());
    columns_.push_back(std::move(some));
  }
}

std::string CableSensitivity::unsupported(int index, const State& state) {
  const SimulatedCable& cable = state.cables[index];
  const CableProgress& progress = state.cable_progress[index];
  const MaterialDesc& material = cable.model->material;
  const bool passes_roll_on = material.torsional_stiffness > 0 || material.torsional_damping > 0;
  if (!cable.state.directors.empty())
    return "it is a whole rod (as stiff about one axis as about the other it is not, or it is curved or twisted unloaded, or "
           "remembers how it was bent)";
  if (!cable.state.section_material.empty()) return "it has sections";
  if (!cable.state.flexible_fraction.empty()) return "it has stiff ends";
  if (passes_roll_on && !progress.spans.empty()) return "it is twisted between clamps";
  if (passes_roll_on && is_damped(material) && !progress.targets.directions.empty())
    return "clamps turn it about its axis, against its bending_damping";
  if (progress.drive) return "a winch or a joint winds it";
  for (const KinematicTarget& target : progress.targets.nodes) {
    if (target.slides) return "it slides through a guide";
    if (state.attachments[target.attachment].holder >= 0) return "a body or a junction holds it";
  }
  if (progress.targets.nodes.empty()) return "nothing holds it";
  if (state.scene->fluid.density > 0) return "it is in water (fluid: density)";
  if (state.scene->gravity.type != GravityDesc::Type::uniform) return "gravity is not the same everywhere";
  return {};
}

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

void CableSensitivity::take_values(const CableState& state, Columns& columns) const {
  for (int i = 0; i < state.nodes(); ++i) {
    set_values(state.positions[i], columns.positions[i]);
    set_values(state.velocities[i], columns.velocities[i]);
    set_values(state.accelerations[i], columns.accelerations[i]);
    set_values(state.unresolved.acceleration_changes[i], columns.changes[i]);
    set_values(state.unresolved.turns[i], columns.turns[i]);
  }
  for (int i = 0; i < state.segments(); ++i) {
    columns.multipliers[i].value = state.axial_multiplier[i];
    columns.last_tensions[i].value = state.last_tension[i];
    columns.tensions[i].value = state.tension[i];
  }
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
    const Column load = std::max(state.scene->gravity.acceleration.norm(), standard_gravity) * mass +
                        numbers.bending_stiffness / (length * length) + applied;
    const Column stiffness = stiffness_of_taut(substep, cable.state) / load.value * load;
    for (int i = targets.nodes.front().node; i < targets.nodes.back().node; ++i) {
      const Column& rest = numbers.rest_lengths[i];
      e.segments[i].compliance = rest * rest * rest / stiffness;
    }
  }
  set_clamps(state, numbers, targets, h, is_static, columns);
  e.is_damped = !is_static && is_damped(material);
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

std::string CableSensitivity::settle(const State& state) {
  const SimulatedCable& cable = state.cables[cable_];
  const CableState& of_cable = cable.state;
  const KinematicTargets& targets = state.cable_progress[cable_].targets;
  const int n = of_cable.segments();
  for (const Vector3& velocity : of_cable.velocities)
    if (!(velocity.norm() < at_rest)) return "it moves; allowed: a cable at rest, as after settle()";
  const double allowed = static_error * *std::min_element(of_cable.rest_lengths.begin(), of_cable.rest_lengths.end());
  std::vector<Vector3> places = of_cable.positions;
  std::vector<double> densities(n);
  for (int i = 0; i < n; ++i) {
    const double length = stretches(cable.model->material) ? (places[i + 1] - places[i]).norm() : of_cable.rest_lengths[i];
    densities[i] = of_cable.axial_multiplier[i] / length;
  }
  for (Columns& columns : columns_) {
    take_values(of_cable, columns);
    const Numbers numbers = numbers_of(columns, state);
    PlainEquations& e = columns.equations;
    const bool is_first = &columns == &columns_.front();
    for (int iteration = 0;; ++iteration) {
      for (int i = 0; i <= n; ++i) columns.positions[i] = constant(places[i]);
      for (const KinematicTarget& target : targets.nodes)
        columns.positions[target.node] = wanted_place(columns, state, target, places[target.node]);
      set_equations(state, numbers, targets, 1, true, columns);
      e.displacement.assign(n + 1, zero_vector<Column>());
      e.density.resize(n);
      for (int i = 0; i < n; ++i) e.density[i] = column(densities[i]);
      if (is_first) {
        e.evaluate();
        if (!e.factor()) return "its equilibrium is not unique";
      }
      const double size = e.solve(columns_.front().equations);
      if (!(size < allowed)) return "it is not in equilibrium; allowed: a cable at rest, as after settle()";
      if (!is_first || iteration == newton_iterations) break;
      for (int i = 0; i <= n; ++i) places[i] += e.correction()[i];
      for (int i = 0; i < n; ++i) densities[i] += e.density_correction()[i];
    }
    for (int i = 0; i <= n; ++i) columns.positions[i] = columns.positions[i] + e.displacement[i];
    for (int i = 0; i < n; ++i) e.start[i] = columns.positions[i + 1] - columns.positions[i];
    e.displacement.assign(n + 1, zero_vector<Column>());
    e.evaluate();
    for (int i = 0; i < n; ++i) {
      columns.multipliers[i] = e.density[i] * e.mean_length[i];
      columns.tensions[i] = columns.last_tensions[i] = columns.multipliers[i] + e.force_along[i];
    }
    set_wrenches(state, e.residual(), targets, columns);
  }
  return {};
}

std::string CableSensitivity::begin_step(const State& state) {
  const SimulatedCable& cable = state.cables[cable_];
  const CableState& now = cable.state;
  if (has_begun_ && (cable.model != before_.model || scene_ != state.scene || now.positions != before_.state.positions ||
                     now.velocities != before_.state.velocities || now.rest_lengths != before_.state.rest_lengths))
    return "it was edited or tuned, or the world has settled";
  before_ = cable;
  scene_ = state.scene;
  targets_ = state.cable_progress[cable_].targets;
  if (now.unresolved.damped > 0) return "a substep damps motion that is too fast for the time step";
  return unsupported(cable_, state);
}

std::string CableSensitivity::end_step(const State& state) {
  for (Columns& columns : columns_) {
    const std::string problem = follow(state, columns_.front(), columns);
    if (!problem.empty()) return problem;
  }
  before_ = state.cables[cable_];
  has_begun_ = true;
  return {};
}

std::string CableSensitivity::follow(const State& state, Columns& first, Columns& columns) {
  const CableState &before = before_.state, &after = state.cables[cable_].state;
  const MaterialDesc& material = before_.model->material;
  const KinematicTargets& targets_after = state.cable_progress[cable_].targets;
  const int n = before.segments();
  const double h = state.scene->time_step;
  if (after.segments() != n || targets_after.nodes.size() != targets_.nodes.size() ||
      targets_after.directions.size() != targets_.directions.size())
    return "it was edited";
  if (after.yielding > 0) return "it is drawn straight by its holders (overstretched)";
  const Numbers numbers = numbers_of(columns, state);
  take_values(before, columns);
  // What holds it
  std::vector<ColumnVector> wanted, velocities_of_holders, means;
  bool starts = false;
  for (std::size_t k = 0; k < targets_.nodes.size(); ++k) {
    const KinematicTarget& target = targets_.nodes[k];
    const Attachment& attachment = state.attachments[target.attachment];
    if (targets_after.nodes[k].jumping_steps > 0) return "its holder jumps";
    wanted.push_back(wanted_place(columns, state, target, after.positions[target.node]));
    const Vector3 own = (state.frames.poses[attachment.frame] * attachment.pose).position;
    if (target.node == attachment.node && !((own - after.positions[target.node]).norm() < holder_error))
      return "it is still brought to its holder";
    set_values(target.velocity, columns.holder_velocities[k]);
    set_values(target.mean_velocity, columns.holder_means[k]);
    means.push_back(times(1 / h, wanted.back() - columns.positions[target.node]));
    if (!target.starts) continue;
    starts = true;
    if (values_of(means.back()).norm() <= fastest_start) columns.holder_velocities[k] = columns.holder_means[k] = means.back();
  }
  for (std::size_t k = 0; k < targets_.directions.size(); ++k) {
    const Attachment& attachment = state.attachments[targets_.directions[k].attachment];
    const Quaternion own = (state.frames.poses[attachment.frame] * attachment.pose).orientation;
    const Vector3 difference = (own * Vector3::UnitX()) - (targets_after.directions[k].orientation * Vector3::UnitX());
    if (!(difference.norm() < holder_error)) return "it is still brought to its clamp";
  }
  std::vector<Column> mobility(n + 1);
  for (int i = 0; i <= n; ++i) mobility[i] = 1.0 / numbers.masses[i];
  for (const KinematicTarget& target : targets_.nodes) mobility[target.node] = 0;
  const auto project = [&](const std::vector<ColumnVector>& directions, double regularisation,
                           std::vector<ColumnVector>& velocities) {
    std::vector<Column> rates(n);
    std::vector<char> unmoved(n, 0);
    for (int i = 0; i < n; ++i) {
      rates[i] = dot(directions[i], velocities[i] - velocities[i + 1]);
      unmoved[i] = mobility[i].value == 0 && mobility[i + 1].value == 0 ? 1 : 0;
    }
    return impulses_of(directions, rates, mobility, unmoved, regularisation);
  };
  const auto impulse_on = [&](int node, const std::vector<ColumnVector>& directions, const std::vector<Column>& impulses) {
    ColumnVector impulse = zero_vector<Column>();
    if (node > 0) impulse = impulse + impulses[node - 1] * directions[node - 1];
    if (node < n) impulse = impulse - impulses[node] * directions[node];
    return impulse;
  };
  std::vector<ColumnVector> segments(n);
  if (starts) {
    for (std::size_t k = 0; k < wanted.size(); ++k) columns.velocities[targets_.nodes[k].node] = columns.holder_velocities[k];
    if (!stretches(material)) {
      for (int i = 0; i < n; ++i) segments[i] = columns.positions[i + 1] - columns.positions[i];
      const std::vector<Column> impulses = project(segments, start_regularisation, columns.velocities);
      for (int i = 0; i <= n; ++i)
        columns.velocities[i] = columns.velocities[i] + mobility[i] * impulse_on(i, segments, impulses);
    }
  }
  for (std::size_t k = 0; k < wanted.size(); ++k)
    velocities_of_holders.push_back(
        velocity_at_end(columns.holder_velocities[k], means[k], means[k] + times(0.5, means[k] - columns.holder_means[k])));
  // The step's solution
  set_equations(state, numbers, targets_, h, false, columns);
  PlainEquations& e = columns.equations;
  e.displacement.resize(n + 1);
  e.density.resize(n);
  for (int i = 0; i <= n; ++i) e.displacement[i] = constant(after.positions[i] - before.positions[i]);
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const int node = targets_.nodes[k].node;
    e.displacement[node] = wanted[k] - columns.positions[node];
  }
  for (int i = 0; i < n; ++i) {
    if (e.fixed_density[i] != 0) {
      e.density[i] = columns.multipliers[i] / numbers.rest_lengths[i];
      continue;
    }
    double length = before.rest_lengths[i];
    if (stretches(material))
      length =
          0.5 * ((before.positions[i + 1] - before.positions[i]).norm() + (after.positions[i + 1] - after.positions[i]).norm());
    e.density[i] = column(after.axial_multiplier[i] / length);
  }
  const double shortest = *std::min_element(before.rest_lengths.begin(), before.rest_lengths.end());
  if (&columns == &first) {
    e.evaluate();
    if (!e.factor()) return "the step's equations have no unique solution";
  }
  const double tolerated = step_error + 100 * state.scene->tolerance * std::min(h, longest_tolerated);
  if (!(e.solve(first.equations) < tolerated * shortest)) return "something acts on it that derivatives do not know of";
  // Velocities at the end
  const std::vector<ColumnVector> u = e.displacement;
  std::vector<ColumnVector> velocities(n + 1);
  for (int i = 0; i <= n; ++i) velocities[i] = times(2 / h, u[i]) - columns.velocities[i];
  for (std::size_t k = 0; k < wanted.size(); ++k) velocities[targets_.nodes[k].node] = velocities_of_holders[k];
  for (int i = 0; i < n; ++i) segments[i] = e.start[i] + e.change_of(i);
  std::vector<ColumnVector> forces(n + 1, zero_vector<Column>());  // on holders
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const int i = targets_.nodes[k].node;
    const Column& mass = numbers.masses[i];
    forces[i] = e.residual()[i] + mass * times(2 / h, times(1 / h, u[i]) - columns.velocities[i]) -
                mass * times(1 / h, velocities[i] - columns.velocities[i]);
  }
  Boundary boundary;
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    HeldNode held;
    held.node = targets_.nodes[k].node;
    held.velocity = values_of(velocities_of_holders[k]);
    boundary.nodes.push_back(held);
  }
  CableState started = before;
  for (int i = 0; i <= n; ++i) started.velocities[i] = values_of(columns.velocities[i]);
  std::vector<TwistSpan> spans;
  const Environment environment{state.scene->gravity, state.scene->fluid, no_waves};
  const Substep substep{*before_.model, environment, boundary, spans, h};
  if (!stretches(material) && holders_accelerate(substep, started)) {
    std::vector<Column> impulses = project(segments, length_rate_regularisation, velocities);
    Column ended, along, known;
    for (int i = 0; i < n; ++i) ended += impulses[i] * dot(segments[i], velocities[i] - velocities[i + 1]);
    along = ended;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const int i = targets_.nodes[k].node;
      const ColumnVector &start = columns.velocities[i], &end = velocities[i], mean = times(1 / h, u[i]);
      along += dot(impulse_on(i, segments, impulses), end - mean);
      known -= numbers.masses[i] * dot(end - start, times(0.5, start + end) - mean);
    }
    if (known.value < 0) known = 0;
    const Column share = losing_share(known, along, 0.5 * ended);
    for (Column& impulse : impulses) impulse = share * impulse;
    for (int i = 0; i <= n; ++i) {
      const ColumnVector impulse = impulse_on(i, segments, impulses);
      velocities[i] = velocities[i] + mobility[i] * impulse;
      if (e.movable[i] == 0) forces[i] = forces[i] + times(1 / h, impulse);
    }
  }
  const std::vector<Column> start_multipliers = columns.multipliers;
  columns.holder_velocities = velocities_of_holders;
  columns.holder_means = means;
  const double known = known_part(before.unresolved);
  MotionSums sums;
  for (int i = 0; i <= n; ++i) {
    const ColumnVector acceleration = times(1 / h, velocities[i] - columns.velocities[i]);
    const ColumnVector change = acceleration - columns.accelerations[i];
    const ColumnVector turn = times(known, change - columns.changes[i]);
    const double weight = e.movable[i] * before.masses[i];
    const Vector3 now = values_of(turn), last = values_of(columns.turns[i]);
    sums.product += weight * now.dot(last);
    sums.square += 0.5 * weight * (now.squaredNorm() + last.squaredNorm());
    sums.mass += weight;
    columns.positions[i] = columns.positions[i] + u[i];
    columns.velocities[i] = velocities[i];
    columns.accelerations[i] = acceleration;
    columns.changes[i] = change;
    columns.turns[i] = turn;
  }
  const bool watched = state.scene->numerical_damping, smooths = watched && before.unresolved.known > 0;
  for (int i = 0; i < n; ++i) {
    columns.multipliers[i] = e.density[i] * e.mean_length[i];
    const Column tension = bends(material) ? columns.multipliers[i] + e.force_along[i] : columns.multipliers[i];
    columns.tensions[i] = smooths ? 0.5 * (columns.last_tensions[i] + tension) : tension;
    columns.last_tensions[i] = tension;
  }
  if (watched) {
    UnresolvedMotion motion = before.unresolved;
    if (is_unresolved(Treatment::cleaning, sums, motion)) {
      const std::string problem = clean(numbers, start_multipliers, h, forces, columns);
      if (!problem.empty()) return problem;
    }
  } else {
    columns.changes.assign(n + 1, zero_vector<Column>());
    columns.turns.assign(n + 1, zero_vector<Column>());
  }
  if (!(greatest_difference(columns.velocities, after.velocities) < velocity_error * shortest / h))
    return "its velocities are changed in a way that derivatives do not know of";
  set_wrenches(state, forces, targets_, columns);
  return {};
}

void CableSensitivity::set_wrenches(const State& state, const std::vector<ColumnVector>& forces, const KinematicTargets& targets,
                                    Columns& columns) const {
  columns.wrenches.clear();
  const auto wrench_of = [&](int attachment) -> Wrench& {
    for (Wrench& wrench : columns.wrenches)
      if (wrench.attachment == attachment) return wrench;
    columns.wrenches.push_back({attachment, zero_vector<Column>(), zero_vector<Column>()});
    return columns.wrenches.back();
  };
  const PlainEquations& e = columns.equations;
  const auto own_place = [&](const KinematicTarget& target) -> const ColumnVector* {
    const int node = state.attachments[target.attachment].node;
    return node == target.node ? nullptr : &columns.positions[node];
  };
  for (const KinematicTarget& target : targets.nodes) {
    Wrench& wrench = wrench_of(target.attachment);
    wrench.force = wrench.force + forces[target.node];
    if (const ColumnVector* place = own_place(target))
      wrench.torque = wrench.torque + cross(columns.positions[target.node] - *place, forces[target.node]);
  }
  for (std::size_t k = 0; k < e.clamps.size(); ++k) {
    Wrench& wrench = wrench_of(targets.directions[e.clamps[k].direction].attachment);
    wrench.torque = wrench.torque + e.clamp_bends[k].torque;
  }
}

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
  constexpr int per_node = 4, density_place = 3;
  BandMatrix matrix;
  matrix.assign(per_node * (n + 1), 2 * per_node + 2);
  const auto add = [&](int row, int column, double value) {
    for (int k = 0; k < 3; ++k) matrix.at(per_node * row + k, per_node * column + k) += value;
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
    const int row = per_node * i + density_place;
    for (int k = 0; k < 3; ++k) {
      matrix.at(per_node * i + k, row) += d[k];
      matrix.at(per_node * (i + 1) + k, row) -= d[k];
      matrix.at(row, per_node * i + k) += d[k];
      matrix.at(row, per_node * (i + 1) + k) -= d[k];
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
    for (int k = 0; k < 3 && e.movable[i] == 0; ++k) fix(per_node * i + k);
  for (int i = 0; i < n; ++i)
    if (e.fixed_density[i] != 0) fix(per_node * i + density_place);
  fix(per_node * n + density_place);
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
        put(per_node * i, lacking[i].x);
        put(per_node * i + 1, lacking[i].y);
        put(per_node * i + 2, lacking[i].z);
      }
      if (i < n && e.fixed_density[i] == 0) put(per_node * i + density_place, lacking_rows[i]);
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
      take(per_node * i, resolved[i].x);
      take(per_node * i + 1, resolved[i].y);
      take(per_node * i + 2, resolved[i].z);
      if (i < n) take(per_node * i + density_place, multiplier[i]);
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

template <class Number>
void CableSensitivity::read(int rows, const Number& number, double* to) const {
  for (int row = 0; row < rows; ++row)
    for (const Columns& columns : columns_)
      for (std::size_t k = 0; k < columns.parameters.size(); ++k) *to++ = number(columns, row).slope[k];
}

namespace {

const Column& component(const ColumnVector& v, int k) {
  return k == 0 ? v.x : k == 1 ? v.y : v.z;
}

}  // namespace

void CableSensitivity::read_positions(double* to) const {
  const int nodes = static_cast<int>(columns_.front().positions.size());
  read(
      3 * nodes, [](const Columns& c, int row) { return component(c.positions[row / 3], row % 3); }, to);
}

void CableSensitivity::read_velocities(double* to) const {
  const int nodes = static_cast<int>(columns_.front().positions.size());
  read(
      3 * nodes, [](const Columns& c, int row) { return component(c.velocities[row / 3], row % 3); }, to);
}

void CableSensitivity::read_tension(double* to) const {
  const int segments = static_cast<int>(columns_.front().tensions.size());
  read(
      segments, [](const Columns& c, int row) { return c.tensions[row]; }, to);
}

void CableSensitivity::read_wrench(int attachment, double* to) const {
  read(
      6,
      [attachment](const Columns& c, int row) {
        for (const Wrench& wrench : c.wrenches)
          if (wrench.attachment == attachment) return component(row < 3 ? wrench.force : wrench.torque, row % 3);
        return Column();
      },
      to);
}

}  // namespace verlet_cable
