#include "target/kinematic_targets.h"

#include <algorithm>
#include <cmath>

#include "chain/direction.h"
#include "rod/rod_frames.h"
#include "target/jump.h"
#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable {

namespace {

/// Frames may be on vehicles: one that starts is believed to move as fast as this [m/s].
constexpr double fastest_start = 50;
/// A node that is pinned elsewhere than it is goes there at about this speed [m/s], in no less than this time [s].
constexpr double approach_speed = 2;
constexpr double shortest_approach = 0.1;
constexpr double approach_radius = 0.5;  // [m]; directions turn as long as a node takes for this

/// How much of a gap is left: from 1 to 0, smoothly, in a time that grows with the distance [m] to go.
double remaining(double caught, double distance, double time) {
  const double duration = shortest_approach + distance / approach_speed;
  const double part = std::clamp((time - caught) / duration, 0.0, 1.0);
  return 1 - part * part * (3 - 2 * part);
}

/// Where an attachment at `pose` wants its own node or one next to it.
Vector3 target_position(const CableState& state, const Attachment& attachment, const Pose& pose, int node) {
  if (attachment.guide >= 0) return pose.position + pose.orientation * attachment.tangent_points[node - attachment.node];
  if (node == attachment.node) return pose.position;
  const double side = node < attachment.node ? -1 : 1;
  return pose.position + side * state.rest_lengths[std::min(node, attachment.node)] * (pose.orientation * Vector3::UnitX());
}

Quaternion about_direction(double roll) {
  return Quaternion(Eigen::AngleAxisd(roll, Vector3::UnitX()));
}

/// Holds the material where it is, as if it had come so into a clamp that wants another direction.
void catch_material(const Eigen::Matrix3d& material, const Quaternion& wanted, DirectionTarget& target) {
  target.gap = smallest_rotation(wanted * Vector3::UnitX(), material.col(0));
  const Eigen::Matrix3d clamp = (target.gap * wanted).toRotationMatrix();
  target.roll = std::atan2(clamp.col(2).dot(material.col(1)), clamp.col(1).dot(material.col(1)));
  target.orientation = Quaternion(material);
}

/// Catches a node where it is.
KinematicTarget caught(int attachment, const WantedNode& wanted, const Vector3& position, const Vector3& velocity, double time) {
  KinematicTarget target;
  target.attachment = attachment;
  target.node = wanted.node;
  target.position = position;
  target.velocity = velocity;
  target.mean_velocity = target.frame_velocity = target.average_velocity = velocity;
  target.gap = position - wanted.position;
  target.caught = time;
  return target;
}

/// Adds the holder of a node: the one before, or one that catches it.
void add_target(int attachment, const WantedNode& wanted, const std::vector<Vector3>& positions,
                const std::vector<Vector3>& velocities, const KinematicTargets& before, double time, KinematicTargets& targets) {
  const auto same_node = [&](const KinematicTarget& h) { return h.node == wanted.node; };
  if (std::any_of(targets.nodes.begin(), targets.nodes.end(), same_node)) return;
  const auto known = std::find_if(before.nodes.begin(), before.nodes.end(),
                                  [&](const KinematicTarget& h) { return same_node(h) && h.attachment == attachment; });
  targets.nodes.push_back(
      known != before.nodes.end() ? *known : caught(attachment, wanted, positions[wanted.node], velocities[wanted.node], time));
}

}  // namespace

bool is_drawn_to_holder(const KinematicTarget& target, double time) {
  return remaining(target.caught, target.gap.norm(), time) > 0 && !target.gap.isZero(0);
}

bool bends_at(const CableModel& model, const CableState& state, int node) {
  const CableMaterials materials(model, state);
  return std::max(materials[std::max(node - 1, 0)].bending_stiffness.largest(),
                  materials[std::min(node, state.segments() - 1)].bending_stiffness.largest()) > 0;
}

void aim_at(const Vector3& wanted, double time, KinematicTarget& target) {
  target.next_position = wanted + remaining(target.caught, target.gap.norm(), time) * target.gap;
}

std::vector<WantedNode> wanted_nodes(const CableModel& model, const CableState& state, const Attachment& attachment,
                                     const Pose& frame) {
  const Pose pose = frame * attachment.pose;
  const int node = attachment.node;
  std::vector<WantedNode> wanted{{node, target_position(state, attachment, pose, node)}};
  if (is_wheel(attachment)) wanted.push_back({node + 1, target_position(state, attachment, pose, node + 1)});
  if (attachment.type == AttachmentType::hinge || bends_at(model, state, node)) return wanted;
  if (node > 0) wanted.push_back({node - 1, target_position(state, attachment, pose, node - 1)});
  if (node < state.segments()) wanted.push_back({node + 1, target_position(state, attachment, pose, node + 1)});
  return wanted;
}

