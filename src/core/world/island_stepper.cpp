#include "world/island_stepper.h"

#include <algorithm>
#include <cmath>

#include "guide/guides.h"
#include "guide/node_passing.h"
#include "rod/bending_memory.h"
#include "rod/initial_shape.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/rotation.h"
#include "world/balance.h"
#include "world/energy.h"
#include "world/loads.h"
#include "world/straight_columns.h"

namespace verlet_cable {

namespace {

using Status = StepResult::Status;

/// Of what starts inside an obstacle or another cable, in radii: no room to get out of it by more in a substep.
constexpr double least_separation = 1e-4;

/// [s] What gets into an obstacle between two steps has found its way out by then.
constexpr double patience = 0.05;

bool cannot_get_apart(const Touch& touch) {
  const bool should_have_moved = touch.yields || touch.inside_for > patience;
  return should_have_moved && touch.normal.dot(touch.displacement) < least_separation * touch.radius;
}

bool are_of_same(const Intrusion& a, const Intrusion& b) {
  return a.cable == b.cable && a.obstacle == b.obstacle;
}
bool are_of_same(const BodyIntrusion& a, const BodyIntrusion& b) {
  return a.body == b.body && a.obstacle == b.obstacle;
}

/// Of what is inside of what, the deepest.
template <class Found>
void note_deepest(const Found& found, std::vector<Found>& noted) {
  const auto same = std::find_if(noted.begin(), noted.end(), [&](const Found& other) { return are_of_same(other, found); });
  if (same == noted.end()) {
    noted.push_back(found);
  } else if (same->depth < found.depth) {
    *same = found;
  }
}

/// The segment of a cable that breaks now, -1 if it holds. A piece keeps at least one segment, so that the outermost ones do not
/// break.
int find_breaking_segment(const SimulatedCable& cable, const StepResult& result) {
  const CableMaterials materials(cable);
  const std::vector<double>& tension = cable.state.tension;
  const int last = static_cast<int>(tension.size()) - 1;
  if (last < 2 || !materials.any([](const MaterialDesc& material) { return material.breaking_tension < infinity; })) return -1;
  const auto load = [&](int i) { return materials.vary() ? tension[i] / materials[i].breaking_tension : tension[i]; };
  const auto limited = [&](int i) { return materials[i].breaking_tension < infinity; };
  int weakest = -1, broken = -1;
  for (int i = 0; i <= last; ++i) {
    if (tension[i] > materials[i].breaking_tension) broken = i;
    if (i > 0 && i < last && limited(i) && (weakest < 0 || load(i) > load(weakest))) weakest = i;
  }
  // What cannot stretch and is pulled beyond its length breaks at any strength.
  const bool torn = result.status == StepResult::Status::overstretched && !materials.any_elastic();
  if (weakest < 0) return broken < 0 ? -1 : std::clamp(broken, 1, last - 1);
  return torn || broken >= 0 ? weakest : -1;
}

/// What bodies hold may give in where its solver finds no other way, though no frames are too far apart for it: strain beyond
/// this of what cannot stretch is told.
constexpr double told_strain = 1e-2;

/// The inextensible segment of a cable that is strained most, if that is told; else -1.
int find_strained_segment(const SimulatedCable& cable) {
  const CableMaterials materials(cable);
  double greatest = told_strain;
  int found = -1;
  for (int i = 0; i < cable.state.segments(); ++i) {
    if (is_elastic(materials[i]) || !(std::abs(strain(cable.state, i)) > greatest)) continue;
    greatest = std::abs(strain(cable.state, i));
    found = i;
  }
  return found;
}

}  // namespace

bool finite(const std::vector<Vector3>& vectors) {
  return std::all_of(vectors.begin(), vectors.end(), [](const Vector3& v) { return v.allFinite(); });
}

Vector3 gravity_near(const State& state, int cable) {
  return state.scene->gravity.at(state.cables[cable].state.positions.front());
}

void move_obstacles(const State& state, double from, double to, std::vector<MovingObstacle>& moving) {
  const Frames& frames = state.frames;
  move_obstacles(state.obstacles, {frames.earlier_poses, frames.previous_poses, frames.poses}, state.scene->time_step, from, to,
                 moving);
}

ContactRules contact_rules(const SceneDesc& scene, bool still) {
  ContactRules rules;
  rules.still = still;
  rules.time_step = scene.time_step;
  if (scene.contact) {
    rules.pairs = {scene.contact->self, scene.contact->between_cables};
    rules.cable_friction = scene.contact->friction;
  }
  return rules;
}

void find_contacts_of(Island& island, const State& state, const ContactRules& rules, double h, Workspace& workspace) {
  std::vector<Touch>& on_obstacles = workspace.body_system.contacts().touches();
  on_obstacles.clear();
  workspace.surfaces.clear();
  for (const int index : island.bodies) {
    const SimulatedBody& body = state.bodies[index];
    const BodyProgress& progress = state.body_progress[index];
    if (body.shapes.empty() || !progress.is_placed) continue;
    workspace.surfaces.add(index, body, progress, h);
    workspace.body_touches.find({index, &body, &progress}, island.held, state.attachments, workspace.obstacles, rules, h,
                                on_obstacles);
  }
  workspace.contacts.find(state.cables, island.cables, workspace.members, workspace.obstacles, workspace.surfaces.all(),
                          state.attachments, rules, h, island.pairs);
}

void note_status(Status status, const BodyId& body, int node, StepResult& result, DegradedCause cause) {
  if (status <= result.status) return;
  result.status = status;
  result.body = body;
  result.node = node;
  result.cause = cause;
}

void add_forces(const Boundary& boundary, const KinematicTargets& targets, const std::vector<Pose>& frames, double weight,
                std::vector<Attachment>& attachments) {
  for (std::size_t k = 0; k < boundary.nodes.size(); ++k) {
    Attachment& attachment = attachments[targets.nodes[k].attachment];
    const Vector3 force = weight * boundary.nodes[k].force;
    const Vector3 arm = boundary.nodes[k].position - (frames[attachment.frame] * attachment.pose).position;
    attachment.force += force;
    if (targets.nodes[k].node != attachment.node) attachment.torque += arm.cross(force);
  }
  for (std::size_t k = 0; k < boundary.directions.size(); ++k)
    attachments[targets.directions[k].attachment].torque += weight * boundary.directions[k].torque;
}

void follow_material(const CableModel& model, const std::vector<HeldDirection>& directions, const std::vector<TwistSpan>& spans,
                     CableState& state) {
  if (!state.directors.empty()) return;  // its segments know
  if (directions.empty()) {
    const Vector3 before = state.reference_orientation * Vector3::UnitX(), now = state.positions[1] - state.positions[0];
    state.reference_node = 0;
    state.reference_orientation = (smallest_rotation(before, now) * state.reference_orientation).normalized();
  } else {
    state.reference_node = directions.front().node;
    state.reference_orientation = directions.front().end;
  }
  spread_twist(model, spans, state);
}

void forget_forces(const KinematicTargets& targets, std::vector<Attachment>& attachments) {
  for (const KinematicTarget& target : targets.nodes) {
    Attachment& attachment = attachments[target.attachment];
    attachment.force = attachment.torque = Vector3::Zero();
  }
}

bool follows_bodies(const KinematicTargets& targets, const std::vector<Attachment>& attachments) {
  return std::any_of(targets.nodes.begin(), targets.nodes.end(),
                     [&](const KinematicTarget& target) { return attachments[target.attachment].holder >= 0; });
}

namespace {

/// Takes along, with holders that jump or begin to move, what cannot stretch.
void follow_abrupt_holders(int index, const Following& following, State& state, CableOutcome& outcome) {
  SimulatedCable& cable = state.cables[index];
  KinematicTargets& targets = state.cable_progress[index].targets;
  Boundary boundary;
  hold_at(0, 0, targets, boundary);
  if (following.jumping_node >= 0) {
    carry_straight_columns(index, state);
    // Bodies are carried with the cable.
    std::vector<HeldNode> held;
    for (std::size_t k = 0; k < boundary.nodes.size(); ++k)
      if (state.attachments[targets.nodes[k].attachment].holder < 0) held.push_back(boundary.nodes[k]);
    carry_with_targets(*cable.model, held, gravity_near(state, index), cable.state);
    measure_joint_twists(targets.directions, cable.state);
    note_status(Status::jumped, cable_id(index), following.jumping_node, outcome.result);
  }
  if (follows_bodies(targets, state.attachments)) return;
  move_with_holders(index, state);
}

}  // namespace

void update_targets(int index, State& state, CableOutcome& outcome, std::vector<HeldDirection>& directions) {
  SimulatedCable& cable = state.cables[index];
  KinematicTargets& targets = state.cable_progress[index].targets;
  aim_targets(cable.state, state.attachments, state.frames.poses, state.time(), targets);
  forget_forces(targets, state.attachments);
  outcome.jumps.clear();
  const bool were_shown = std::any_of(targets.nodes.begin(), targets.nodes.end(),
                                      [](const KinematicTarget& target) { return target.jumping_steps > 0; });
  take_back_shown_velocities(targets, cable.state.velocities);
  const Following following = follow_aims(state.attachments, state.time(), step_of_frames(state), targets, outcome.jumps);
  const bool jumps = following.jumping_node >= 0;
  if (following.started || jumps) follow_abrupt_holders(index, following, state, outcome);
  if (!jumps) buckle_straight_columns(index, state);
  if (!were_shown && !following.started && !jumps) return;
  const double change = follow_energy_of_cable(index, state, directions);
  outcome.change += change;
  account_for_displacement(change, outcome.balance);
}

namespace {

/// The same of a whole rod: joints grow with the cable that they stand for, and the material that is in the clamp is turned
/// against what was there before.
void pass_twist_through_winch(const LengthDrive& drive, const CableModel& model, CableState& state, KinematicTargets& targets) {
  const int n = state.segments(), end = drive.end_node(n), next = end == 0 ? 1 : n - 1;
  const double side = end == 0 ? -1 : 1;
  const auto grow = [&](int node) {
    const double length = joint_length(state, node), before = length - 0.5 * drive.fed();
    const double turn = material_twist(model, state, node) * (length / before - 1);
    state.joint_twist[node] += turn;
    return side * turn;
  };
  const double turn = next > 0 && next < n ? grow(next) : 0;
  turn_segment(drive.segment, turn, state);
  for (DirectionTarget& clamp : targets.directions)
    if (clamp.node == end) turn_in_clamp(turn + grow(end), clamp);
}

}  // namespace

void complete_drive_step(int index, State& state) {
  CableProgress& memory = state.cable_progress[index];
  SimulatedCable& cable = state.cables[index];
  LengthDrive& drive = *memory.drive;
  wind(drive, 1, state.scene->time_step, *cable.model, cable.state);
  if (drive.is_winch()) {
    // What goes through the winch is as twisted as the cable is.
    const int end = drive.end_node(cable.state.segments());
    for (TwistSpan& span : memory.spans) {
      if (span.first_node != end && span.last_node != end) continue;
      const double length = cable.state.length(span.first_node, span.last_node);
      const double change = CableMaterials(cable).vary() ? cable.state.twist[drive.segment] * drive.fed()
                                                         : span.angle * drive.fed() / (length - drive.fed());
      span.angle += change;
      span.origin -= change;
    }
    if (!cable.state.directors.empty()) pass_twist_through_winch(drive, *cable.model, cable.state, memory.targets);
    // What comes out of a winch remembers nothing, what it takes in is forgotten.
    const double out = drive.fed();
    if (!cable.state.bending_memory.empty())
      end == 0 ? carry_bends(0, {out, 0.5 * out}, cable.state)
               : carry_bends(2 * drive.segment + 1, {-0.5 * out, -out}, cable.state);
  }
  if (!complete_drive(state.scene->time_step, drive)) memory.drive.reset();
}

void keep_flow_at_drive(int index, double part, State& state) {
  const SimulatedCable& cable = state.cables[index];
  std::optional<LengthDrive>& drive = state.cable_progress[index].drive;
  if (drive) keep_flow(part, state.scene->time_step, *cable.model, cable.state, *drive);
}

IslandStepper::IslandStepper(State& state, Workspace& workspace, std::vector<CableOutcome>& outcomes, int lanes)
    : state_(state),
      workspace_(workspace),
      outcomes_(outcomes),
      environment_{state.scene->gravity, state.scene->fluid, state.waves},
      lanes_(lanes) {}

void IslandStepper::step(Island& island, IslandOutcome& found) {
  found.intrusions.clear();
  found.body_intrusions.clear();
  found.contacts.clear();
  found.jumps.clear();
  found.bodies = {};
  found.unfinished.reset();
  found.exhausted = false;
  found.balance = {};
  found.change = 0;
  bool contacts_known = false;
  if (!wait_for_others(island, found, contacts_known)) step_alone(island, found, contacts_known);
}

void IslandStepper::begin(const Island& island) {
  if (workspace_.cables.size() < island.cables.size()) workspace_.cables.resize(island.cables.size());
  workspace_.members.clear();
  // Islands without bodies must not meet those of the last one.
  workspace_.body_members.clear();
  workspace_.body_system.joints().clear();
  joined_mass_ = island.bodies.empty() ? 0 : mass_of(island, state_);
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    CableProgress& memory = state_.cable_progress[island.cables[k]];
    workspace_.members.push_back({memory.id, &memory.targets, &memory.contacts});
    workspace_.cables[k].stepper.resize(state_.cables[island.cables[k]].state.segments());
    workspace_.cables[k].boundary.growing.clear();
  }
}

