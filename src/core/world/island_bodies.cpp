#include <algorithm>
#include <cmath>

#include "rod/initial_shape.h"
#include "rod/rod_frames.h"
#include "target/jump.h"
#include "world/balance.h"
#include "world/energy.h"
#include "world/island_stepper.h"
#include "world/junctions.h"

namespace verlet_cable {

namespace {

/// Where a frame is in a part of the step, 0 to 1.
Pose frame_at(const Frames& frames, int frame, double part) {
  return between(frames.previous_poses[frame], frames.poses[frame], part);
}

/// [rad/s] The mean over the step of an attachment to a frame.
Vector3 mean_spin(const Frames& frames, const Attachment& attachment, double time_step) {
  const Quaternion turn =
      frames.poses[attachment.frame].orientation * frames.previous_poses[attachment.frame].orientation.conjugate();
  return rotation_vector(turn) / time_step;
}

/// Of a joint of a body to a frame.
const KinematicTarget& holder_of(const BodyJoint& joint, const State& state) {
  const std::vector<KinematicTarget>& holders = state.body_progress[held_body(state.attachments[joint.attachment])].holders;
  return *std::find_if(holders.begin(), holders.end(),
                       [&](const KinematicTarget& target) { return target.attachment == joint.attachment; });
}

/// [m] Nodes that are so far from where bodies hold them have been left behind.
constexpr double carried_away = 1e-6;
constexpr double least_size = 1e-3;  // [m] of what has none
/// A change of a holder's velocity that moves a body by less in a substep, in parts of its size or rad, goes unnoticed.
constexpr double noticed_jerk = 1e-9;

constexpr double longest_part_without_room = 0.25;  // of a step

/// Of what has converged.
bool is_drawn_out(const Participant& p) {
  if (!p.stepper->keeps_lengths()) return true;
  if (p.substep.gives_in_on_bodies) return false;
  return (p.substep.strains_on_bodies || is_drawn_out_on_bodies(p.substep, *p.state)) &&
         p.stepper->greatest_tension_of_taut() > greatest_tension_on_bodies(p.substep, *p.state);
}

}  // namespace

void find_body_joints(const Island& island, const State& state, double to, Workspace& workspace) {
  BodySystem& system = workspace.body_system;
  system.joints().clear();
  for (const int a : island.held) {
    const Attachment& attachment = state.attachments[a];
    BodyJoint joint;
    joint.attachment = a;
    joint.type = attachment.type;
    joint.member = system.member_of(held_body(attachment));
    joint.at = attachment.at;
    joint.other = attachment.holder < 0 ? -1 : system.member_of(attachment.holder);
    joint.holder = joint.other < 0 ? frame_at(state.frames, attachment.frame, to) * attachment.pose : attachment.pose;
    const std::vector<JointProgress>& known = state.body_progress[held_body(attachment)].joints;
    const auto before = std::find_if(known.begin(), known.end(), [&](const JointProgress& p) { return p.attachment == a; });
    if (before != known.end()) {
      joint.force = before->force;
      joint.torque = before->torque;
      joint.lasting = {before->lasting_force, before->lasting_torque};
    }
    if (joint.member >= 0) system.joints().push_back(joint);
  }
}

void keep_body_joints(const Island& island, const std::vector<BodyJoint>& joints, State& state) {
  for (const int body : island.bodies) state.body_progress[body].joints.clear();
  for (const BodyJoint& joint : joints)
    state.body_progress[held_body(state.attachments[joint.attachment])].joints.push_back(
        {joint.attachment, joint.force, joint.torque, joint.lasting.force, joint.lasting.torque});
}

/// Puts the bodies of an island where the substep begins; the cables that they hold take part.
void IslandStepper::begin_bodies(const Island& island, double from, double to, Scheme scheme) {
  const SubstepRules rules{(to - from) * state_.scene->time_step, false, scheme, middle_of(from, to)};
  std::vector<BodyMember>& members = workspace_.body_members;
  members.clear();
  for (const int body : island.bodies)
    if (state_.body_progress[body].is_placed) members.push_back({body, &state_.bodies[body], &state_.body_progress[body]});
  workspace_.body_system.begin(members, workspace_.participants, state_.bodies, state_.loads, environment_, rules);
  projects_bodies_ = scheme != Scheme::conserving || touches();
  find_body_joints(island, state_, to, workspace_);
  for (BodyJoint& joint : workspace_.body_system.joints())
    if (joint.other < 0) follow_body_holder(joint, to);
  for (const BodyMember& member : members) projects_bodies_ = projects_bodies_ || !member.progress->has_moved;
  for (const Participant& p : workspace_.participants)
    projects_bodies_ = projects_bodies_ || !p.substep.boundary.growing.empty() || holders_accelerate(p.substep, *p.state);
}

/// Those that touch nothing, by one substep. False if it has not converged.
bool IslandStepper::advance_bodies(double from, bool tolerated) {
  BodySystem& system = workspace_.body_system;
  std::vector<Participant>& participants = workspace_.participants;
  const bool converged = system.advance(participants, state_.scene->tolerance) &&
                         std::none_of(participants.begin(), participants.end(), is_drawn_out) &&
                         (tolerated || !columns_give_way(from));
  if (converged) {
    system.place_at_end(participants);
    for (Participant& p : participants) p.stepper->finish(p.substep, false, *p.state, *p.result);
  }
  return converged;
}

/// Bodies in line, on what is pulled straight and cannot stretch, had no solution: they have one if that strains a little, or
/// gives in where it is too short for the frames that draw them.
bool IslandStepper::advance_straight_bodies(const Island& island, double from, double to, Scheme scheme, bool tolerated) {
  std::vector<Participant>& participants = workspace_.participants;
  const bool straight = std::any_of(participants.begin(), participants.end(),
                                    [](const Participant& p) { return is_straight_on_bodies(p.substep, *p.state); });
  if (!straight) return false;
  for (Participant& p : participants) p.substep.strains_on_bodies = true;
  begin_bodies(island, from, to, scheme);
  if (advance_bodies(from, tolerated)) return true;
  // A pin, too, may have drawn nodes to its body; what that leaves a shorter substep finds room for.
  const bool has_no_room = to - from <= longest_part_without_room;
  const bool overstretched = std::any_of(participants.begin(), participants.end(), [&](const Participant& p) {
    return p.result->converged ? is_drawn_out(p) : has_no_room && is_drawn_out_on_bodies(p.substep, *p.state);
  });
  if (!overstretched) return false;
  for (Participant& p : participants) p.substep.gives_in_on_bodies = true;
  begin_bodies(island, from, to, scheme);
  return advance_bodies(from, tolerated);
}

/// Aims what holds bodies at where it will be at the end of the step. Where it jumps, the body is carried along with it before it
/// is stepped, and keeps its velocities; so is a body whose cable is carried, and what else hangs on it.
void IslandStepper::update_body_targets(const Island& island, IslandOutcome& found) {
  carry_by_cables(island);
  auto holders = island.held.begin();
  for (const int body : island.bodies) {
    const auto first = holders;
    while (holders != island.held.end() && held_body(state_.attachments[*holders]) == body) ++holders;
    if (state_.body_progress[body].is_placed) aim_body(body, first, holders, found);
  }
  carry_cables(island);
  if (found.bodies.status != StepResult::Status::jumped) return;
  double change = 0;
  for (const int cable : island.cables) change += follow_energy_of_cable(cable, state_);
  for (const int body : island.bodies) change += follow_energy_of_body(body, state_);
  found.change += change;
  account_for_displacement(change, found.balance);
}

/// `first` to `last`: the attachments that hold it.
void IslandStepper::aim_body(int index, std::vector<int>::const_iterator first, std::vector<int>::const_iterator last,
                             IslandOutcome& found) {
  SimulatedBody& body = state_.bodies[index];
  BodyProgress& progress = state_.body_progress[index];
  KinematicTargets targets;
  targets.nodes.swap(progress.holders);
  std::size_t count = 0;
  for (; first != last; ++first) {
    const Attachment& attachment = state_.attachments[*first];
    if (attachment.holder >= 0) continue;
    if (targets.nodes.size() == count) {
      KinematicTarget target;
      target.node = static_cast<int>(count);
      target.position = (body.pose * attachment.at).position;
      target.gap = target.position - (state_.frames.previous_poses[attachment.frame] * attachment.pose).position;
      target.caught = state_.time() - state_.scene->time_step;
      const Vector3 arm = target.position - (body.pose * Pose{body.center_of_mass}).position;
      if (progress.has_moved) target.velocity = body.velocity + body.angular_velocity.cross(arm);
      target.mean_velocity = target.frame_velocity = target.average_velocity = target.velocity;
      target.starts = !progress.has_moved && attachment.frame != 0;
      target.liveliness = state_.scene->jump_speed;
      targets.nodes.push_back(target);
      progress.holder_spins.push_back(mean_spin(state_.frames, attachment, state_.scene->time_step));
    }
    targets.nodes[count].attachment = *first;
    aim_at((state_.frames.poses[attachment.frame] * attachment.pose).position, state_.time(), targets.nodes[count]);
    ++count;
  }
  std::vector<KinematicTarget>& nodes = targets.nodes;
  std::vector<Vector3>& before = workspace_.holder_places;
  before.clear();
  for (const KinematicTarget& target : nodes) before.push_back(target.position);
  const Following following = follow_aims(state_.attachments, state_.time(), step_of_frames(state_), targets, found.jumps);
  if (following.jumping_node >= 0) {
    const KinematicTarget& target = nodes[following.jumping_node];
    const Attachment& attachment = state_.attachments[target.attachment];
    Quaternion turn = Quaternion::Identity();
    if (attachment.type != AttachmentType::hinge)
      turn = state_.frames.poses[attachment.frame].orientation *
             state_.frames.previous_poses[attachment.frame].orientation.conjugate();
    const Vector3 arm = body.pose.position - before[following.jumping_node];
    body.pose.position = target.position + turn * arm;
    body.pose.orientation = (turn * body.pose.orientation).normalized();
    note_status(StepResult::Status::jumped, rigid_body_id(index), 0, found.bodies);
  }
  progress.holders.swap(nodes);
}

/// Bodies that nothing else holds follow cables that were carried along with what holds those.
void IslandStepper::carry_by_cables(const Island& island) {
  for (const int index : island.cables) {
    const CableState& cable = state_.cables[index].state;
    const KinematicTargets& targets = state_.cable_progress[index].targets;
    const bool jumps = std::any_of(targets.nodes.begin(), targets.nodes.end(),
                                   [](const KinematicTarget& target) { return target.jumping_steps > 0; });
    if (!jumps) continue;
    for (const KinematicTarget& target : targets.nodes) {
      const Attachment& attachment = state_.attachments[target.attachment];
      const bool is_own = target.node == attachment.node;
      if (attachment.holder < 0 || !is_own || !state_.body_progress[attachment.holder].holders.empty()) continue;
      SimulatedBody& body = state_.bodies[attachment.holder];
      body.pose.position += cable.positions[target.node] - (body.pose * attachment.pose).position;
    }
  }
}

/// Cables are taken along by bodies that were carried.
void IslandStepper::carry_cables(const Island& island) {
  for (std::size_t k = 0; k < island.cables.size(); ++k) {
    const int index = island.cables[k];
    SimulatedCable& cable = state_.cables[index];
    KinematicTargets& targets = state_.cable_progress[index].targets;
    Boundary& boundary = workspace_.cables[k].boundary;
    hold_at(0, 0, targets, boundary);
    hold_on_bodies(cable.state, state_.attachments, state_.bodies, state_.time(), targets, boundary);
    const bool left_behind = std::any_of(boundary.nodes.begin(), boundary.nodes.end(), [&](const HeldNode& held) {
      return held.body >= 0 && (held.position - cable.state.positions[held.node]).norm() > carried_away;
    });
    if (!left_behind) continue;
    carry_with_targets(*cable.model, boundary.nodes, gravity_near(state_, index), cable.state);
    for (std::size_t d = 0; d < targets.directions.size(); ++d) targets.directions[d].orientation = boundary.directions[d].start;
    measure_joint_twists(targets.directions, cable.state);
  }
}

/// Bodies that hold a cable where no frame holds them, and that are not `placed` yet, go to where it is now.
void IslandStepper::take_bodies_along(int index, std::vector<char>& placed) {
  const CableState& cable = state_.cables[index].state;
  for (const KinematicTarget& target : state_.cable_progress[index].targets.nodes) {
    const Attachment& attachment = state_.attachments[target.attachment];
    if (attachment.holder < 0 || target.node != attachment.node || placed[attachment.holder]) continue;
    SimulatedBody& body = state_.bodies[attachment.holder];
    if (attachment.type == AttachmentType::clamp)
      body.pose.orientation = (axes_at(cable, target.node) * attachment.pose.orientation.conjugate()).normalized();
    body.pose.position += cable.positions[target.node] - (body.pose * attachment.pose).position;
    placed[attachment.holder] = 1;
  }
}

/// Puts cables and the bodies that hold them, which are stuck, where they would hang: those that frames hold first, between these
/// alone; then, as far as they reach, those that come off them.
void IslandStepper::hang_on_bodies_anew(const Island& island) {
  std::vector<char> placed(state_.bodies.size(), 0), hung(island.cables.size(), 0);
  for (const int body : island.bodies) placed[body] = !state_.body_progress[body].holders.empty();
  const auto hang = [&](std::size_t k) {
    SimulatedCable& cable = state_.cables[island.cables[k]];
    Boundary& boundary = workspace_.cables[k].boundary;
    const KinematicTargets& targets = state_.cable_progress[island.cables[k]].targets;
    hold_at(1, 1, targets, boundary);
    hold_on_bodies(cable.state, state_.attachments, state_.bodies, state_.time(), targets, boundary);
    std::vector<HeldNode> held;
    for (const HeldNode& node : boundary.nodes)
      if (node.body < 0 || placed[node.body]) held.push_back(node);
    if (held.empty()) return false;
    const CableState before = cable.state;
    hang_anew(*cable.model, held, gravity_near(state_, island.cables[k]), cable.state);
    close_loops(state_.attachments, cable_id(island.cables[k]), false, held, gravity_near(state_, island.cables[k]), cable);
    if (!finite(cable.state.positions)) cable.state = before;
    return true;
  };
  for (bool any = true; any;) {
    any = false;
    for (std::size_t k = 0; k < island.cables.size(); ++k) {
      if (hung[k] || !hang(k)) continue;
      hung[k] = 1;
      take_bodies_along(island.cables[k], placed);
      any = true;
    }
  }
}

/// Where the frame that holds a body is at a part of the step, as far as it is followed.
Pose IslandStepper::body_holder_at(const BodyJoint& joint, double part) const {
  const Attachment& attachment = state_.attachments[joint.attachment];
  const KinematicTarget& holder = holder_of(joint, state_);
  const double turned = holder.jumping_steps > 0 ? 1 : part;
  return {holder.position + part * (holder.next_position - holder.position),
          frame_at(state_.frames, attachment.frame, turned).orientation * attachment.pose.orientation};
}

/// What frames do to the bodies that they hold. As velocities are mended no motion has it.
void IslandStepper::balance_bodies(double from, double to) {
  for (const BodyJoint& joint : workspace_.body_system.joints()) {
    if (joint.other >= 0) continue;
    const Pose before = body_holder_at(joint, from), after = body_holder_at(joint, to);
    const auto work = [&](const JointWrench& of) {
      return work_of(of.force, after.position - before.position, of.torque, before.orientation, after.orientation);
    };
    substep_.work.attachments += work(joint.exerted);
    substep_.dissipated.unresolved += work(joint.mending);
  }
}

/// Where the frame that holds a body is at the end of the substep, and how fast.
void IslandStepper::follow_body_holder(BodyJoint& joint, double to) {
  const Attachment& attachment = state_.attachments[joint.attachment];
  const SimulatedBody& body = state_.bodies[held_body(attachment)];
  const KinematicTarget& holder = holder_of(joint, state_);
  Vector3& last_spin = state_.body_progress[held_body(attachment)].holder_spins[holder.node];
  const Vector3 spin = mean_spin(state_.frames, attachment, state_.scene->time_step);
  const bool jumps = holder.jumping_steps > 0;
  joint.holder = body_holder_at(joint, to);
  joint.holder_velocity.linear = holder.velocity + to * (holder.next_velocity - holder.velocity);
  joint.holder_velocity.angular = jumps ? last_spin : Vector3(spin + (to - 0.5) * (spin - last_spin));
  const double size = body.is_junction ? least_size : std::sqrt(body.inertia.trace() / body.mass),
               noticed = noticed_jerk / state_.scene->time_step;
  const bool accelerates = (holder.next_velocity - holder.velocity).norm() > noticed * size;
  const bool turns = joint.type != AttachmentType::hinge && !jumps && (spin - last_spin).norm() > noticed;
  projects_bodies_ = projects_bodies_ || accelerates || turns || jumps;
  if (to == 1 && !jumps) last_spin = spin;
}

/// Takes over what a substep has found.
void IslandStepper::finish_bodies(const Island& island, double from, double to) {
  const BodySystem& system = workspace_.body_system;
  for (std::size_t m = 0; m < workspace_.body_members.size(); ++m) {
    const int body = workspace_.body_members[m].body;
    system.finish(static_cast<int>(m), state_.bodies[body], state_.body_progress[body]);
    state_.body_progress[body].has_moved = true;
  }
  for (std::size_t m = 0; m < workspace_.body_members.size(); ++m) {
    substep_.dissipated.bodies += system.damping_work(static_cast<int>(m));
    substep_.work.applied += system.applied_work(static_cast<int>(m));
    system.add_fluid_work(static_cast<int>(m), substep_);
  }
  workspace_.body_system.restore_momenta(workspace_.participants, state_.bodies);
  if (projects_bodies_) {
    substep_.dissipated.unresolved += kinetic_energy_of(island, state_);
    workspace_.body_system.project(workspace_.participants, state_.bodies, state_.body_progress);
    substep_.dissipated.unresolved -= kinetic_energy_of(island, state_);
  }
  balance_bodies(from, to);
  for (const BodyMember& member : workspace_.body_members)
    if (!member.start->shapes.empty())
      BodyTouches::keep(member.body, workspace_.body_system.contacts().touches(), state_.body_progress[member.body].contacts);
  for (const BodyJoint& joint : workspace_.body_system.joints()) {
    Attachment& attachment = state_.attachments[joint.attachment];
    if (from == 0) attachment.force = attachment.torque = Vector3::Zero();
    attachment.force -= (to - from) * joint.exerted.force;
    attachment.torque -= (to - from) * joint.exerted.torque;
  }
  keep_body_joints(island, workspace_.body_system.joints(), state_);
  if (to < 1) return;
  for (const int body : island.bodies) {
    KinematicTargets targets;
    targets.nodes.swap(state_.body_progress[body].holders);
    complete_step(state_.scene->time_step, targets);
    targets.nodes.swap(state_.body_progress[body].holders);
  }
  for (const int body : island.bodies) state_.frames.poses[state_.bodies[body].frame] = state_.bodies[body].pose;
}

/// What did not converge is stopped: its next step starts from rest.
void IslandStepper::stop_bodies(const Island& island) {
  for (const int body : island.bodies) {
    state_.bodies[body].velocity = state_.bodies[body].angular_velocity = Vector3::Zero();
    state_.body_progress[body].acceleration = state_.body_progress[body].angular_acceleration = Vector3::Zero();
    state_.body_progress[body].joints.clear();
  }
  for (const BodyJoint& joint : workspace_.body_system.joints()) {
    Attachment& attachment = state_.attachments[joint.attachment];
    attachment.force = attachment.torque = Vector3::Zero();
  }
}

}  // namespace verlet_cable
