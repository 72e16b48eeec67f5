#include <algorithm>
#include <cmath>

#include "world/island_stepper.h"

namespace verlet_cable {

namespace {

/// Where a frame is in a part of the step, 0 to 1.
Pose frame_at(const Frames& frames, int frame, double part) {
  const Pose &before = frames.previous_poses[frame], &after = frames.poses[frame];
  return {before.position + part * (after.position - before.position), before.orientation.slerp(part, after.orientation)};
}

/// [m/s], [rad/s] The mean over the step of an attachment to a frame.
FrameVelocity mean_velocity(const Frames& frames, const Attachment& attachment, double time_step) {
  const Pose before = frames.previous_poses[attachment.frame] * attachment.pose;
  const Pose after = frames.poses[attachment.frame] * attachment.pose;
  return {(after.position - before.position) / time_step,
          rotation_vector(after.orientation * before.orientation.conjugate()) / time_step};
}

/// A change of a holder's velocity that moves a body by less in a substep, in parts of its size or rad, goes unnoticed.
constexpr double noticed_jerk = 1e-9;

}  // namespace

/// The bodies of an island, and the cables that they hold and that touch nothing, by one substep. False if it has not converged.
bool IslandStepper::advance_bodies(const Island& island, double from, double to, Scheme scheme) {
  const SubstepRules rules{(to - from) * state_.scene->time_step, false, scheme};
  std::vector<BodyMember>& members = workspace_.body_members;
  members.clear();
  for (const int body : island.bodies)
    if (state_.body_progress[body].is_placed) members.push_back({body, &state_.bodies[body], &state_.body_progress[body]});
  BodySystem& system = workspace_.body_system;
  system.begin(members, workspace_.held_by_bodies, state_.bodies, state_.scene->gravity, rules);
  projects_bodies_ = false;
  find_body_joints(island, from, to);
  projects_bodies_ = projects_bodies_ || scheme != Scheme::conserving;
  for (const BodyMember& member : members) projects_bodies_ = projects_bodies_ || !member.progress->has_moved;
  for (const Participant& p : workspace_.held_by_bodies)
    projects_bodies_ = projects_bodies_ || !p.substep.boundary.growing.empty() || holders_accelerate(p.substep, *p.state);
  const bool converged = system.advance(workspace_.held_by_bodies, state_.scene->tolerance);
  if (converged) {
    system.place_at_end(workspace_.held_by_bodies);
    for (Participant& p : workspace_.held_by_bodies) p.stepper->finish(p.substep, false, *p.state, p.result);
  }
  for (const Participant& p : workspace_.held_by_bodies) workspace_.cables[p.place].result = p.result;
  return converged;
}

/// Their multipliers begin with what they were in the step before, or have been in this one.
void IslandStepper::find_body_joints(const Island& island, double from, double to) {
  std::vector<BodyJoint>& joints = workspace_.body_system.joints();
  joints.clear();
  const auto member_of = [&](int body) {
    const auto same = std::find_if(workspace_.body_members.begin(), workspace_.body_members.end(),
                                   [&](const BodyMember& member) { return member.body == body; });
    return same == workspace_.body_members.end() ? -1 : static_cast<int>(same - workspace_.body_members.begin());
  };
  for (int a = 0; a < static_cast<int>(state_.attachments.size()); ++a) {
    const Attachment& attachment = state_.attachments[a];
    if (!attachment.body.is_rigid_body()) continue;
    if (!std::binary_search(island.bodies.begin(), island.bodies.end(), attachment.body.index)) continue;
    BodyJoint joint;
    joint.attachment = a;
    joint.type = attachment.type;
    joint.member = member_of(attachment.body.index);
    joint.at = attachment.at;
    joint.other = attachment.holder < 0 ? -1 : member_of(attachment.holder);
    joint.holder = joint.other < 0 ? frame_at(state_.frames, attachment.frame, to) * attachment.pose : attachment.pose;
    const double share = from > 0 ? from : 1;
    joint.force = -attachment.force / share;
    joint.torque = -attachment.torque / share;
    if (joint.other < 0) follow_body_holders(joint, to);
    if (joint.member >= 0) joints.push_back(joint);
  }
}

/// How fast the frame that holds a body is at the end of the substep.
void IslandStepper::follow_body_holders(BodyJoint& joint, double to) {
  const double time_step = state_.scene->time_step;
  const Attachment& attachment = state_.attachments[joint.attachment];
  const SimulatedBody& body = state_.bodies[attachment.body.index];
  std::vector<FrameVelocity>& holders = state_.body_progress[attachment.body.index].holders;
  const auto place =
      static_cast<std::size_t>(std::count_if(state_.attachments.begin(), state_.attachments.begin() + joint.attachment,
                                             [&](const Attachment& other) { return other.body == attachment.body; }));
  const FrameVelocity mean = mean_velocity(state_.frames, attachment, time_step);
  while (holders.size() <= place) holders.push_back(mean);
  const FrameVelocity before = holders[place];
  joint.holder_velocity.linear = mean.linear + (to - 0.5) * (mean.linear - before.linear);
  joint.holder_velocity.angular = mean.angular + (to - 0.5) * (mean.angular - before.angular);
  const Vector3 arm = body.pose.orientation * (joint.at.position - body.center_of_mass);
  const Vector3 struck = joint.holder_velocity.linear - body.velocity - body.angular_velocity.cross(arm);
  const double size = std::sqrt(body.inertia.trace() / body.mass);
  const double noticed = noticed_jerk / time_step;
  const bool accelerates = struck.norm() > noticed * size && (mean.linear - before.linear).norm() > noticed * size;
  const bool turns = joint.type != AttachmentType::hinge && (mean.angular - before.angular).norm() > noticed;
  projects_bodies_ = projects_bodies_ || accelerates || turns;
  if (to == 1) holders[place] = mean;
}

/// Takes over what a substep has found.
void IslandStepper::finish_bodies(const Island& island, double from, double to) {
  const BodySystem& system = workspace_.body_system;
  for (std::size_t m = 0; m < workspace_.body_members.size(); ++m) {
    const int body = workspace_.body_members[m].body;
    system.finish(static_cast<int>(m), state_.bodies[body], state_.body_progress[body]);
    state_.body_progress[body].has_moved = true;
  }
  if (projects_bodies_) workspace_.body_system.project(workspace_.held_by_bodies, state_.bodies, state_.body_progress);
  for (const BodyJoint& joint : workspace_.body_system.joints()) {
    Attachment& attachment = state_.attachments[joint.attachment];
    if (from == 0) attachment.force = attachment.torque = Vector3::Zero();
    attachment.force -= (to - from) * joint.force;
    attachment.torque -= (to - from) * joint.torque;
  }
  if (to < 1) return;
  for (const int body : island.bodies) state_.frames.poses[state_.bodies[body].frame] = state_.bodies[body].pose;
}

/// What did not converge goes on from rest.
void IslandStepper::stop_bodies(const Island& island) {
  for (const int body : island.bodies) {
    state_.bodies[body].velocity = state_.bodies[body].angular_velocity = Vector3::Zero();
    state_.body_progress[body].acceleration = state_.body_progress[body].angular_acceleration = Vector3::Zero();
  }
}

}  // namespace verlet_cable