/// One substep, from one part of the step to another, whose contacts have been found. False if it has not converged, cables have
/// passed through each other, or some would have to fold (where that is not `tolerated`); the states are then as before, but for
/// what has folded.
bool IslandStepper::advance(Island& island, double from, double to, bool tolerated) {
  const double h = (to - from) * state_.scene->time_step;
  const bool touching = touches();
  substep_ = {};
  bends_columns_ = false;
  workspace_.participants.clear();
  const Scheme touching_scheme = find_touching_scheme(island, h);
  bool converged = true;
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    const int cable = island.cables[k];
    SimulatedCable& c = state_.cables[cable];
    CableProgress& memory = state_.cable_progress[cable];
    CableWorkspace& work = workspace_.cables[k];
    hold_at(from, to, memory.targets, work.boundary);
    load_flows(cable, true, state_, work.boundary);
    load_nodes(cable, state_, work.boundary);
    if (!island.bodies.empty())
      hold_on_bodies(c.state, state_.attachments, state_.bodies, state_.time(), memory.targets, work.boundary);
    work.boundary.joined_mass = joined_mass_;
    const bool touches = workspace_.contacts.touched(k), on_bodies = work.boundary.is_on_bodies();
    const Scheme scheme = touches || on_bodies ? touching_scheme : scheme_of(cable);
    if (memory.drive) {
      const double before = energy_at(cable, from);
      work.wound = wind_drive(cable, scheme, from, to, work.boundary);
      outcomes_[cable].balance.work.winches += energy_at(cable, from) - before;
    }
    if (is_kept(island, k)) {
      work.before = c.state;
      work.spans_before = memory.spans;
    }
    Substep substep{*c.model, environment_, work.boundary, memory.spans, h};
    substep.middle = middle_of(from, to);
    substep.scheme = scheme;
    substep.tolerance = state_.scene->tolerance;
    substep.touches_bodies = workspace_.contacts.touches_body(k);
    if (state_.scene->numerical_damping)
      substep.treatment = touches || on_bodies || to - from < 1 ? Treatment::damping : Treatment::cleaning;
    if (touches || on_bodies) {
      work.result = {};
      workspace_.participants.push_back({static_cast<int>(k), cable, &work.stepper, substep, &c.state, &work.result});
    } else {
      work.result = work.stepper.advance(substep, c.state);
      converged = converged && work.result.converged;
    }
  }
  BodySystem* const bodies = island.bodies.empty() ? nullptr : &workspace_.body_system;
  if (bodies != nullptr) begin_bodies(island, from, to, touching_scheme);
  if (converged && bodies != nullptr && !touching)
    converged = advance_bodies(from, tolerated) || advance_straight_bodies(island, from, to, touching_scheme, tolerated);
  contact_work_ = 0;
  if (converged && touching) {
    ContactSolver& solver = workspace_.contact_solver;
    converged =
        solver.solve(workspace_.participants, workspace_.contacts.touches(), bodies, most_contact_work_) &&
        (tolerated || (!solver.crosses(workspace_.participants, workspace_.contacts.touches()) && !columns_give_way(from)));
    contact_work_ = solver.work();
    if (converged) {
      solver.finish(workspace_.participants, workspace_.contacts.touches());
      balance_contacts(workspace_.contacts.touches(), substep_);
      balance_contacts(workspace_.body_system.contacts().touches(), substep_);
    }
  }
  converged = converged && is_finite(island);
  if (converged) {
    if (!island.bodies.empty()) finish_bodies(island, from, to);
    for (std::size_t k = 0; k < island.cables.size(); ++k) {
      keep_twist(workspace_.cables[k].boundary, state_.cable_progress[island.cables[k]].targets);
      keep_lasting_forces(workspace_.cables[k].boundary, state_.cable_progress[island.cables[k]].targets);
      keep_flows(island.cables[k], workspace_.cables[k].boundary, state_);
      keep_flow_at_drive(island.cables[k], workspace_.cables[k].wound, state_);
      slip_at_winch(island.cables[k], workspace_.cables[k].wound, from, to, workspace_.cables[k].boundary);
    }
    workspace_.contacts.keep(workspace_.members);
  } else {
    take_back(island);
  }
  return converged;
}