std::vector<int> attachments_of(const BodyId& body, const std::vector<Attachment>& attachments) {
  std::vector<int> own;
  for (int a = 0; a < static_cast<int>(attachments.size()); ++a)
    if (attachments[a].body == body && attachments[a].held_junction < 0) own.push_back(a);
  return own;
}

KinematicTargets find_targets(const CableModel& model, const CableState& state, const std::vector<Attachment>& attachments,
                              const std::vector<int>& attached, const std::vector<Pose>& frames, const KinematicTargets& before,
                              double time) {
  KinematicTargets targets;
  const auto add_node = [&](int attachment, const WantedNode& wanted) {
    add_target(attachment, wanted, state.positions, state.velocities, before, time, targets);
  };
  const auto add_direction = [&](int attachment) {
    const auto known = std::find_if(before.directions.begin(), before.directions.end(),
                                    [&](const DirectionTarget& h) { return h.attachment == attachment; });
    if (known != before.directions.end()) {
      targets.directions.push_back(*known);
      return;
    }
    DirectionTarget target;
    target.attachment = attachment;
    target.node = attachments[attachment].node;
    const Quaternion wanted = (frames[attachments[attachment].frame] * attachments[attachment].pose).orientation;
    // Its roll is followed from the start; a pinned node is not twisted by being pinned.
    if (state.directors.empty()) {
      target.gap = smallest_rotation(wanted * Vector3::UnitX(), way_past(state, target.node));
      target.orientation = target.gap * wanted;
    } else {
      catch_material(node_frame(state, target.node), wanted, target);
    }
    target.caught = time;
    targets.directions.push_back(target);
  };
  // The attachments' own nodes first, then the neighbours that clamps want.
  for (const bool own : {true, false}) {
    for (const int a : attached) {
      const std::vector<WantedNode> wanted = wanted_nodes(model, state, attachments[a], frames[attachments[a].frame]);
      for (const WantedNode& wanted : wanted)
        if ((wanted.node == attachments[a].node) == own) add_node(a, wanted);
      if (own && attachments[a].type == AttachmentType::clamp && bends_at(model, state, attachments[a].node)) add_direction(a);
    }
  }
  const auto by_node = [](const auto& a, const auto& b) { return a.node < b.node; };
  for (KinematicTarget& target : targets.nodes) target.slides = attachments[target.attachment].guide >= 0;
  std::sort(targets.nodes.begin(), targets.nodes.end(), by_node);
  std::sort(targets.directions.begin(), targets.directions.end(), by_node);
  return targets;
}

void start_targets(const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, const BoundaryInputs& inputs,
                   double jump_speed, KinematicTargets& targets) {
  for (KinematicTarget& target : targets.nodes) {
    const auto frame = static_cast<std::size_t>(attachments[target.attachment].frame);
    if (frame == 0 || attachments[target.attachment].holder >= 0) continue;
    target.starts = true;
    target.liveliness = jump_speed;
    if (frame >= inputs.size() || !inputs[frame].velocity) continue;
    const FrameVelocity& of_frame = *inputs[frame].velocity;
    const Vector3 velocity = of_frame.linear + of_frame.angular.cross(target.position - frames[frame].position);
    if (!velocity.allFinite()) continue;
    target.starts = false;
    target.velocity = target.mean_velocity = target.next_velocity = velocity;
    target.frame_velocity = target.average_velocity = velocity;
  }
}

void aim_targets(const CableState& state, const std::vector<Attachment>& attachments, const std::vector<Pose>& frames,
                 double time, KinematicTargets& targets) {
  for (KinematicTarget& target : targets.nodes) {
    const Attachment& attachment = attachments[target.attachment];
    const Pose pose = frames[attachment.frame] * attachment.pose;
    aim_at(target_position(state, attachment, pose, target.node), time, target);
  }
  for (DirectionTarget& target : targets.directions) {
    const Attachment& attachment = attachments[target.attachment];
    const double left = remaining(target.caught, approach_radius, time);
    target.next_orientation = Quaternion::Identity().slerp(left, target.gap) *
                              (frames[attachment.frame] * attachment.pose).orientation * about_direction(target.roll);
  }
}

KinematicTargets find_net_targets(const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities,
                                  const std::vector<Attachment>& attachments, const std::vector<int>& attached,
                                  const std::vector<Pose>& frames, const KinematicTargets& before, double time) {
  KinematicTargets targets;
  for (const int a : attached) {
    const WantedNode wanted{attachments[a].node, (frames[attachments[a].frame] * attachments[a].pose).position};
    add_target(a, wanted, positions, velocities, before, time, targets);
  }
  std::sort(targets.nodes.begin(), targets.nodes.end(),
            [](const KinematicTarget& a, const KinematicTarget& b) { return a.node < b.node; });
  return targets;
}

