#include "sensitivity/cable_sensitivity.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "sensitivity/column_algebra.h"

namespace verlet_cable {

namespace {

/// [segment lengths] An equilibrium is no further from where the cable is.
constexpr double static_error = 1e-5;
/// [m/s] What moves faster is in no equilibrium.
constexpr double at_rest = 1e-3;
constexpr int newton_iterations = 4;

}  // namespace

CableSensitivity::CableSensitivity(int cable, const State& state, const std::vector<SensitivityColumn>& columns)
    : cable_(cable), before_(state.cables[cable]), targets_(state.cable_progress[cable].targets), scene_(state.scene) {
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
    return "it is a whole rod: it bends differently about its two axes, is curved or twisted unloaded, or remembers how it was "
           "bent";
  if (!cable.state.section_material.empty()) return "it has sections";
  if (!cable.state.flexible_fraction.empty()) return "it has stiff ends";
  if (passes_roll_on && !progress.spans.empty()) return "it is twisted between clamps";
  if (passes_roll_on && damps_bending(material) && !progress.targets.directions.empty())
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
      for (int i = 0; i < n; ++i) e.density[i] = Column(densities[i]);
      e.evaluate();
      if (is_first && !e.factor()) return "its equilibrium is not unique";
      const double size = e.solve(columns_.front().equations);
      if (!(size < allowed))
        return "it is not in equilibrium; allowed: a cable at rest, as after settle(), longer than the way between its holders";
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
    if (!is_finite(columns)) return "they are too large";
  }
  return {};
}

bool CableSensitivity::is_finite(const Columns& columns) {
  const auto is_number = [](const Column& c) {
    return std::all_of(std::begin(c.slope), std::end(c.slope), [](double slope) { return std::isfinite(slope); });
  };
  const auto are_numbers = [&](const ColumnVector& v) { return is_number(v.x) && is_number(v.y) && is_number(v.z); };
  return std::all_of(columns.positions.begin(), columns.positions.end(), are_numbers) &&
         std::all_of(columns.velocities.begin(), columns.velocities.end(), are_numbers) &&
         std::all_of(columns.tensions.begin(), columns.tensions.end(), is_number) &&
         std::all_of(columns.wrenches.begin(), columns.wrenches.end(),
                     [&](const Wrench& wrench) { return are_numbers(wrench.force) && are_numbers(wrench.torque); });
}

std::string CableSensitivity::changed(const State& state) const {
  const SimulatedCable& cable = state.cables[cable_];
  const CableState &now = cable.state, &before = before_.state;
  const KinematicTargets& targets = state.cable_progress[cable_].targets;
  const auto is_same = [](const auto& a, const auto& b) { return a.attachment == b.attachment && a.node == b.node; };
  const auto are_same = [&](const auto& a, const auto& b) { return std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same); };
  const bool is_as_it_was = cable.model == before_.model && scene_ == state.scene && now.positions == before.positions &&
                            now.velocities == before.velocities && now.accelerations == before.accelerations &&
                            now.rest_lengths == before.rest_lengths && now.masses == before.masses &&
                            are_same(targets.nodes, targets_.nodes) && are_same(targets.directions, targets_.directions);
  return is_as_it_was ? "" : "it was edited or tuned, or the world was settled";
}

std::string CableSensitivity::begin_step(const State& state) {
  std::string problem = changed(state);
  if (!problem.empty()) return problem;
  before_ = state.cables[cable_];
  targets_ = state.cable_progress[cable_].targets;
  if (before_.state.unresolved.damped > 0) return "a substep damps motion that is too fast for the time step";
  return unsupported(cable_, state);
}

std::string CableSensitivity::end_step(const State& state) {
  for (Columns& columns : columns_) {
    const std::string problem = follow(state, columns_.front(), columns);
    if (!problem.empty()) return problem;
    if (!is_finite(columns)) return "they are too large";
  }
  before_ = state.cables[cable_];
  targets_ = state.cable_progress[cable_].targets;
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
