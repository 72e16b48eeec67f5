#include "world/settling.h"

#include <algorithm>
#include <cmath>

#include "guide/guides.h"
#include "guide/node_passing.h"
#include "rod/length_projection.h"
#include "rod/rod_frames.h"
#include "solve/resting_shape.h"
#include "verlet_cable/core/cable_materials.h"
#include "world/flush_denormals.h"
#include "world/island_stepper.h"
#include "world/loads.h"
#include "world/straight_columns.h"

namespace verlet_cable {

namespace {

/// Settling begins with steps of this length [s] and ends with one in which inertia is nothing.
constexpr double first_settling_step = 0.01;
constexpr double last_settling_step = 1e6;
constexpr int maximum_settling_steps = 2000;
/// From one step to the next; the second once a step was too long, to come back slowly to what was.
constexpr double fastest_growth = 4, slow_growth = 1.5;
constexpr int few_iterations = 5;
constexpr int calm_steps = 50;
/// So often nodes go back through guides; then they stay where they are: a guide may be in equilibrium just where one passes.
constexpr int most_returns = 3;
/// Where there is something to touch, no node goes further at a time than this, in radii.
constexpr double settling_reach = 1;
constexpr double settled_contact = 1e-4;       // radii
constexpr double settled_acceleration = 1e-7;  // [m/s^2]

/// A clamp is turned by so much at a time [rad], with so many steps, none longer than this [s].
constexpr double turning_angle = 0.25;
constexpr int turning_steps = 8;
constexpr double longest_turning_step = 1;
/// Sine of the angle below which a clamp that points against the cable is turned about its own y.
constexpr double opposite = 0.05;

/// An equilibrium is left by this much, of a segment's length; it is none that lasts if the way back grows to so many times that,
/// in so many steps of each length [s].
constexpr double nudge = 1e-3;
constexpr double grown = 3;
constexpr double last_nudged_step = 1;
constexpr int nudged_steps = 4;
constexpr int maximum_nudges = 5;

/// [rad] of twist, and how often that is taken from a start.
constexpr double settled_twist = 1e-7;
constexpr int most_untwistings = 30;

/// What stands is left to itself for a trial, so long [s], in steps that grow from and by these [s]; it
/// does not stand if a node gets faster than `moving` [m/s].
constexpr int maximum_trials = 5;
constexpr double trial_time = 0.5;
constexpr double first_trial_step = 1e-3, shortest_trial_step = 1e-5, trial_growth = 1.05;
constexpr double longest_trial_step = 5e-3, longest_touching_step = 2e-3;
constexpr double moving = 5e-3;
constexpr double far_away = 5;  // segments

/// A start is given up after so many iterations for each segment of its cable, or as many as take no time.
constexpr int most_start_iterations = 1000;
constexpr int short_start_iterations = 2500000;  // times segments

/// A step [s] in which a fold of a single joint opens, where a longer one would hold on to it.
double shortest_step(const SimulatedCable& cable) {
  const double length = cable.model->segment_length;
  return CableMaterials(cable).smallest([length](const MaterialDesc& material) {
    const double stiffness = material.bending_stiffness.largest();
    if (!(stiffness > 0)) return first_settling_step;
    const double period = length * length * std::sqrt(material.linear_density / stiffness);
    return std::clamp(0.05 * period, shortest_substep, first_settling_step);
  });
}

double smallest_radius(const SimulatedCable& cable) {
  return CableMaterials(cable).smallest([](const MaterialDesc& material) { return material.radius; });
}

double largest_distance(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

double fastest(const CableState& state) {
  double fastest = 0;
  for (const Vector3& velocity : state.velocities) fastest = std::max(fastest, velocity.norm());
  return fastest;
}

/// Sum of the nodes at which a cable is in guides.
int places_of_guides(int cable, const std::vector<Attachment>& attachments) {
  int sum = 0;
  for (const Attachment& attachment : attachments)
    if (attachment.guide >= 0 && attachment.body == cable_id(cable)) sum += attachment.node;
  return sum;
}

/// In no special direction.
Vector3 direction_at(double part) {
  return {std::sin(1 + 7 * part), std::sin(2 + 5 * part), std::sin(3 + 4 * part)};
}

/// The turn that takes a clamp's direction to the cable's, where it is held by it.
Eigen::AngleAxisd turn_to_cable(const Quaternion& clamp, int node, const std::vector<Vector3>& positions) {
  const int last = static_cast<int>(positions.size()) - 1;
  const Vector3 direction = clamp * Vector3::UnitX();
  const Vector3 after = (positions[std::min(node + 1, last)] - positions[node]).normalized();
  const Vector3 before = (positions[node] - positions[std::max(node - 1, 0)]).normalized();
  Vector3 along = before + after;
  if (along.norm() < opposite) {
    // Folded over the clamp: across the fold, where both sides bend alike.
    along = direction - direction.dot(after) * after;
    if (along.norm() < opposite) along = clamp * Vector3::UnitY();
  }
  along.normalize();
  const Vector3 axis = direction.cross(along);
  const double sine = axis.norm(), cosine = direction.dot(along);
  if (cosine < 0 && sine < opposite) return {M_PI, clamp * Vector3::UnitY()};
  if (!(sine > 0)) return {0, Vector3::UnitX()};
  return {std::atan2(sine, cosine), axis / sine};
}

}  // namespace

Settling::Settling(int cable, State& state, Workspace& workspace, const std::atomic<bool>* cancelled)
    : cancelled_(cancelled),
      index_(cable),
      state_(state),
      workspace_(workspace),
      cable_(state.cables[cable]),
      memory_(state.cable_progress[cable]),
      work_(workspace.cables.empty() ? workspace.cables.emplace_back() : workspace.cables.front()) {
  work_.stepper.resize(cable_.state.segments());
  work_.boundary = {};  // a settling in which nothing converges would tell the forces of what was there before
}

void Settling::find_obstacles() {
  move_obstacles(state_, 1, 1, workspace_.obstacles);
}

bool Settling::settle() {
  const FlushDenormals flush_denormals;
  hold_still();
  find_obstacles();
  const bool touching = may_touch();
  Approach approach(index_, touching);
  if (touching) find_contacts(approach, true, 1);
  if (!workspace_.contacts.intrusions().empty()) lie_down();
  bool settled = relax(shortest_step(cable_), last_settling_step, maximum_settling_steps, approach);
  if (bend_straight_columns(index_, state_)) {
    hold_at(1, 1, memory_.targets, work_.boundary);
    settled = relax(shortest_step(cable_), last_settling_step, maximum_settling_steps, approach);
  }
  complete();
  return settled && !(touching && workspace_.contacts.is_stuck());
}

bool Settling::settle_start() {
  const FlushDenormals flush_denormals;
  hold_still();
  memory_.spans.clear();
  const CableState hanging = cable_.state;
  // As if there was nothing to touch, which is much faster; if that ends where something is, once more.
  workspace_.obstacles.clear();
  Approach approach(index_, false);
  approach.iterations = std::max(most_start_iterations, short_start_iterations / cable_.state.segments());
  turn_clamps(approach);
  bool settled = find_untwisted_equilibrium(approach);
  find_obstacles();
  if (may_touch()) {
    find_contacts(approach, true, 1);
    if (!workspace_.contacts.touches().empty() || !workspace_.contacts.intrusions().empty()) {
      Approach touching(index_, true);
      touching.iterations = approach.iterations;
      if (!slides(memory_.targets)) {
        cable_.state = hanging;
        turn_clamps(touching);
        lie_down();
      }
      settled = find_untwisted_equilibrium(touching) && !workspace_.contacts.is_stuck();
    }
  }
  memory_.spans = find_spans(cable_.state, work_.boundary.directions);
  complete();
  return settled;
}

bool Settling::hangs_into_something() {
  find_obstacles();
  const Surroundings surroundings(cable_, memory_.targets, state_.attachments, workspace_.obstacles);
  return surroundings.touches(cable_.state.positions);
}

/// To where it comes to rest on what stands there, from above, if it finds that; friction and what else there is find the rest of
/// the way.
void Settling::lie_down() {
  if (workspace_.obstacles.empty() || slides(memory_.targets)) return;
  const Surroundings surroundings(cable_, memory_.targets, state_.attachments, workspace_.obstacles);
  const Vector3 there = gravity_near(state_, index_);
  const Vector3 gravity = there.norm() > 0 ? there : Vector3(-Vector3::UnitZ());
  const std::vector<Vector3> before = cable_.state.positions;
  cable_.state.positions = laid_shape(cable_.state, work_.boundary.nodes, gravity.normalized(), surroundings);
  if (!rest_on(cable_, work_.boundary, gravity, surroundings, cable_.state.positions)) {
    cable_.state.positions = before;
    return;
  }
  project_positions(*cable_.model, work_.boundary.nodes, cable_.state);
  carry_frames(before, cable_.state);
  follow_material();
}

/// Puts the holders where they are to be, and takes the cable's motion away.
void Settling::hold_still() {
  aim_targets(cable_.state, state_.attachments, state_.frames.poses, state_.time(), memory_.targets);
  put_at_aim(memory_.targets);
  measure_joint_twists(memory_.targets.directions, cable_.state);
  hold_at(1, 1, memory_.targets, work_.boundary);
  load_flows(index_, false, state_, work_.boundary);
  load_nodes(index_, state_, work_.boundary);
  bring_to_rest(cable_.state);
  stop_flows(index_, state_);
}

/// The holders move with their frames, and take along what cannot stretch.
void Settling::complete() {
  keep_twist(work_.boundary, memory_.targets);
  stop_flows(index_, state_);
  load_flows(index_, false, state_, work_.boundary);
  project_velocities(*cable_.model, work_.boundary, cable_.state);
  keep_flows(index_, work_.boundary, state_);
  add_forces(work_.boundary, memory_.targets, state_.frames.poses, 1, state_.attachments);
  follow_material();
}

void Settling::follow_material() {
  verlet_cable::follow_material(*cable_.model, work_.boundary.directions, memory_.spans, cable_.state);
}

/// From the directions of the cable that hangs from them to their own.
void Settling::turn_clamps(Approach& approach) {
  std::vector<Eigen::AngleAxisd> turns;
  double most = 0;
  for (const HeldDirection& direction : work_.boundary.directions) {
    turns.push_back(turn_to_cable(direction.end, direction.node, cable_.state.positions));
    most = std::max(most, turns.back().angle());
  }
  const int stages = static_cast<int>(std::ceil(most / turning_angle));
  for (int stage = 0; stage < stages; ++stage) {
    const double left = 1 - static_cast<double>(stage) / stages;
    place_clamps(turns, left);
    follow_material();
    relax(shortest_step(cable_), longest_turning_step, turning_steps, approach);
    untwist();
  }
  place_clamps(turns, 0);
  follow_material();
}

/// Turns the clamps away from their own directions by a part of `turns`.
void Settling::place_clamps(const std::vector<Eigen::AngleAxisd>& turns, double part) {
  std::vector<DirectionTarget>& clamps = memory_.targets.directions;
  keep_twist(work_.boundary, memory_.targets);
  for (std::size_t k = 0; k < clamps.size(); ++k)
    clamps[k].orientation = Quaternion(Eigen::AngleAxisd(part * turns[k].angle(), turns[k].axis())) * clamps[k].next_orientation;
  roll_clamps_to_twist(clamps, cable_.state);
  for (std::size_t k = 0; k < clamps.size(); ++k) {
    HeldDirection& held = work_.boundary.directions[k];
    held.start = held.end = clamps[k].orientation;
    held.twist_before = clamps[k].twist_before;
    held.twist_after = clamps[k].twist_after;
  }
}

/// Lets clamps hold the material so that the cable has its rest twist. Returns how far from that it was [rad].
double Settling::untwist() {
  keep_twist(work_.boundary, memory_.targets);
  const double excess = take_excess_twist(
      memory_.targets.directions, [](const DirectionTarget&) { return true; }, cable_.state);
  for (std::size_t k = 0; k < memory_.targets.directions.size(); ++k) {
    work_.boundary.directions[k].twist_before = memory_.targets.directions[k].twist_before;
    work_.boundary.directions[k].twist_after = memory_.targets.directions[k].twist_after;
  }
  return excess;
}

/// The equilibrium of a cable that is not twisted by its clamps: where bending twists it, their roll is found in turns with the
/// shape.
bool Settling::find_untwisted_equilibrium(Approach& approach) {
  bool settled = find_equilibrium(approach);
  for (int i = 0; i < most_untwistings && settled && untwist() > settled_twist; ++i) {
    hold_at(1, 1, memory_.targets, work_.boundary);
    settled = relax(shortest_step(cable_), last_settling_step, maximum_settling_steps, approach);
  }
  return settled;
}

/// Brings a cable that is held still into an equilibrium that lasts. False if none was found: it is then where it first came to.
bool Settling::find_equilibrium(Approach& approach) {
  double h = shortest_step(cable_);
  bool settled = relax(h, last_settling_step, maximum_settling_steps, approach);
  if (slides(memory_.targets)) return settled;
  const CableState first = cable_.state;
  const std::vector<TwistSpan> first_spans = memory_.spans;
  for (int nudges = 0, trials = 0; settled;) {
    // What goes on leaving has a flat valley to go along: it may stand where it is.
    if (nudges < maximum_nudges && leaves_equilibrium(approach, h)) {
      ++nudges;
    } else if (leaves_when_let_go(approach, h)) {
      ++trials;
    } else {
      break;
    }
    settled = trials <= maximum_trials && relax(h, last_settling_step, maximum_settling_steps, approach);
  }
  if (!settled) {
    cable_.state = first;
    memory_.spans = first_spans;
  }
  return settled;
}

/// Substeps without motion, ever longer as long as they converge and the loads that are left grow less, until inertia carries
/// nothing: what is left is Newton's method for the equilibrium. True if that was found.
bool Settling::relax(double h, double longest, int steps, Approach& approach) {
  const double radius = smallest_radius(cable_);
  double last = infinity, growth = fastest_growth;
  bool failed = false;
  int calm = 0, returns = 0, last_way = 0;
  for (int i = 0; i < steps && approach.iterations > 0; ++i) {
    const SubstepResult substep = advance(approach, h);
    if (substep.converged && returns < most_returns) {
      const int before = places_of_guides(index_, state_.attachments);
      pass_nodes_of_guides();
      const int way = places_of_guides(index_, state_.attachments) - before;
      if (way * last_way < 0) ++returns;
      if (way != 0) last_way = way;
    }
    // What inertia still carries of the loads.
    const double acceleration = 2 * substep.displacement / (h * h);
    const bool lies = touches(approach);
    // What starts inside an obstacle is pushed out at the same pace, however long the step.
    const bool stands = !lies || substep.displacement < settled_contact * radius;
    if (substep.converged) {
      calm = acceleration < settled_acceleration && stands ? calm + 1 : 0;
      // What is slow hardly accelerates: only the longest steps tell it from what stands, or many.
      if (calm > 0 && (lies || h >= longest || calm >= calm_steps)) return true;
    }
    // The way grows with the square of a step.
    const double reach = settling_reach * radius, way = approach.touches ? substep.displacement : 0;
    const double factor = way > 0 ? std::clamp(0.9 * std::sqrt(reach / way), 0.125, growth) : growth;
    if (!substep.converged) {
      h = std::max(h * (way > reach ? factor : failed ? 0.125 : 0.5), shortest_substep);
      if (!(way > reach)) growth = slow_growth;
      failed = true;
    } else {
      failed = false;
      if (substep.iterations <= few_iterations) growth = fastest_growth;
      // A fold that opens is followed: longer steps would hold on to it.
      if (lies || acceleration < last) h = std::min(h * std::max(factor, 1.0), longest);
      last = acceleration;
    }
  }
  return false;
}

/// What of the cable has come to its guides goes through.
void Settling::pass_nodes_of_guides() {
  if (!slides(memory_.targets)) return;
  if (pass_nodes(index_, false, state_)) {
    begin_anew(cable_.state.unresolved);
    bring_to_rest(cable_.state);
    stop_flows(index_, state_);
    work_.stepper.resize(cable_.state.segments());
    keep_twist(work_.boundary, memory_.targets);
    memory_.contacts.clear();
    hold_at(1, 1, memory_.targets, work_.boundary);
    memory_.spans = find_spans(cable_.state, work_.boundary.directions);
    load_nodes(index_, state_, work_.boundary);
  }
  load_flows(index_, false, state_, work_.boundary);
}

/// Whether a cable that is nudged goes away from its equilibrium instead of back; it is then left on its way, which steps of `h`
/// [s] follow, else where it was.
bool Settling::leaves_equilibrium(Approach& approach, double& h) {
  // What lies is held by what it lies on.
  if (touches(approach)) return false;
  const CableState before = cable_.state;
  const std::vector<TwistSpan> spans_before = memory_.spans;
  const double size = nudge * cable_.model->segment_length;
  for (int i = 0; i < cable_.state.nodes(); ++i)
    cable_.state.positions[i] += size * direction_at(static_cast<double>(i) / cable_.state.segments());
  project_positions(*cable_.model, work_.boundary.nodes, cable_.state);
  carry_frames(before.positions, cable_.state);
  const double first = largest_distance(cable_.state.positions, before.positions);
  for (h = shortest_step(cable_); h < last_nudged_step; h *= 2)
    for (int i = 0; i < nudged_steps; ++i) {
      if (!advance(approach, h).converged) break;
      if (largest_distance(cable_.state.positions, before.positions) > grown * first) return true;
    }
  cable_.state = before;
  memory_.spans = spans_before;
  return false;
}

/// Whether a cable that is let go moves, be it that its contacts do not hold it or that it was no equilibrium; it is then left
/// where it got to, at rest.
bool Settling::leaves_when_let_go(Approach& approach, double& h) {
  const CableState before = cable_.state;
  const std::vector<TwistSpan> spans_before = memory_.spans;
  Approach trial(index_, may_touch());
  trial.let_go = true;
  trial.iterations = approach.iterations;
  for (HeldNode& held : work_.boundary.nodes) held.velocity.setZero();
  bool leaves = false;
  double step = first_trial_step;
  // What leaves is followed until it is far from where it would only come back to.
  const double far = far_away * cable_.model->segment_length;
  for (double time = 0; time < (leaves ? 2 : 1) * trial_time && trial.iterations > 0;) {
    if (advance(trial, step).converged) {
      leaves = leaves || fastest(cable_.state) > moving;
      if (leaves && largest_distance(cable_.state.positions, before.positions) > far) break;
      time += step;
      step *= trial_growth;
      step = std::min(step, touches(trial) ? longest_touching_step : longest_trial_step);
    } else {
      step *= 0.5;
      leaves = leaves || step < shortest_trial_step;
      if (step < shortest_trial_step) break;
    }
  }
  leaves = leaves || trial.iterations <= 0;
  approach.iterations = trial.iterations;
  measure_joint_twists(memory_.targets.directions, cable_.state);
  hold_at(1, 1, memory_.targets, work_.boundary);
  bring_to_rest(cable_.state);
  if (leaves) {
    h = shortest_step(cable_);
    cable_.state.bending_memory = before.bending_memory;  // what moved for a trial has not yielded
    return true;
  }
  cable_.state = before;
  memory_.spans = spans_before;
  return false;
}

/// One substep towards equilibrium of a cable that may lie on obstacles and on itself. It has not converged, too, if nodes have
/// gone so far that they may have gone through something.
SubstepResult Settling::advance(Approach& approach, double h) {
  if (cancelled_ && *cancelled_) {
    approach.iterations = 0;
    return {};
  }
  const Environment environment{state_.scene->gravity, state_.scene->fluid, no_waves};
  const Substep substep{*cable_.model, environment, work_.boundary, memory_.spans, h, !approach.let_go};
  if (!approach.touches) {
    const SubstepResult result = work_.stepper.advance(substep, cable_.state);
    approach.iterations -= result.iterations;
    return result;
  }
  find_contacts(approach, !approach.let_go, h);
  const CableState before = cable_.state;
  const std::vector<TwistSpan> spans_before = memory_.spans;
  SubstepResult result;
  if (workspace_.contacts.touches().empty()) {
    result = work_.stepper.advance(substep, cable_.state);
  } else {
    workspace_.participants.clear();
    workspace_.participants.push_back({0, index_, &work_.stepper, substep, &cable_.state, &result});
    if (workspace_.contact_solver.solve(workspace_.participants, workspace_.contacts.touches(), nullptr, infinity))
      workspace_.contact_solver.finish(workspace_.participants, workspace_.contacts.touches());
  }
  approach.iterations -= result.iterations;
  if (result.converged && result.displacement > settling_reach * smallest_radius(cable_)) {
    cable_.state = before;
    memory_.spans = spans_before;
    result.converged = false;
  }
  if (result.converged) workspace_.contacts.keep({{memory_.id, &memory_.targets, &approach.contacts}});
  return result;
}

void Settling::find_contacts(Approach& approach, bool still, double h) {
  workspace_.contacts.find(state_.cables, approach.island.cables, {{memory_.id, &memory_.targets, &approach.contacts}},
                           workspace_.obstacles, {}, state_.attachments, contact_rules(*state_.scene, still), h,
                           approach.island.pairs);
}

}  // namespace verlet_cable
