#include "world/straight_columns.h"

#include <algorithm>
#include <cmath>

#include "rod/bow.h"
#include "rod/rod_frames.h"
#include "rod/unresolved_motion.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// Of a span's length: less aside is straight, and less slack is none.
constexpr double straightness = 1e-10;
/// Of the axial stiffness: less compression is none.
constexpr double noticed_compression = 1e-9;
/// Kinetic energy, of what is stored in the compression.
constexpr double disturbance = 1e-6;
/// Of the gravity: less across the span has no direction.
constexpr double rounding_of_gravity = 1e-9;
/// Loads of less than so much of Euler's for hinges do not buckle a chain of segments, however it is held.
constexpr double surely_stable = 0.5;
constexpr int bisections = 40;
/// Of a span's length: what is pressed against something and less aside stays straight for too long.
constexpr double pressed_straightness = 1e-3;
/// Of what presses: less compression is none.
constexpr double noticed_pressure = 1e-2;
/// Of what presses: less along the column is a thing that the cable lies against.
constexpr double pressed_along = 0.7;
/// Of a segment, by which it is turned at most where its cable buckles under that.
constexpr double pressed_slope = 1e-2;
/// Of a span's length: a bow for more slack is no start for a step in which gravity pulls it aside, too.
constexpr double largest_slack_aside = 0.03;

/// A straight span of a cable, and where its ends will be.
struct Column : StraightSpan {
  Vector3 from = Vector3::Zero(), to = Vector3::Zero();  // [m]
  double length = 0;                                     // [m] at rest

  Vector3 direction() const { return (to - from).normalized(); }
  double distance() const { return (to - from).norm(); }
};

bool is_straight(const CableState& state, int first, int last, double tolerance = straightness) {
  const std::vector<Vector3>& positions = state.positions;
  const Vector3 span = positions[last] - positions[first];
  const double length = span.norm();
  if (!(length > 0)) return false;
  double along = 0;
  for (int i = first + 1; i < last; ++i) {
    const Vector3 place = positions[i] - positions[first];
    if (place.cross(span).norm() > tolerance * length * length) return false;
    const double next = place.dot(span);
    if (next <= along) return false;
    along = next;
  }
  return along < length * length;
}

bool is_clamped(int node, const KinematicTargets& targets) {
  return std::any_of(targets.directions.begin(), targets.directions.end(),
                     [node](const DirectionTarget& direction) { return direction.node == node; });
}

/// Calls `f` with each straight span between two holders that move as they are told, and are then at `place`.
template <class Place, class Function>
void for_each_column(int index, const State& state, const Place& place, const Function& f) {
  const KinematicTargets& targets = state.cable_progress[index].targets;
  const CableState& cable = state.cables[index].state;
  const auto is_told = [&](const KinematicTarget& target) {
    return state.attachments[target.attachment].holder < 0 && !target.slides;
  };
  for (std::size_t k = 0; k + 1 < targets.nodes.size(); ++k) {
    const KinematicTarget &from = targets.nodes[k], &to = targets.nodes[k + 1];
    if (to.node - from.node < 2 || !is_told(from) || !is_told(to) || !is_straight(cable, from.node, to.node)) continue;
    Column column{{from.node, to.node, is_clamped(from.node, targets), is_clamped(to.node, targets)}, place(from), place(to)};
    column.length = cable.length(from.node, to.node);
    if (column.distance() > 0) f(column);
  }
}

/// What of gravity is across a column [m/s^2]; zero where that is rounding.
Vector3 gravity_across(const Column& column, const SimulatedCable& cable, const State& state) {
  const Vector3 along = column.direction(), g = state.scene->gravity.at(cable.state.positions[column.first]);
  const Vector3 down = g - g.dot(along) * along;
  return down.norm() > rounding_of_gravity * g.norm() ? down : Vector3(Vector3::Zero());
}

