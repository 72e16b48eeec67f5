#include "world/body_settling.h"

#include <algorithm>
#include <cmath>

#include "guide/guides.h"
#include "guide/node_passing.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/cable_materials.h"
#include "world/flush_denormals.h"
#include "world/island_stepper.h"
#include "world/loads.h"
#include "world/straight_columns.h"

namespace verlet_cable {

namespace {

constexpr double first_step = 1e-3, last_step = 1e5;  // [s]
constexpr int maximum_steps = 2000;
/// It is given up after so many iterations, or as many as take some seconds, see `budget`.
constexpr double most_iterations = 2000;
constexpr double short_work = 4e7;
/// From one step to the next; the second once a step was too long.
constexpr double fastest_growth = 2, slow_growth = 1.3;
/// While what has begun to fall gets faster: it is followed, as longer steps would hold on to what does not last, but not for
/// ever.
constexpr double falling_growth = 1.02;
constexpr int calm_steps = 3;
/// What has moved by less in every step of so long a time [s] stands, too: rounding may keep longer ones from converging.
constexpr double long_time = 100;
constexpr double settled_displacement = 1e-6;  // radii
/// Where there is something to touch, no node goes further at a time than this, in radii.
constexpr double settling_reach = 1;
constexpr double settled_contact = 1e-4;       // radii
constexpr double settled_acceleration = 1e-7;  // [m/s^2]
/// [rad] of twist, and how often that is taken from a start.
constexpr double settled_twist = 1e-7;
constexpr int most_untwistings = 30;
/// Of the rounding of a shape: what is less deep in an obstacle lies on it.
constexpr double lying = 1e-3;

}  // namespace

BodySettling::BodySettling(const Island& island, State& state, Workspace& workspace, const std::atomic<bool>* cancelled)
    : cancelled_(cancelled), island_(island), state_(state), workspace_(workspace) {
  island_.pairs = {};
  if (workspace_.cables.size() < island_.cables.size()) workspace_.cables.resize(island_.cables.size());
  contacts_.resize(island_.cables.size());
  before_.resize(island_.cables.size());
  joined_mass_ = mass_of(island_, state_);
  for (const int cable : island_.cables)
    radius_ = std::min(
        radius_, CableMaterials(state_.cables[cable]).smallest([](const MaterialDesc& material) { return material.radius; }));
}

bool BodySettling::settle() {
  const FlushDenormals flush_denormals;
  hold_still();
  double h = first_step, last = infinity, growth = fastest_growth, stood = 0;
  const double size = size_of(island_, state_);
  double work_left = std::max(most_iterations * size, short_work);
  int calm = 0;
  for (int i = 0; i < maximum_steps && calm < calm_steps && work_left > 0; ++i) {
    if (cancelled_ != nullptr && *cancelled_) break;
    const Outcome outcome = advance(h);
    work_left -= size * workspace_.body_system.solutions();
    if (!outcome.converged) {
      h = std::max(0.25 * h, shortest_substep);
      growth = slow_growth;
      continue;
    }
    const double acceleration = 2 * outcome.displacement / (h * h);
    const bool stands = !outcome.touches || outcome.displacement < settled_contact * radius_;
    stood = outcome.displacement < settled_displacement * radius_ ? stood + h : 0;
    const bool is_long = h >= last_step || stood >= long_time;
    calm = acceleration < settled_acceleration && stands && (outcome.touches || is_long) ? calm + 1 : 0;
    const bool calms = outcome.touches || acceleration < last || h < first_step;
    h = std::min((calms ? growth : falling_growth) * h, last_step);
    last = acceleration;
  }
  complete();
  return calm >= calm_steps && !workspace_.contacts.is_stuck() && !workspace_.body_system.contacts().is_stuck();
}

bool BodySettling::settle_start() {
  bool settled = settle();
  for (int i = 0; i < most_untwistings && settled && untwist() > settled_twist; ++i) settled = settle();
  return settled;
}

bool BodySettling::is_inside_obstacle(const std::vector<char>& counts) {
  workspace_.members.clear();
  for (std::size_t k = 0; k < island_.cables.size(); ++k) {
    CableProgress& progress = state_.cable_progress[island_.cables[k]];
    workspace_.members.push_back({progress.id, &progress.targets, &contacts_[k]});
  }
  move_obstacles(state_, 1, 1, workspace_.obstacles);
  find_contacts_of(island_, state_, contact_rules(*state_.scene, true), first_step, workspace_);
  const std::vector<Touch>& touches = workspace_.body_system.contacts().touches();
  return std::any_of(touches.begin(), touches.end(), [&](const Touch& touch) {
    return counts[touch.body] != 0 && (touch.inside || touch.gap < -lying * touch.radius);
  });
}

/// Lets clamps on frames hold the material so that the cables have their rest twist between them and from junctions. Returns how
/// far from that they were [rad].
double BodySettling::untwist() {
  const auto& attachments = state_.attachments;
  const auto is_on_frame = [&](const DirectionTarget& clamp) { return attachments[clamp.attachment].holder < 0; };
  double most = 0;
  for (const int cable : island_.cables) {
    std::vector<DirectionTarget>& clamps = state_.cable_progress[cable].targets.directions;
    const bool is_branched = std::any_of(clamps.begin(), clamps.end(),
                                         [&](const DirectionTarget& c) { return attachments[c.attachment].is_junction; });
    if (is_branched) most = std::max(most, take_excess_twist(clamps, is_on_frame, state_.cables[cable].state));
  }
  return most;
}

/// Puts the holders where they are to be, and takes all motion away.
void BodySettling::hold_still() {
  for (const int body : island_.bodies) {
    state_.bodies[body].velocity = state_.bodies[body].angular_velocity = Vector3::Zero();
    state_.body_progress[body].acceleration = state_.body_progress[body].angular_acceleration = Vector3::Zero();
  }
  for (std::size_t k = 0; k < island_.cables.size(); ++k) {
    SimulatedCable& cable = state_.cables[island_.cables[k]];
    KinematicTargets& targets = state_.cable_progress[island_.cables[k]].targets;
    aim_targets(cable.state, state_.attachments, state_.frames.poses, state_.time(), targets);
    put_at_aim(targets);
    CableWorkspace& work = workspace_.cables[k];
    work.stepper.resize(cable.state.segments());
    work.boundary = {};
    hold_at(1, 1, targets, work.boundary);
    bring_to_rest(cable.state);
    stop_flows(island_.cables[k], state_);
  }
}

/// One substep towards equilibrium. It has not converged, too, if nodes have gone so far that they may have gone through
/// something; all is then as before.
BodySettling::Outcome BodySettling::advance(double h) {
  const Environment environment{state_.scene->gravity, state_.scene->fluid, no_waves};
  workspace_.members.clear();
  workspace_.participants.clear();
  for (std::size_t k = 0; k < island_.cables.size(); ++k) {
    const int index = island_.cables[k];
    CableProgress& progress = state_.cable_progress[index];
    CableWorkspace& work = workspace_.cables[k];
    SimulatedCable& cable = state_.cables[index];
    keep_twist(work.boundary, progress.targets);
    hold_at(1, 1, progress.targets, work.boundary);
    hold_on_bodies(cable.state, state_.attachments, state_.bodies, state_.time(), progress.targets, work.boundary);
    work.boundary.joined_mass = joined_mass_;
    workspace_.members.push_back({progress.id, &progress.targets, &contacts_[k]});
    load_flows(index, false, state_, work.boundary);
    load_nodes(index, state_, work.boundary);
    Substep substep{*cable.model, environment, work.boundary, progress.spans, h, true};
    substep.touches_bodies = true;
    workspace_.participants.push_back({static_cast<int>(k), index, &work.stepper, substep, &cable.state, &work.result});
    before_[k] = cable.state;
  }
  move_obstacles(state_, 1, 1, workspace_.obstacles);
  find_contacts_of(island_, state_, contact_rules(*state_.scene, true), h, workspace_);
  workspace_.body_members.clear();
  for (const int body : island_.bodies)
    if (state_.body_progress[body].is_placed)
      workspace_.body_members.push_back({body, &state_.bodies[body], &state_.body_progress[body]});
  BodySystem& system = workspace_.body_system;
  system.begin(workspace_.body_members, workspace_.participants, state_.bodies, state_.loads, environment, {h, true});
  find_body_joints(island_, state_, 1, workspace_);

  Outcome outcome;
  std::vector<Touch>& touches = workspace_.contacts.touches();
  outcome.touches = !touches.empty() || !system.contacts().touches().empty();
  if (outcome.touches)
    outcome.converged = workspace_.contact_solver.solve(workspace_.participants, touches, &system, infinity);
  else
    outcome.converged = system.advance(workspace_.participants, state_.scene->tolerance);
  for (const Participant& p : workspace_.participants)
    outcome.converged = outcome.converged && gives_way(p, touches, state_) == GivesWay::no;
  if (!outcome.converged) return outcome;

  system.contacts().follow_obstacles();
  system.place_at_end(workspace_.participants);
  for (Participant& p : workspace_.participants) {
    p.stepper->finish(p.substep, false, *p.state, *p.result);
    outcome.displacement = std::max(outcome.displacement, p.result->displacement);
  }
  outcome.displacement = std::max(outcome.displacement, system.largest_displacement());
  if (outcome.touches && outcome.displacement > settling_reach * radius_) {
    for (std::size_t k = 0; k < island_.cables.size(); ++k) state_.cables[island_.cables[k]].state = before_[k];
    outcome.converged = false;
    return outcome;
  }
  for (std::size_t m = 0; m < workspace_.body_members.size(); ++m) {
    const int body = workspace_.body_members[m].body;
    system.finish(static_cast<int>(m), state_.bodies[body], state_.body_progress[body]);
    state_.frames.poses[state_.bodies[body].frame] = state_.bodies[body].pose;
  }
  for (const BodyJoint& joint : system.joints()) {
    state_.attachments[joint.attachment].force = -joint.force;
    state_.attachments[joint.attachment].torque = -joint.torque;
  }
  keep_body_joints(island_, system.joints(), state_);
  workspace_.contacts.keep(workspace_.members);
  for (const BodyMember& member : workspace_.body_members)
    BodyTouches::keep(member.body, system.contacts().touches(), state_.body_progress[member.body].contacts);
  pass_nodes_of_guides();
  return outcome;
}

/// What of the cables has come to their guides goes through.
void BodySettling::pass_nodes_of_guides() {
  for (std::size_t k = 0; k < island_.cables.size(); ++k) {
    const int index = island_.cables[k];
    CableProgress& progress = state_.cable_progress[index];
    if (!slides(progress.targets) || !pass_nodes(index, false, state_)) continue;
    CableWorkspace& work = workspace_.cables[k];
    bring_to_rest(state_.cables[index].state);
    work.stepper.resize(state_.cables[index].state.segments());
    for (std::size_t n = 0; n < work.boundary.nodes.size(); ++n) work.boundary.nodes[n].node = progress.targets.nodes[n].node;
    for (std::size_t d = 0; d < work.boundary.directions.size(); ++d)
      work.boundary.directions[d].node = progress.targets.directions[d].node;
    contacts_[k].clear();
    progress.spans = find_spans(state_.cables[index].state, work.boundary.directions);
  }
}

/// The cables' targets follow the bodies.
void BodySettling::complete() {
  for (const int body : island_.bodies) state_.frames.previous_poses[state_.bodies[body].frame] = state_.bodies[body].pose;
  for (std::size_t k = 0; k < island_.cables.size(); ++k) {
    const int index = island_.cables[k];
    CableProgress& progress = state_.cable_progress[index];
    CableState& cable = state_.cables[index].state;
    Boundary& boundary = workspace_.cables[k].boundary;
    keep_twist(boundary, progress.targets);
    forget_forces(progress.targets, state_.attachments);
    add_forces(boundary, progress.targets, state_.frames.poses, 1, state_.attachments);
    follow_bodies(boundary, progress.targets);
    for (std::size_t n = 0; n < boundary.nodes.size(); ++n) {
      if (boundary.nodes[n].body < 0) continue;
      KinematicTarget& target = progress.targets.nodes[n];
      target.position = target.next_position;
      target.velocity = target.mean_velocity = target.next_velocity = Vector3::Zero();
    }
    for (std::size_t d = 0; d < boundary.directions.size(); ++d)
      if (boundary.directions[d].body >= 0)
        progress.targets.directions[d].orientation = progress.targets.directions[d].next_orientation;
    follow_material(*state_.cables[index].model, boundary.directions, progress.spans, cable);
  }
}

bool settle_bodies(const std::vector<char>& settles, bool start, State& state, Workspace& workspace,
                   std::vector<std::string>& unsettled, const std::atomic<bool>* cancelled) {
  Islands islands;
  islands.build(state);
  bool all = true;
  for (const Island& island : islands.all()) {
    const bool asked = std::any_of(island.cables.begin(), island.cables.end(), [&](int cable) { return settles[cable] != 0; });
    if (island.bodies.empty() || !asked) continue;
    BodySettling settling(island, state, workspace, cancelled);
    if (start ? settling.settle_start() : settling.settle()) continue;
    all = false;
    for (const int cable : island.cables) {
      const std::string& name = state.cables[cable].model->name;
      if (settles[cable] != 0 && std::find(unsettled.begin(), unsettled.end(), name) == unsettled.end())
        unsettled.push_back(name);
    }
  }
  return all;
}

}  // namespace verlet_cable