/// Changes what gets a seed, as an edit would; the others are as before. `part`: of the step, where the substep begins.
bool IslandStepper::columns_give_way(double part) {
  bool give_way = false;
  for (const Participant& p : workspace_.participants) {
    const double before = energy_at(p.cable, part);
    const GivesWay gives = gives_way(p, workspace_.contacts.touches(), state_);
    if (gives == GivesWay::no) continue;
    give_way = true;
    if (gives == GivesWay::shorter) continue;
    bends_columns_ = outcomes_[p.cable].gave_way = true;
    account_for_edit(energy_at(p.cable, part) - before, outcomes_[p.cable].balance);
  }
  return give_way;
}

void IslandStepper::find_contacts(Island& island, double from, double to) {
  move_obstacles(state_, from, to, workspace_.obstacles);
  find_contacts_of(island, state_, contact_rules(*state_.scene, false), (to - from) * state_.scene->time_step, workspace_);
}

bool IslandStepper::touches() const {
  return !workspace_.contacts.touches().empty() || !workspace_.body_system.contacts().touches().empty();
}

Scheme IslandStepper::scheme_of(int cable) const {
  const SimulatedCable& c = state_.cables[cable];
  return state_.scene->numerical_damping ? next_scheme(*c.model, c.state) : Scheme::conserving;
}