void aim_hinges(const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, double time,
                KinematicTargets& targets) {
  for (KinematicTarget& target : targets.nodes) {
    const Attachment& attachment = attachments[target.attachment];
    aim_at((frames[attachment.frame] * attachment.pose).position, time, target);
  }
}

void put_at_aim(KinematicTargets& targets) {
  for (KinematicTarget& target : targets.nodes) {
    target.position = target.next_position;
    target.next_velocity = target.velocity;
  }
  for (DirectionTarget& target : targets.directions) target.orientation = target.next_orientation;
}

namespace {

/// [m/s] Of what goes on from `start` and has the `mean` velocity in a step: as near to where it is `headed` as a mass that is
/// carried along gains no more energy than the force does that changes its momentum so, which acts over the way of the step.
/// m (end - start) . ((start + end) / 2 - mean) <= 0 is a sphere about the mean, through the start.
Vector3 velocity_at_end(const Vector3& start, const Vector3& mean, const Vector3& headed) {
  const double reach = (start - mean).norm(), change = (headed - mean).norm();
  return change > reach ? Vector3(mean + reach / change * (headed - mean)) : headed;
}

}  // namespace

Following follow_aims(const std::vector<Attachment>& attachments, double time, const FrameStep& step, KinematicTargets& targets,
                      std::vector<Jump>& over) {
  const double time_step = step.time_step;
  Following following;
  for (KinematicTarget& target : targets.nodes) {
    if (attachments[target.attachment].holder >= 0) continue;
    const Vector3 mean = (target.next_position - target.position) / time_step;
    if (target.starts) {
      target.starts = false;
      if (mean.norm() <= fastest_start) target.velocity = target.mean_velocity = target.average_velocity = mean;
      following.started = true;
    }
    // What a node that has just been caught was doing is no motion of a frame.
    const bool is_new = time - target.caught < 1.5 * time_step;
    const Change change = is_new || !step.is_judged ? Change::none : judge(mean, time_step, step.jump_speed, target);
    if (change == Change::undecided) {
      const Vector3 way = target.next_position - target.position - time_step * target.mean_velocity;
      target.position += way;
      target.carried += way;
      target.frame_velocity = mean;
      target.next_velocity = target.mean_velocity;
      if (following.jumping_node < 0) following.jumping_node = target.node;
      for (DirectionTarget& direction : targets.directions)
        if (direction.attachment == target.attachment) direction.orientation = direction.next_orientation;
      continue;
    }
    if (change == Change::jump && target.node == attachments[target.attachment].node) {
      const double duration = target.jumping_steps * time_step;
      over.push_back({target.attachment, target.carried.norm(), time - time_step - duration, duration});
    }
    if (change == Change::motion) {
      note_motion(mean - target.frame_velocity, mean, time_step, target);
      target.average_velocity = target.mean_velocity = mean;
    } else {
      note_motion(mean - target.mean_velocity, mean, time_step, target);
      if (is_new) target.average_velocity = mean;
    }
    end_jump(target);
    target.frame_velocity = mean;
    target.next_velocity = velocity_at_end(target.velocity, mean, mean + 0.5 * (mean - target.mean_velocity));
  }
  return following;
}

void show_velocities(const KinematicTargets& targets, std::vector<Vector3>& velocities) {
  for (const KinematicTarget& target : targets.nodes)
    if (target.jumping_steps > 0 && target.frame_velocity.norm() < target.velocity.norm())
      velocities[target.node] = target.frame_velocity;
}

void take_back_shown_velocities(const KinematicTargets& targets, std::vector<Vector3>& velocities) {
  for (const KinematicTarget& target : targets.nodes)
    if (target.jumping_steps > 0) velocities[target.node] = target.velocity;
}

void hold_at(double from, double to, const KinematicTargets& targets, Boundary& boundary) {
  boundary.nodes.resize(targets.nodes.size());
  for (std::size_t k = 0; k < targets.nodes.size(); ++k) {
    const KinematicTarget& target = targets.nodes[k];
    HeldNode& held = boundary.nodes[k];
    held.node = target.node;
    held.attachment = target.attachment;
    held.body = -1;
    held.at_junction = false;
    held.slides = target.slides;
    held.position = to == 1 ? target.next_position : target.position + to * (target.next_position - target.position);
    held.velocity = target.velocity + to * (target.next_velocity - target.velocity);
    held.force.setZero();
    held.lasting_force = target.lasting_force;
  }
  hold_directions_at(from, to, targets, boundary.directions);
}

