#include <algorithm>
#include <cmath>

#include "length_projection.h"
#include "verlet_cable/core/world.h"
#include "world_implementation.h"

namespace verlet_cable {

namespace {

/// Settling begins with steps of this length [s] and ends with one in which inertia is nothing.
constexpr double first_settling_step = 0.01;
constexpr double last_settling_step = 1e6;
constexpr int maximum_settling_steps = 2000;
/// From one step to the next; the second once a step was too long, to come back slowly to what was.
constexpr double fastest_growth = 4, slow_growth = 1.5;
constexpr int easy_iterations = 5;
constexpr int calm_steps = 50;
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
double shortest_step(const CableModel& model) {
  const double stiffness = model.material.bending_stiffness, length = model.segment_length;
  if (!(stiffness > 0)) return first_settling_step;
  const double period = length * length * std::sqrt(model.material.linear_density / stiffness);
  return std::clamp(0.05 * period, shortest_substep, first_settling_step);
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

bool World::settle() {
  Implementation& w = *implementation_;
  w.unsettled.clear();
  for (Attachment& attachment : w.attachments) attachment.force = attachment.torque = Vector3::Zero();
  w.move_obstacles(1, 1, w.moving_obstacles);
  for (int cable = 0; cable < static_cast<int>(w.cables.size()); ++cable) {
    if (w.scratch[cable].holders.nodes.empty()) continue;
    w.hold_still(cable);
    Settling settling(cable, w.may_touch());
    w.note_settled(cable, w.relax(shortest_step(w.cables[cable].model), last_settling_step, maximum_settling_steps, settling));
  }
  return w.unsettled.empty();
}

bool World::Implementation::may_touch() const {
  return !moving_obstacles.empty() || scene.contact;
}

/// Puts the holders of a cable where they are to be, and takes its motion away.
void World::Implementation::hold_still(int index) {
  CableScratch& s = scratch[index];
  aim_holders(cables[index].model, attachments, poses, time(), s.holders);
  put_at_aim(s.holders);
  hold_at(1, 1, s.holders, s.boundary);
  bring_to_rest(cables[index].state);
}

/// Its holders move with their frames, and take along what cannot stretch.
void World::Implementation::note_settled(int index, bool settled) {
  CableState& state = cables[index].state;
  project_velocities(cables[index].model, scratch[index].boundary.nodes, state.positions, state.velocities);
  add_forces(index, 1);
  follow_material(index);
  if (!settled) unsettled.push_back(cables[index].model.name);
}

/// A cable that hangs as if its clamps were hinges is taken by them in its own directions, and turned to theirs: that leads to
/// the shape that whoever mounts it would find, where Newton's method alone finds folds and loops. It is not twisted by that.
void World::Implementation::settle_start(int index) {
  SimulatedCable& cable = cables[index];
  CableScratch& s = scratch[index];
  if (s.holders.nodes.empty()) return;
  hold_still(index);
  s.spans.clear();
  const CableState hanging = cable.state;
  // As if there was nothing to touch, which is much faster; if that ends where something is, once more.
  Settling settling(index, false);
  settling.iterations = std::max(most_start_iterations, short_start_iterations / cable.model.segments());
  turn_clamps(settling);
  bool settled = find_equilibrium(settling);
  move_obstacles(1, 1, moving_obstacles);
  if (may_touch()) {
    settling.alone.contacts.find(cables, settling.alone.cables, moving_obstacles, attachments, contact_rules(true), 1);
    if (!settling.alone.contacts.touches().empty() || !settling.alone.contacts.intrusions().empty()) {
      const int iterations = settling.iterations;
      settling = Settling(index, true);
      settling.iterations = iterations;
      cable.state = hanging;
      turn_clamps(settling);
      settled = find_equilibrium(settling);
    }
  }
  s.spans = find_spans(cable.model, cable.state, s.boundary.directions);
  note_settled(index, settled);
}

/// From the directions of the cable that hangs from them to their own.
void World::Implementation::turn_clamps(Settling& settling) {
  const SimulatedCable& cable = cables[settling.cable()];
  CableScratch& s = scratch[settling.cable()];
  std::vector<HeldDirection>& directions = s.boundary.directions;
  std::vector<Eigen::AngleAxisd> turns;
  double most = 0;
  for (const HeldDirection& direction : directions) {
    turns.push_back(turn_to_cable(direction.end, direction.node, cable.state.positions));
    most = std::max(most, turns.back().angle());
  }
  const int stages = static_cast<int>(std::ceil(most / turning_angle));
  for (int stage = 0; stage < stages; ++stage) {
    const double left = 1 - static_cast<double>(stage) / stages;
    for (std::size_t k = 0; k < directions.size(); ++k) {
      const Quaternion turn(Eigen::AngleAxisd(left * turns[k].angle(), turns[k].axis()));
      directions[k].start = directions[k].end = turn * s.holders.directions[k].next_orientation;
    }
    follow_material(settling.cable());
    relax(shortest_step(cable.model), longest_turning_step, turning_steps, settling);
  }
  hold_at(1, 1, s.holders, s.boundary);
  follow_material(settling.cable());
}

/// Brings a cable that is held still into an equilibrium that lasts. False if none was found: it is then where it first came to.
bool World::Implementation::find_equilibrium(Settling& settling) {
  double h = shortest_step(cables[settling.cable()].model);
  bool settled = relax(h, last_settling_step, maximum_settling_steps, settling);
  const CableState first = cables[settling.cable()].state;
  const std::vector<TwistSpan> first_spans = scratch[settling.cable()].spans;
  for (int nudges = 0, trials = 0; settled;) {
    // What goes on leaving has a flat valley to go along: it may stand where it is.
    if (nudges < maximum_nudges && leaves_equilibrium(settling, h)) {
      ++nudges;
    } else if (leaves_when_let_go(settling, h)) {
      ++trials;
    } else {
      break;
    }
    settled = trials <= maximum_trials && relax(h, last_settling_step, maximum_settling_steps, settling);
  }
  if (!settled) {
    cables[settling.cable()].state = first;
    scratch[settling.cable()].spans = first_spans;
  }
  return settled;
}

/// Substeps without motion, ever longer as long as they converge and the loads that are left grow less, until inertia carries
/// nothing: what is left is Newton's method for the equilibrium. True if that was found.
bool World::Implementation::relax(double h, double longest, int steps, Settling& settling) {
  const double radius = cables[settling.cable()].model.material.radius;
  double last = infinity, growth = fastest_growth;
  bool failed = false;
  int calm = 0;
  for (int i = 0; i < steps && settling.iterations > 0; ++i) {
    const SubstepResult substep = settle_substep(settling, h);
    // What inertia still carries of the loads.
    const double acceleration = 2 * substep.displacement / (h * h);
    const bool lies = settling.touches && !settling.alone.contacts.touches().empty();
    // What starts inside an obstacle is pushed out at the same pace, however long the step.
    const bool stands = !lies || substep.displacement < settled_contact * radius;
    if (substep.converged) {
      calm = acceleration < settled_acceleration && stands ? calm + 1 : 0;
      // What is slow hardly accelerates: only the longest steps tell it from what stands, or many.
      if (calm > 0 && (lies || h >= longest || calm >= calm_steps)) return true;
    }
    // The way grows with the square of a step.
    const double reach = settling_reach * radius, way = settling.touches ? substep.displacement : 0;
    const double factor = way > 0 ? std::clamp(0.9 * std::sqrt(reach / way), 0.125, growth) : growth;
    if (!substep.converged) {
      h = std::max(h * (way > reach ? factor : failed ? 0.125 : 0.5), shortest_substep);
      if (!(way > reach)) growth = slow_growth;
      failed = true;
    } else {
      failed = false;
      if (substep.iterations <= easy_iterations) growth = fastest_growth;
      // A fold that opens is followed: longer steps would hold on to it.
      if (lies || acceleration < last) h = std::min(h * std::max(factor, 1.0), longest);
      last = acceleration;
    }
  }
  return false;
}

/// Whether a cable that is nudged goes away from its equilibrium instead of back; it is then left on its way, which steps of `h`
/// [s] follow, else where it was.
bool World::Implementation::leaves_equilibrium(Settling& settling, double& h) {
  SimulatedCable& cable = cables[settling.cable()];
  CableScratch& s = scratch[settling.cable()];
  // What lies is held by what it lies on.
  if (settling.touches && !settling.alone.contacts.touches().empty()) return false;
  const CableState before = cable.state;
  const std::vector<TwistSpan> spans_before = s.spans;
  const double size = nudge * cable.model.segment_length;
  for (int i = 0; i < cable.model.nodes(); ++i)
    cable.state.positions[i] += size * direction_at(static_cast<double>(i) / cable.model.segments());
  project_positions(cable.model, s.boundary.nodes, cable.state.positions);
  const double first = largest_distance(cable.state.positions, before.positions);
  for (h = shortest_step(cable.model); h < last_nudged_step; h *= 2)
    for (int i = 0; i < nudged_steps; ++i) {
      if (!settle_substep(settling, h).converged) break;
      if (largest_distance(cable.state.positions, before.positions) > grown * first) return true;
    }
  cable.state = before;
  s.spans = spans_before;
  return false;
}

/// Whether a cable that is let go moves, be it that its contacts do not hold it or that it was no equilibrium; it is then left
/// where it got to, at rest.
bool World::Implementation::leaves_when_let_go(Settling& settling, double& h) {
  SimulatedCable& cable = cables[settling.cable()];
  CableScratch& s = scratch[settling.cable()];
  const CableState before = cable.state;
  const std::vector<TwistSpan> spans_before = s.spans;
  Settling trial(settling.cable(), may_touch());
  trial.let_go = true;
  trial.iterations = settling.iterations;
  for (HeldNode& held : s.boundary.nodes) held.velocity.setZero();
  bool leaves = false;
  double step = first_trial_step;
  // What leaves is followed until it is far from where it would only come back to.
  const double far = far_away * cable.model.segment_length;
  for (double time = 0; time < (leaves ? 2 : 1) * trial_time && trial.iterations > 0;) {
    if (settle_substep(trial, step).converged) {
      leaves = leaves || fastest(cable.state) > moving;
      if (leaves && largest_distance(cable.state.positions, before.positions) > far) break;
      time += step;
      step *= trial_growth;
      step = std::min(step, trial.alone.contacts.touches().empty() ? longest_trial_step : longest_touching_step);
    } else {
      step *= 0.5;
      leaves = leaves || step < shortest_trial_step;
      if (step < shortest_trial_step) break;
    }
  }
  leaves = leaves || trial.iterations <= 0;
  settling.iterations = trial.iterations;
  hold_at(1, 1, s.holders, s.boundary);
  bring_to_rest(cable.state);
  if (leaves) {
    h = shortest_step(cable.model);
    return true;
  }
  cable.state = before;
  s.spans = spans_before;
  return false;
}

/// One substep towards equilibrium of a cable that may lie on obstacles and on itself. It has not converged, too, if nodes have
/// gone so far that they may have gone through something.
SubstepResult World::Implementation::settle_substep(Settling& settling, double h) {
  if (is_cancelled()) {
    settling.iterations = 0;
    return {};
  }
  const int index = settling.cable();
  ContactGroup& alone = settling.alone;
  SimulatedCable& cable = cables[index];
  CableScratch& s = scratch[index];
  const Environment environment{scene.gravity, scene.fluid};
  const Substep substep{cable.model, environment, s.boundary, s.spans, h, !settling.let_go};
  if (!settling.touches) {
    const SubstepResult result = s.stepper.advance(substep, cable.state);
    settling.iterations -= result.iterations;
    return result;
  }
  alone.contacts.find(cables, alone.cables, moving_obstacles, attachments, contact_rules(!settling.let_go), h);
  const CableState before = cable.state;
  const std::vector<TwistSpan> spans_before = s.spans;
  SubstepResult result;
  if (alone.contacts.touches().empty()) {
    result = s.stepper.advance(substep, cable.state);
  } else {
    alone.scratch.participants.clear();
    alone.scratch.participants.push_back({0, index, &s.stepper, substep, &cable.state, {}});
    alone.scratch.stepper.advance(alone.scratch.participants, alone.contacts.touches());
    result = alone.scratch.participants.front().result;
  }
  settling.iterations -= result.iterations;
  if (result.converged && result.displacement > settling_reach * cable.model.material.radius) {
    cable.state = before;
    s.spans = spans_before;
    result.converged = false;
  }
  if (result.converged) alone.contacts.keep();
  return result;
}

}  // namespace verlet_cable