/// Cables that touch something, or that bodies hold, go by one scheme, which their contacts and bodies heed: where one is to
/// damp, all do, as much; where anything touches or slides through guides, so that forces which begin or end make no energy.
Scheme IslandStepper::find_touching_scheme(const Island& island, double h) {
  Scheme scheme = Scheme::conserving;
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    if (!workspace_.contacts.touched(k) && island.bodies.empty()) continue;
    scheme = std::max(scheme, scheme_of(island.cables[k]));
  }
  if (scheme == Scheme::conserving) return scheme;
  const auto slides = [&](int cable) { return count_flows(cable, state_) > 0; };
  if (touches() || std::any_of(island.cables.begin(), island.cables.end(), slides)) scheme = Scheme::dissipative;
  workspace_.contacts.follow_scheme(scheme, state_.cables, h);
  BodyTouches::follow_scheme(scheme, contact_rules(*state_.scene, false), h, workspace_.body_system.contacts().touches());
  return scheme;
}

/// [s] The world's time in the middle of a part of the step.
double IslandStepper::middle_of(double from, double to) const {
  return state_.time() + (0.5 * (from + to) - 1) * state_.scene->time_step;
}

/// [J]
double IslandStepper::energy_at(int cable, double part) {
  return energy_of_cable(state_, cable, part, workspace_.directions).total();
}