void hold_directions_at(double from, double to, const KinematicTargets& targets, std::vector<HeldDirection>& directions) {
  directions.resize(targets.directions.size());
  for (std::size_t k = 0; k < targets.directions.size(); ++k) {
    const DirectionTarget& target = targets.directions[k];
    directions[k].node = target.node;
    directions[k].body = -1;
    directions[k].twist_before = target.twist_before;
    directions[k].twist_after = target.twist_after;
    directions[k].start = target.orientation.slerp(from, target.next_orientation);
    directions[k].end = target.orientation.slerp(to, target.next_orientation);
    directions[k].torque.setZero();
    directions[k].lasting_torque = target.lasting_torque;
  }
}

void hold_on_bodies(const CableState& state, const std::vector<Attachment>& attachments, const std::vector<SimulatedBody>& bodies,
                    double time, const KinematicTargets& targets, Boundary& boundary) {
  for (std::size_t k = 0; k < targets.nodes.size(); ++k) {
    const KinematicTarget& target = targets.nodes[k];
    const Attachment& attachment = attachments[target.attachment];
    if (attachment.holder < 0) continue;
    HeldNode& held = boundary.nodes[k];
    const SimulatedBody& body = bodies[attachment.holder];
    held.body = attachment.holder;
    held.at_junction = body.is_junction;
    held.point = target_position(state, attachment, attachment.pose, held.node);
    held.point += remaining(target.caught, target.gap.norm(), time) * target.gap;
    const Vector3 arm = body.pose.orientation * (held.point - body.center_of_mass);
    held.position = (body.pose * Pose{held.point}).position;
    held.velocity = body.velocity + body.angular_velocity.cross(arm);
  }
  hold_directions_on_bodies(attachments, bodies, targets, boundary.directions);
}

void hold_directions_on_bodies(const std::vector<Attachment>& attachments, const std::vector<SimulatedBody>& bodies,
                               const KinematicTargets& targets, std::vector<HeldDirection>& directions) {
  for (std::size_t k = 0; k < targets.directions.size(); ++k) {
    const Attachment& attachment = attachments[targets.directions[k].attachment];
    if (attachment.holder < 0) continue;
    HeldDirection& held = directions[k];
    held.body = attachment.holder;
    held.on_body = attachment.pose.orientation * about_direction(targets.directions[k].roll);
    held.start = held.end = bodies[attachment.holder].pose.orientation * held.on_body;
  }
}

void close_gaps_on_bodies(const std::vector<Attachment>& attachments, const std::vector<SimulatedBody>& bodies,
                          const KinematicTargets& before, KinematicTargets& targets) {
  for (KinematicTarget& target : targets.nodes) {
    const int holder = attachments[target.attachment].holder;
    const bool is_known = std::any_of(before.nodes.begin(), before.nodes.end(), [&](const KinematicTarget& other) {
      return other.node == target.node && other.attachment == target.attachment;
    });
    if (holder >= 0 && !is_known) target.gap = bodies[holder].pose.orientation.conjugate() * target.gap;
  }
}

void follow_bodies(const Boundary& boundary, KinematicTargets& targets) {
  for (std::size_t k = 0; k < targets.nodes.size(); ++k) {
    const HeldNode& held = boundary.nodes[k];
    if (held.body < 0) continue;
    KinematicTarget& target = targets.nodes[k];
    target.next_position = held.position;
    target.next_velocity = held.velocity;
  }
  for (std::size_t k = 0; k < targets.directions.size(); ++k)
    if (boundary.directions[k].body >= 0) targets.directions[k].next_orientation = boundary.directions[k].end;
}

void keep_twist(const Boundary& boundary, KinematicTargets& targets) {
  for (std::size_t k = 0; k < targets.directions.size(); ++k) {
    targets.directions[k].twist_before = boundary.directions[k].twist_before;
    targets.directions[k].twist_after = boundary.directions[k].twist_after;
  }
}

void keep_lasting_forces(const Boundary& boundary, KinematicTargets& targets) {
  for (std::size_t k = 0; k < targets.nodes.size(); ++k) targets.nodes[k].lasting_force = boundary.nodes[k].lasting_force;
  for (std::size_t k = 0; k < targets.directions.size(); ++k)
    targets.directions[k].lasting_torque = boundary.directions[k].lasting_torque;
}

Boundary boundary_now(const KinematicTargets& targets) {
  Boundary boundary;
  hold_at(0, 0, targets, boundary);
  return boundary;
}

void complete_step(double time_step, KinematicTargets& targets) {
  for (KinematicTarget& target : targets.nodes) {
    target.mean_velocity = (target.next_position - target.position) / time_step;
    target.position = target.next_position;
    target.velocity = target.next_velocity;
  }
  for (DirectionTarget& target : targets.directions) target.orientation = target.next_orientation;
}

}  // namespace verlet_cable