/// A direction across a column: of whole rods that in which it bends most easily, else that of gravity, else any. Where there is
/// something to lie on, not down.
Vector3 across(const Column& column, const SimulatedCable& cable, const State& state) {
  const Vector3 along = column.direction(), down = gravity_across(column, cable, state);
  const bool has_down = !down.isZero(0), lies = !state.obstacles.empty();
  if (!cable.state.directors.empty()) {
    const int middle = (column.first + column.last) / 2;
    const BendingStiffness& stiffness = CableMaterials(cable)[middle].bending_stiffness;
    if (!stiffness.is_isotropic()) {
      const Vector3& director = cable.state.directors[middle];
      const Vector3 easy = stiffness[0] < stiffness[1] ? Vector3(along.cross(director)) : director;
      const Vector3 direction = (easy - easy.dot(along) * along).normalized();
      return has_down && (direction.dot(down) > 0) == lies ? Vector3(-direction) : direction;
    }
  }
  if (!has_down) return along.unitOrthogonal();
  return lies ? along.cross(down).normalized() : down.normalized();
}

/// Calls `f` with the tension [N] of each segment of a column that can stretch: in equilibrium along it, with gravity, between
/// its ends.
template <class Function>
void for_each_tension(const Column& column, const SimulatedCable& cable, const GravityDesc& gravity, const Function& f) {
  const CableMaterials materials(cable);
  const CableState& state = cable.state;
  const Vector3 along = column.direction();
  const auto weight_at = [&](int i) {
    return i > column.first ? state.masses[i] * gravity.at(state.positions[i]).dot(along) : 0;
  };
  double weight = 0, slack = column.length - column.distance(), give = 0;
  for (int i = column.first; i < column.last; ++i) {
    const double compliance = state.rest_lengths[i] / materials[i].axial_stiffness;
    weight += weight_at(i);
    slack -= weight * compliance;
    give += compliance;
  }
  double tension = -slack / give;
  for (int i = column.first; i < column.last; ++i) {
    tension -= weight_at(i);
    f(tension);
  }
}

std::vector<double> static_tension(const Column& column, const SimulatedCable& cable, const GravityDesc& gravity) {
  std::vector<double> tension;
  tension.reserve(column.segments());
  for_each_tension(column, cable, gravity, [&tension](double t) { tension.push_back(t); });
  return tension;
}

/// Whether what a column carries compresses it at all, and by more than what it surely stands.
bool is_loaded(const Column& column, const SimulatedCable& cable, const GravityDesc& gravity) {
  double load = 0;
  for_each_tension(column, cable, gravity, [&load](double tension) { load = std::max(load, -tension); });
  const CableMaterials materials(cable);
  const double compression =
      noticed_compression * materials.smallest([](const MaterialDesc& material) { return material.axial_stiffness; });
  const double bending = materials.smallest([](const MaterialDesc& material) { return material.bending_stiffness.smallest(); });
  return load > std::max(compression, surely_stable * M_PI * M_PI * bending / (column.length * column.length));
}

/// [J]
double stored_energy(const Column& column, const SimulatedCable& cable, const std::vector<double>& tension) {
  const CableMaterials materials(cable);
  double energy = 0;
  for (int k = 0; k < column.segments(); ++k) {
    const int i = column.first + k;
    energy += 0.5 * tension[k] * tension[k] * cable.state.rest_lengths[i] / materials[i].axial_stiffness;
  }
  return energy;
}

/// Sets an elastic column that buckles moving.
void disturb(const Column& column, const State& state, SimulatedCable& cable) {
  if (!is_loaded(column, cable, state.scene->gravity)) return;
  const std::vector<double> tension = static_tension(column, cable, state.scene->gravity);
  LateralStiffness stiffness(*cable.model, cable.state, column, tension);
  if (stiffness.is_stable()) return;
  const std::vector<double> shape = stiffness.growing_shape();
  double inertia = 0;
  for (int k = 0; k <= column.segments(); ++k) inertia += cable.state.masses[column.first + k] * shape[k] * shape[k];
  const double speed = std::sqrt(2 * disturbance * stored_energy(column, cable, tension) / inertia);
  const Vector3 velocity = speed * across(column, cable, state);
  for (int k = 1; k < column.segments(); ++k) cable.state.velocities[column.first + k] += shape[k] * velocity;
}