double IslandStepper::wind_drive(int index, Scheme scheme, double from, double to, Boundary& boundary) {
  const LengthDrive& drive = *state_.cable_progress[index].drive;
  SimulatedCable& cable = state_.cables[index];
  // An inextensible segment has its length at the end of the substep, an elastic one strains about that where its forces are
  // taken.
  const bool elastic = is_elastic(CableMaterials(cable)[drive.segment]);
  const bool in_the_middle = elastic && scheme == Scheme::conserving;
  const double part = in_the_middle ? 0.5 * (from + to) : to;
  const double time_step = state_.scene->time_step;
  wind(drive, part, time_step, *cable.model, cable.state);
  GrowingSegment growing{drive.segment, growth_at(drive, to)};
  growing.way = planned_length(drive, to, time_step) - planned_length(drive, from, time_step);
  growing.left = planned_length(drive, to, time_step) - cable.state.rest_lengths[drive.segment];
  growing.law = winch_law(drive, to, (to - from) * time_step, time_step);
  boundary.growing.assign(1, growing);
  return part;
}

/// What a winch has let through beyond what was planned, as its tension was, in a substep that has converged.
void IslandStepper::slip_at_winch(int index, double wound, double from, double to, const Boundary& boundary) {
  for (const GrowingSegment& growing : boundary.growing) {
    if (growing.law.tension == infinity) continue;
    SimulatedCable& cable = state_.cables[index];
    const double before = energy_at(index, to);
    slip(growing.beyond, wound < to ? 0.5 : 1, (to - from) * state_.scene->time_step, *cable.model, cable.state,
         *state_.cable_progress[index].drive);
    outcomes_[index].balance.work.winches += energy_at(index, to) - before;
  }
}

