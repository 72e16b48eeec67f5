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
/// Of a span's length: what is pressed together and less aside stays straight for too long.
constexpr double pressed_straightness = 1e-3;
/// Of what presses: less along the column is a thing that the cable lies against.
constexpr double pressed_along = 0.7;
/// Of a segment, by which it is turned at most where its cable is to leave a line: what hangs on it would be lifted by less than
/// 1e-9 of the length.
constexpr double seed_slope = 6e-5;
/// Of a span's length: what is less aside has no seed.
constexpr double seed_straightness = 1e-7;
/// Of the bow that a substep needs: what is less aside has no room.
constexpr double part_of_room = 0.1;
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

/// Calls `f` with each span, almost straight, between what holds a cable, whatever that is, and its ends: what presses on an
/// end keeps it where it is. Not those that give way at an end: where material flows through a guide, or a node is on its way to
/// what has caught it.
template <class Function>
void for_each_straight_span(int index, const State& state, const Function& f) {
  const KinematicTargets& targets = state.cable_progress[index].targets;
  const CableState& cable = state.cables[index].state;
  const auto visit = [&](int first, int last) {
    if (last - first < 2 || !is_straight(cable, first, last, pressed_straightness)) return;
    f(StraightSpan{first, last, is_clamped(first, targets), is_clamped(last, targets)});
  };
  int from = 0;
  bool stays = true;
  for (const KinematicTarget& target : targets.nodes) {
    const bool stays_there = !target.slides && !is_drawn_to_holder(target, state.time());
    if (stays && stays_there) visit(from, target.node);
    from = target.node;
    stays = stays_there;
  }
  if (stays) visit(from, cable.segments());
}

/// Whether compression surely is too small for anything to grow by a factor of more than e in a time [s], after Gershgorin.
/// `tension(i)` [N]: of a segment.
template <class Tension>
bool is_surely_stable_for(double time, const StraightSpan& span, const CableState& state, const Tension& tension) {
  for (int i = span.first; i < span.last; ++i) {
    const double mass = std::min(state.masses[i], state.masses[i + 1]);
    if (-4 * tension(i) * time * time > mass * state.rest_lengths[i]) return false;
  }
  return true;
}

/// Moves the nodes of a span across it, each by its `shape` [m].
void move_aside(const StraightSpan& span, const std::vector<double>& shape, int index, State& state) {
  SimulatedCable& cable = state.cables[index];
  const std::vector<Vector3> before = cable.state.positions;
  const Vector3 aside = across({span, before[span.first], before[span.last]}, cable, state);
  for (int k = 0; k <= span.segments(); ++k) cable.state.positions[span.first + k] += shape[k] * aside;
  start_anew(before, index, state);
}

/// Turns the segments of an unstable span a little, by what grows; their lengths change by less than is tolerated.
void seed(const StraightSpan& span, LateralStiffness& stiffness, int index, State& state) {
  const std::vector<double>& lengths = state.cables[index].state.rest_lengths;
  std::vector<double> shape = stiffness.growing_shape();
  double steepest = 0;
  for (int k = 0; k < span.segments(); ++k)
    steepest = std::max(steepest, std::abs(shape[k + 1] - shape[k]) / lengths[span.first + k]);
  for (double& place : shape) place *= seed_slope / steepest;
  move_aside(span, shape, index, state);
}

/// [m] By which the ends of a span come together in a substep at most, where what is pressed against it stops at once: the way of
/// the span along itself.
double sudden_slack(const StraightSpan& span, const Participant& p) {
  const std::vector<Vector3>& positions = p.state->positions;
  const Vector3 along = (positions[span.last] - positions[span.first]).normalized();
  const auto way = [&](int node) { return std::abs(along.dot(get(p.stepper->displacement(), node))); };
  return std::max(way(span.first), way(span.last));
}

/// Whether something lies against a span, whose friction keeps it straight.
bool lies_against(const StraightSpan& span, int cable, const std::vector<Touch>& touches, const State& state) {
  const std::vector<Vector3>& positions = state.cables[cable].state.positions;
  const Vector3 along = (positions[span.last] - positions[span.first]).normalized();
  const auto is_in_span = [&](const CablePoint& point) {
    return point.cable == cable && point.segment >= span.first && point.segment < span.last;
  };
  return std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) {
    return touch.normal_force > 0 && (is_in_span(touch.point) || is_in_span(touch.other)) &&
           std::abs(touch.normal.dot(along)) < pressed_along;
  });
}

}  // namespace

GivesWay gives_way(const Participant& p, const std::vector<Touch>& touches, State& state) {
  bool gives = false, bent = false;
  for_each_straight_span(p.cable, state, [&](const StraightSpan& span) {
    const auto tension_at = [&](int i) { return p.stepper->tension(i); };
    if (is_surely_stable_for(p.substep.h, span, *p.state, tension_at) || lies_against(span, p.cable, touches, state)) return;
    std::vector<double> tension;
    for (int i = span.first; i < span.last; ++i) tension.push_back(tension_at(i));
    const SimulatedCable& cable = state.cables[p.cable];
    LateralStiffness stiffness(*cable.model, cable.state, span, tension);
    if (stiffness.is_stable_for(p.substep.h)) return;
    gives = true;
    const double length = cable.state.length(span.first, span.last);
    const double slack = std::min(sudden_slack(span, p), largest_slack_aside * length);
    if (slack < seed_slope * seed_slope * length) {
      if (!is_straight(cable.state, span.first, span.last, seed_straightness)) return;
      seed(span, stiffness, p.cable, state);
    } else {
      const double waves = p.substep.statics ? 1 : waves_of_sudden_bow(*cable.model, cable.state, span, p.substep.h);
      const Bow bow = find_bow(cable.state, span, length - slack, waves);
      const auto [least, most] = std::minmax_element(bow.across.begin(), bow.across.end());
      const double room = std::max(*most, -*least);
      if (!is_straight(cable.state, span.first, span.last, part_of_room * room / length)) return;
      move_aside(span, bow.across, p.cable, state);
    }
    bent = true;
  });
  return bent ? GivesWay::anew : gives ? GivesWay::shorter : GivesWay::no;
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
