#include "target/length_drive.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "chain/node_arrays.h"
#include "rod/bending_memory.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/cable_materials.h"

namespace verlet_cable {

namespace {

/// [1/s] Of the critically damped motion that gives lost length back.
constexpr double giving_back = 20;
constexpr double smallest_debt = 1e-9;  // [m]
/// [m] More than rounding.
constexpr double stalling_excess = 1e-9;

template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

/// [m/s] From which it can just brake in `left` [m], going so fast in the first step already.
double braking_speed(double left, double time_step, double acceleration) {
  return acceleration * (std::sqrt(0.25 * time_step * time_step + 2 * left / acceleration) - 0.5 * time_step);
}

void give_debt_back(double time_step, LengthDrive& drive) {
  const double decay = std::exp(-giving_back * time_step), slope = drive.debt_rate + giving_back * drive.debt;
  drive.next_debt = (drive.debt + slope * time_step) * decay;
  drive.next_debt_rate = (drive.debt_rate - giving_back * slope * time_step) * decay;
  if (std::abs(drive.next_debt) < smallest_debt) drive.next_debt = drive.next_debt_rate = 0;
  drive.change = drive.wound + drive.debt - drive.next_debt;
}

/// Goes on as it goes, as far as it may.
void go_on(double time_step, LengthDrive& drive) {
  const double going = drive.rate + drive.slip;
  drive.rate = drive.next_rate = std::clamp(going, -drive.fastest_in, drive.fastest_out);
  drive.slip = going - drive.rate;
  drive.wound = time_step * drive.rate;
  drive.change = drive.wound + drive.debt - drive.next_debt;
}

/// [kg] By which each of the segment's nodes has become heavier.
double mass_at(const LengthDrive& drive, double part, double time_step, const CableModel& model, const CableState& state) {
  const double fed = part * (drive.wound + time_step * drive.carried);
  return drive.is_winch() ? 0.5 * CableMaterials(model, state)[drive.segment].linear_density * fed : 0;
}

}  // namespace

double planned_length(const LengthDrive& drive, double part, double time_step) {
  const double uniform = drive.change - 0.5 * time_step * (drive.growth() + drive.next_growth());
  const double accelerated = time_step * (drive.growth() + 0.5 * part * (drive.next_growth() - drive.growth()));
  const double slid = part * time_step * drive.carried;
  return drive.start_length + (part == 1 ? drive.change : part * (uniform + accelerated)) + slid;
}

void plan_drive(double available, double time_step, LengthDrive& drive) {
  const double goal = std::max(drive.left, -std::max(available, 0.0));
  const double side = goal < 0 ? -1 : 1, distance = std::abs(goal), speed = side * drive.rate;
  const double most = drive.acceleration * time_step;
  drive.arrives = distance <= most * time_step && std::abs(speed) <= 2 * most;
  double next = 0;
  drive.wound = goal;
  if (!drive.arrives) {
    // The speed after the step from which it can just brake in what is left then.
    const double left = std::max(distance - 0.5 * time_step * speed, 0.0);
    const double braking = braking_speed(left, time_step, drive.acceleration);
    next = std::clamp(std::min(drive.speed, braking), speed - most, speed + most);
    drive.wound = std::max(side * 0.5 * time_step * (speed + next), std::min(-available, 0.0));
  }
  drive.next_rate = side * next;
  give_debt_back(time_step, drive);
}

void plan_kept_tension(double going, double available, double most_out, double time_step, LengthDrive& drive) {
  // The mean over the step of how it goes and of what it can just brake from at the end: what speeds it up does not let it go on
  // to more. It may have been jerked to where it goes the other way, or faster than that.
  const auto fastest = [&](double from, double left) {
    const double before = std::min(drive.speed, std::sqrt(2 * drive.acceleration * std::max(left, 0.0)));
    const double left_then = std::max(left - 0.5 * time_step * before, 0.0);
    const double after = std::min(drive.speed, braking_speed(left_then, time_step, drive.acceleration));
    return std::min(0.5 * (std::clamp(from, 0.0, before) + after), std::max(left, 0.0) / time_step);
  };
  drive.fastest_in = drive.tension > 0 ? fastest(-going, available) : 0;
  drive.fastest_out = fastest(going, most_out);
  drive.arrives = false;
  drive.slip = going - drive.rate;
  give_debt_back(time_step, drive);
  go_on(time_step, drive);
}

void stall(double most, double time_step, LengthDrive& drive) {
  if (drive.keeps_tension) {
    drive.fastest_in = std::min(drive.fastest_in, std::max(most, 0.0) / time_step);
    go_on(time_step, drive);
    return;
  }
  const double excess = -drive.change - std::max(most, 0.0);
  if (!(excess > stalling_excess)) return;
  drive.change += excess;
  drive.wound += excess;
  drive.next_rate = 0;
  drive.arrives = false;
}

WinchLaw winch_law(const LengthDrive& drive, double part, double h, double time_step) {
  WinchLaw law;
  if (!drive.heeds_tension()) return law;
  law.tension = drive.tension;
  if (!drive.keeps_tension) {
    law.least_rate = -drive.carried;
    law.most_rate = std::max(drive.fastest_out - growth_at(drive, part), law.least_rate);
    law.least = h * law.least_rate;
    law.most = h * law.most_rate;
  } else {
    // Behind the clutch its motor runs on as fast as it came to; nothing holds a spool that turns freely. Rates are means over
    // substeps: at the end it has gone on speeding up or braking, by half of what the motor does, or to where it brakes.
    const double going = drive.rate + drive.slip, half_gain = 0.5 * h * drive.acceleration;
    const double reach = drive.tension == 0 ? infinity : drive.motor_speed + time_step * drive.acceleration;
    const auto end = [&](double fastest, double speed) {
      const double rate = std::min(fastest, reach);
      return rate + std::clamp(rate - speed, -half_gain, fastest < reach ? infinity : half_gain);
    };
    law.least = h * (-std::min(drive.fastest_in, reach) - drive.rate);
    law.most = h * (std::min(drive.fastest_out, reach) - drive.rate);
    law.least_rate = -end(drive.fastest_in, -going) - drive.rate;
    law.most_rate = end(drive.fastest_out, going) - drive.rate;
  }
  law.guess = std::clamp(drive.keeps_tension ? h * drive.slip : 0, law.least, std::max(law.least, law.most));
  return law;
}

void open_clamp(const LengthDrive& drive, const std::vector<Attachment>& attachments, int segments, KinematicTargets& targets) {
  if (!drive.is_winch()) return;
  const int end = drive.end_node(segments);
  const auto is_neighbour = [&](const KinematicTarget& target) {
    const Attachment& attachment = attachments[target.attachment];
    return attachment.node == end && target.node != end && attachment.guide < 0;
  };
  auto& nodes = targets.nodes;
  nodes.erase(std::remove_if(nodes.begin(), nodes.end(), is_neighbour), nodes.end());
}

void wind(const LengthDrive& drive, double part, double time_step, const CableModel& model, CableState& state) {
  const auto lengths = [&] { return std::array{joint_length(state, drive.segment), joint_length(state, drive.segment + 1)}; };
  const std::array<double, 2> before = lengths();
  state.rest_lengths[drive.segment] = planned_length(drive, part, time_step);
  if (!drive.is_winch()) {
    // The two that are welded stay turned against each other as they are.
    if (state.rest_twist.empty()) return;
    const std::array<double, 2> after = lengths();
    for (const int side : {0, 1}) state.rest_twist[drive.segment + side] *= before[side] / after[side];
    return;
  }
  const double mass = mass_at(drive, part, time_step, model, state);
  for (const int side : {0, 1}) state.masses[drive.segment + side] = drive.start_masses[side] + mass;
}

void slip(double beyond, double share, double h, const CableModel& model, CableState& state, LengthDrive& drive) {
  const double mass = 0.5 * CableMaterials(model, state)[drive.segment].linear_density * beyond;
  state.rest_lengths[drive.segment] += share * beyond;
  drive.start_length += beyond;
  for (const int side : {0, 1}) {
    state.masses[drive.segment + side] += share * mass;
    drive.start_masses[side] += mass;
  }
  drive.slip = drive.carried + beyond / h;
  drive.slipped += h * drive.slip;
  if (drive.slip > 0) drive.arrives = false;
}

void keep_flow(double part, double time_step, const CableModel& model, const CableState& state, LengthDrive& drive) {
  drive.start_length += state.rest_lengths[drive.segment] - planned_length(drive, part, time_step);
  const double mass = mass_at(drive, part, time_step, model, state);
  for (const int side : {0, 1})
    drive.start_masses[side] += state.masses[drive.segment + side] - (drive.start_masses[side] + mass);
}

double growth_at(const LengthDrive& drive, double part) {
  return drive.growth() + part * (drive.next_growth() - drive.growth()) + drive.carried;
}

bool complete_drive(double time_step, LengthDrive& drive) {
  const double found = drive.wound / time_step + drive.slip;  // in the mean
  drive.left = drive.arrives ? 0 : drive.left - drive.fed();
  drive.rate = drive.next_rate;
  drive.slipped = drive.carried = 0;
  drive.motor_speed = std::max(drive.motor_speed, std::abs(drive.rate + drive.slip));
  if (drive.slip != 0) {
    // A motor goes as what it pulls lets it, but does not turn round.
    const double rate = drive.keeps_tension ? found : std::clamp(found, drive.rate, std::max(drive.rate, 0.0));
    drive.slip = found - rate;
    drive.rate = rate;
  }
  drive.debt = drive.next_debt;
  drive.debt_rate = drive.next_debt_rate;
  return !drive.arrives || drive.debt != 0 || drive.heeds_tension();
}

void insert_node(int segment, double first, const CableModel& model, CableState& state) {
  const double whole = state.rest_lengths[segment], second = whole - first, part = first / whole;
  const int node = segment + 1, neighbour = segment == 0 ? node : segment;
  std::array<double, 2> turns{0, 0};  // [rad] from the segment's middle to those of its parts
  if (!state.joint_twist.empty()) {
    // Twist goes on evenly.
    const auto twist_rate = [&](int at) { return material_twist(model, state, at) / joint_length(state, at); };
    turns = {0.5 * second * twist_rate(segment), 0.5 * first * twist_rate(node)};
  }
  duplicate_node(node, state);
  for (auto* values : {&state.positions, &state.velocities, &state.accelerations})
    (*values)[node] = (*values)[segment] + part * ((*values)[node + 1] - (*values)[segment]);
  if (!state.rest_curvature.empty()) state.rest_curvature[node] = state.rest_curvature[neighbour];
  if (!state.rest_twist.empty()) state.rest_twist[node] = state.rest_twist[neighbour];
  // What a winch pays out bends.
  if (!state.flexible_fraction.empty()) state.flexible_fraction[node] = 1;
  const double half_density = 0.5 * CableMaterials(model, state)[segment].linear_density;
  state.masses[segment] -= half_density * second;
  state.masses[node + 1] -= half_density * first;
  state.masses[node] = half_density * whole;
  duplicate_segment(segment, state);
  if (!state.bending_memory.empty()) state.bending_memory[segment].back() = state.bending_memory[node].front() = {};
  state.rest_lengths[segment] = first;
  state.rest_lengths[node] = second;
  if (!state.joint_twist.empty()) {
    state.joint_twist[segment] -= turns[0];
    state.joint_twist[node] = turns[0] + turns[1];
    state.joint_twist[node + 1] -= turns[1];
    turn_segment(segment, -turns[0], state);
    turn_segment(node, turns[1], state);
  }
  if (state.reference_node >= node) ++state.reference_node;
}

double remove_node(int node, CableState& state) {
  const int before = node - 1, after = node + 1;
  const double first = state.rest_lengths[before], second = state.rest_lengths[node], whole = first + second;
  const double stretch =
      ((state.positions[node] - state.positions[before]).norm() + (state.positions[after] - state.positions[node]).norm()) /
      whole;
  const double length = (state.positions[after] - state.positions[before]).norm() / stretch;
  const double mass = state.masses[node];
  const auto give = [&](int neighbour, double share) {
    const double moved = share * mass, sum = state.masses[neighbour] + moved;
    state.velocities[neighbour] = (state.masses[neighbour] * state.velocities[neighbour] + moved * state.velocities[node]) / sum;
    state.masses[neighbour] = sum;
  };
  Vector3 director = Vector3::Zero();
  if (!state.directors.empty()) {
    // Seen from its own middle the new segment is turned by a part of the twist at the node.
    const double to_first = state.joint_twist[node] * second / whole, to_second = state.joint_twist[node] - to_first;
    state.joint_twist[before] += to_first;
    state.joint_twist[after] += to_second;
    const Vector3 along = state.positions[after] - state.positions[before];
    director = carried_director(state, before, along, to_first);
  }
  give(before, second / whole);
  give(after, first / whole);
  const auto mean =
      Overloaded{[&](const auto& a, const auto& b) { return (first * a + second * b) / whole; },
                 [&](int a, int b) { return first < second ? b : a; },  // what it is made of: as the longer one
                 // The joints beside it have the bend of the node, too.
                 [&](const std::array<HalfBend, 2>& a, const std::array<HalfBend, 2>& b) {
                   return std::array<HalfBend, 2>{sum_of({{1, a[0]}, {second / whole, a[1]}, {second / whole, b[0]}}),
                                                  sum_of({{1, b[1]}, {first / whole, a[1]}, {first / whole, b[0]}})};
                 }};
  visit_segment_arrays(state, [&](auto& values) { values[before] = mean(values[before], values[node]); });
  if (!state.directors.empty()) state.directors[before] = director;
  state.rest_lengths[before] = length;
  erase_segment(node, state);
  erase_node(node, state);
  if (state.reference_node >= node) --state.reference_node;
  return whole - length;
}

}  // namespace verlet_cable