/// What touches is left as it is until all have converged, but for what slides through guides.
bool IslandStepper::is_kept(const Island& island, std::size_t k) const {
  const Boundary& boundary = workspace_.cables[k].boundary;
  return !boundary.flows.empty() || (island.cables.size() > 1 && !workspace_.contacts.touched(k) && !boundary.is_on_bodies());
}

/// Of cables that slide through guides; those that are not have not converged.
bool IslandStepper::is_finite(const Island& island) {
  bool all = true;
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    if (workspace_.cables[k].boundary.flows.empty()) continue;
    const CableState& state = state_.cables[island.cables[k]].state;
    if (finite(state.positions) && finite(state.velocities)) continue;
    workspace_.cables[k].result.converged = all = false;
  }
  return all;
}

void IslandStepper::take_back(const Island& island) {
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    if (!is_kept(island, k)) continue;
    state_.cables[island.cables[k]].state = workspace_.cables[k].before;
    state_.cable_progress[island.cables[k]].spans = workspace_.cables[k].spans_before;
  }
}

void IslandStepper::note_intrusions(std::vector<Intrusion>& noted) const {
  for (const Intrusion& found : workspace_.contacts.intrusions()) note_deepest(found, noted);
}

void IslandStepper::complete(const Island& island, const StepProgress& progress, IslandOutcome& found) {
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    state_.cable_progress[island.cables[k]].level = progress.level;
    complete_cable(island.cables[k], workspace_.cables[k].boundary, progress.substeps);
  }
  for (const int body : island.bodies) found.change += follow_energy_of_body(body, state_);
  for (const Touch& touch : workspace_.body_system.contacts().touches())
    if (is_pushed_out(touch)) note_deepest(BodyIntrusion{touch.body, touch.obstacle, touch.inside_depth}, found.body_intrusions);
  for (const Touch& touch : workspace_.contacts.touches()) {
    if (touch.mode == Touch::Mode::open) continue;
    if (cannot_get_apart(touch))
      note_status(Status::degraded, cable_id(touch.point.cable), touch.point.segment, outcomes_[touch.point.cable].result,
                  DegradedCause::no_room);
  }
}

void IslandStepper::complete_cable(int index, const Boundary& boundary, int substeps) {
  CableProgress& memory = state_.cable_progress[index];
  CableState& state = state_.cables[index].state;
  follow_bodies(boundary, memory.targets);
  const bool winds = memory.drive && memory.drive->is_winch();
  if (memory.drive) {
    const double before = energy_at(index, 1);
    complete_drive_step(index, state_);
    outcomes_[index].balance.work.winches += energy_at(index, 1) - before;
  }
  follow_material(*state_.cables[index].model, boundary.directions, memory.spans, state);
  StepResult& result = outcomes_[index].result;
  result.substeps = substeps;
  if (boundary.is_on_bodies() && result.max_strain > told_strain) {
    const int strained = find_strained_segment(state_.cables[index]);
    if (strained >= 0) note_status(StepResult::Status::overstretched, cable_id(index), strained, result);
  }
  outcomes_[index].breaking_segment = find_breaking_segment(state_.cables[index], result);
  complete_step(state_.scene->time_step, memory.targets);
  show_velocities(memory.targets, state.velocities);
  if (winds && !memory.drive) close_clamps(index);
  outcomes_[index].change += follow_energy_of_cable(index, state_, workspace_.directions);
}

/// What a winch has left is held by clamps again, from where it is.
void IslandStepper::close_clamps(int index) {
  KinematicTargets& targets = state_.cable_progress[index].targets;
  targets = find_targets(*state_.cables[index].model, state_.cables[index].state, state_.attachments,
                         attachments_of(cable_id(index), state_.attachments), state_.frames.poses, targets, state_.time());
}

}  // namespace verlet_cable