/// [m] Of a column that cannot stretch.
double slack_of(const Column& column) {
  const double slack = column.length - column.distance();
  return slack > straightness * column.length ? slack : 0;
}

/// [m/N]
double compliance(const Column& column, const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  double sum = 0;
  for (int i = column.first; i < column.last; ++i) sum += cable.state.rest_lengths[i] / materials[i].axial_stiffness;
  return sum;
}

/// [m] By which the ends of one that can are closer than where it would just not buckle.
double slack_beyond_buckling(const Column& column, const SimulatedCable& cable, const GravityDesc& gravity) {
  if (!is_loaded(column, cable, gravity)) return 0;
  const std::vector<double> tension = static_tension(column, cable, gravity);
  const auto is_stable = [&](double relief) {
    std::vector<double> relieved = tension;
    for (double& t : relieved) t += relief;
    return LateralStiffness(*cable.model, cable.state, column, relieved).is_stable();
  };
  if (is_stable(0)) return 0;
  double from = 0, to = -*std::min_element(tension.begin(), tension.end());
  for (int i = 0; i < bisections; ++i) {
    const double relief = 0.5 * (from + to);
    (is_stable(relief) ? to : from) = relief;
  }
  return to * compliance(column, cable);
}

bool can_stretch(const Column& column, const SimulatedCable& cable) {
  return CableMaterials(cable).any_elastic_between(column.first, column.last);
}

/// The motion of a cable begins anew, from where its nodes are now.
void start_anew(const std::vector<Vector3>& before, int index, State& state) {
  CableState& cable = state.cables[index].state;
  begin_anew(cable.unresolved);
  std::fill(cable.axial_multiplier.begin(), cable.axial_multiplier.end(), 0.0);
  carry_frames(before, cable);
  measure_joint_twists(state.cable_progress[index].targets.directions, cable);
}

/// Puts a column where it is, after `time` [s] of its present motion, a bow that takes `slack` [m].
void bend(const Column& column, double slack, double time, double waves, int index, State& state) {
  SimulatedCable& cable = state.cables[index];
  const std::vector<Vector3> before = cable.state.positions;
  const Bow bow = find_bow(cable.state, column, column.length - slack, waves);
  const Vector3 along = (column.to - column.from) / (column.length - slack), aside = across(column, cable, state);
  for (int k = 1; k < column.segments(); ++k) {
    const int i = column.first + k;
    cable.state.positions[i] = column.from + bow.along[k] * along + bow.across[k] * aside - time * cable.state.velocities[i];
  }
  start_anew(before, index, state);
}

/// Calls `f` with each span, almost straight, from an end that nothing holds to what holds the cable next, or to the other end,
/// and with whether it is held at its last node.
template <class Function>
void for_each_free_column(int index, const State& state, const Function& f) {
  const KinematicTargets& targets = state.cable_progress[index].targets;
  const CableState& cable = state.cables[index].state;
  const auto visit = [&](int first, int last, bool held_at_last) {
    if (last - first < 2 || !is_straight(cable, first, last, pressed_straightness)) return;
    Column column{
        {first, last, is_clamped(first, targets), is_clamped(last, targets)}, cable.positions[first], cable.positions[last]};
    column.length = cable.length(first, last);
    f(column, held_at_last);
  };
  if (targets.nodes.empty()) return visit(0, cable.segments(), false);
  visit(0, targets.nodes.front().node, true);
  visit(targets.nodes.back().node, cable.segments(), false);
}

}  // namespace

void fold(const PressedColumn& pressed, int index, State& state) {
  SimulatedCable& cable = state.cables[index];
  const std::vector<Vector3> before = cable.state.positions;
  const Column column{{pressed.first, pressed.last}, before[pressed.first], before[pressed.last]};
  const Vector3 aside = across(column, cable, state);
  double steepest = 0;
  const auto slope = [&](int k) {
    return (pressed.shape[k + 1] - pressed.shape[k]) / cable.state.rest_lengths[column.first + k];
  };
  for (int k = 0; k < column.segments(); ++k) steepest = std::max(steepest, std::abs(slope(k)));
  const auto turned = [&](int k) -> Vector3 {
    const int i = column.first + k;
    const Vector3 segment = before[i + 1] - before[i];
    return segment.norm() * (segment.normalized() + pressed_slope / steepest * slope(k) * aside).normalized();
  };
  std::vector<Vector3>& positions = cable.state.positions;
  for (int k = 0; k < column.segments() && !pressed.held_at_last; ++k)
    positions[column.first + k + 1] = positions[column.first + k] + turned(k);
  for (int k = column.segments(); k-- > 0 && pressed.held_at_last;)
    positions[column.first + k] = positions[column.first + k + 1] - turned(k);
  start_anew(before, index, state);
}

namespace {

/// [N] The largest of the forces that press on a cable along a column; infinite where it lies against something, whose friction
/// keeps it straight.
double pressure_along(const Column& column, int cable, const std::vector<Touch>& touches) {
  const Vector3 along = column.direction();
  double pressure = 0;
  for (const Touch& touch : touches) {
    if (touch.point.cable != cable && touch.other.cable != cable) continue;
    if (touch.normal_force > 0 && std::abs(touch.normal.dot(along)) < pressed_along) return infinity;
    pressure = std::max(pressure, touch.normal_force);
  }
  return pressure > 0 ? pressure : infinity;
}

}  // namespace

std::vector<PressedColumn> find_pressed_columns(const Participant& p, const std::vector<Touch>& touches, const State& state) {
  std::vector<PressedColumn> found;
  for_each_free_column(p.cable, state, [&](const Column& column, bool held_at_last) {
    double least = 0;
    for (int i = column.first; i < column.last; ++i) least = std::min(least, p.stepper->tension(i));
    if (least > -noticed_pressure * pressure_along(column, p.cable, touches)) return;
    std::vector<double> tension;
    for (int i = column.first; i < column.last; ++i) tension.push_back(p.stepper->tension(i));
    LateralStiffness stiffness(*state.cables[p.cable].model, state.cables[p.cable].state, column, tension);
    if (stiffness.is_stable_for(p.substep.h)) return;
    found.push_back({column.first, column.last, held_at_last, stiffness.growing_shape()});
  });
  return found;
}

void buckle_straight_columns(int index, State& state) {
  SimulatedCable& cable = state.cables[index];
  // Until the end of the first substep.
  const double part = std::ldexp(1.0, -state.cable_progress[index].level), time = part * state.scene->time_step;
  const auto next = [part](const KinematicTarget& target) -> Vector3 {
    return target.position + part * (target.next_position - target.position);
  };
  for_each_column(index, state, next, [&](const Column& column) {
    if (can_stretch(column, cable)) return disturb(column, state, cable);
    const double slack = slack_of(column);
    if (slack == 0) return;
    if (slack > largest_slack_aside * column.length && !gravity_across(column, cable, state).isZero(0)) return;
    bend(column, slack, time, waves_of_sudden_bow(*cable.model, cable.state, column, time), index, state);
  });
}

void carry_straight_columns(int index, State& state) {
  const auto jumped = [](const KinematicTarget& target) { return target.position; };
  for_each_column(index, state, jumped, [&](const Column& column) {
    const double slack = slack_of(column);
    if (slack == 0) return;
    bend(column, slack, 0, 1, index, state);
    std::vector<Vector3>& positions = state.cables[index].state.positions;
    positions[column.first] = column.from;
    positions[column.last] = column.to;
  });
}

bool bend_straight_columns(int index, State& state) {
  const SimulatedCable& cable = state.cables[index];
  bool bends = false;
  const auto now = [](const KinematicTarget& target) { return target.position; };
  for_each_column(index, state, now, [&](const Column& column) {
    const double slack =
        can_stretch(column, cable) ? slack_beyond_buckling(column, cable, state.scene->gravity) : slack_of(column);
    if (slack == 0) return;
    bend(column, slack, 0, 1, index, state);
    bends = true;
  });
  return bends;
}

}  // namespace verlet_cable
