#include "holders.h"

#include <algorithm>
#include <cmath>

#include "verlet_cable/core/rotation.h"

namespace verlet_cable {

namespace {

/// No hand or machine changes its velocity by more [m/s] within a step: a holder that does jumps, if that does not last longer [s].
constexpr double greatest_change = 5;
constexpr double longest_jump = 5e-3;
/// Nothing starts to move like this [m/s] at once: it is a jump between two messages or rows, spread over the time between them [s].
constexpr double greatest_lasting_change = 20;
constexpr double longest_spread_jump = 0.1;
/// Frames may be on vehicles: one that starts is believed to move as fast as this [m/s].
constexpr double fastest_start = 50;
constexpr double rounding = 1e-9;
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

bool holds_direction(const CableModel& model, const Attachment& attachment) {
  return attachment.type == AttachmentType::clamp && model.material.bending_stiffness > 0;
}

/// Where an attachment at `pose` wants its own node or one next to it.
Vector3 target_position(const CableModel& model, const Attachment& attachment, const Pose& pose, int node) {
  if (node == attachment.node) return pose.position;
  const double side = node < attachment.node ? -1 : 1;
  return pose.position + side * model.rest_lengths[std::min(node, attachment.node)] * (pose.orientation * Vector3::UnitX());
}

/// The cable's direction at a node.
Vector3 tangent(const CableState& state, int node) {
  const int last = static_cast<int>(state.positions.size()) - 1;
  return state.positions[std::min(node + 1, last)] - state.positions[std::max(node - 1, 0)];
}

void aim(const Vector3& target, double time, Holder& holder) {
  holder.next_position = target + remaining(holder.caught, holder.gap.norm(), time) * holder.gap;
}

bool is_greater_than_a_motion(const Vector3& change) {
  return change.norm() > greatest_change;
}

/// The time [s] in whole steps in which a jump that does not last too long may be seen: it need not begin with a step.
double longest_jump_time(const Vector3& change, double time_step) {
  const double longest = change.norm() > greatest_lasting_change ? longest_spread_jump : longest_jump;
  return (std::ceil(longest / time_step * (1 - rounding)) + 1) * time_step;
}

void end_jump(Holder& holder) {
  holder.jumps_for = 0;
  holder.jumped_from = holder.carried = Vector3::Zero();
}

/// Whether a holder jumps in a step with this mean velocity. A change of velocity that lasts is a motion, and to be followed; while
/// that is not known it is a jump. What trembles goes as its mean does.
bool jumps(const Vector3& mean, double time_step, Holder& holder) {
  if (!is_greater_than_a_motion(mean - holder.mean_velocity)) return false;
  if (holder.jumps_for == 0) holder.jumped_from = holder.position;
  const double time = holder.jumps_for + time_step;
  if (time <= longest_jump_time(mean - holder.mean_velocity, time_step) * (1 + rounding)) return true;
  const Vector3 lasting = (holder.next_position - holder.jumped_from) / time;
  end_jump(holder);
  holder.jumped_from = holder.position;
  if (!is_greater_than_a_motion(lasting - holder.mean_velocity)) {
    holder.mean_velocity = lasting;
    return is_greater_than_a_motion(mean - lasting);
  }
  if (is_greater_than_a_motion(mean - lasting)) return true;
  holder.mean_velocity = mean;
  return false;
}

/// Catches a node where it is.
Holder caught(int attachment, const Target& target, const Vector3& position, const Vector3& velocity, double time) {
  Holder holder;
  holder.attachment = attachment;
  holder.node = target.node;
  holder.position = position;
  holder.velocity = velocity;
  holder.mean_velocity = velocity;
  holder.gap = position - target.position;
  holder.caught = time;
  return holder;
}

/// Adds the holder of a node: the one before, or one that catches it.
void add_holder(int attachment, const Target& target, const std::vector<Vector3>& positions,
                const std::vector<Vector3>& velocities, const Holders& before, double time, Holders& holders) {
  const auto same_node = [&](const Holder& h) { return h.node == target.node; };
  if (std::any_of(holders.nodes.begin(), holders.nodes.end(), same_node)) return;
  const auto known = std::find_if(before.nodes.begin(), before.nodes.end(),
                                  [&](const Holder& h) { return same_node(h) && h.attachment == attachment; });
  holders.nodes.push_back(
      known != before.nodes.end() ? *known : caught(attachment, target, positions[target.node], velocities[target.node], time));
}

}  // namespace

std::vector<Target> attachment_targets(const CableModel& model, const Attachment& attachment, const Pose& frame) {
  const Pose pose = frame * attachment.pose;
  const int node = attachment.node;
  std::vector<Target> targets{{node, pose.position}};
  if (attachment.type == AttachmentType::hinge || model.material.bending_stiffness > 0) return targets;
  if (node > 0) targets.push_back({node - 1, target_position(model, attachment, pose, node - 1)});
  if (node < model.segments()) targets.push_back({node + 1, target_position(model, attachment, pose, node + 1)});
  return targets;
}

Holders find_holders(int cable, const CableModel& model, const CableState& state, const std::vector<Attachment>& attachments,
                     const std::vector<Pose>& frames, const Holders& before, double time) {
  Holders holders;
  const auto add_node = [&](int attachment, const Target& target) {
    add_holder(attachment, target, state.positions, state.velocities, before, time, holders);
  };
  const auto add_direction = [&](int attachment) {
    const auto known = std::find_if(before.directions.begin(), before.directions.end(),
                                    [&](const DirectionHolder& h) { return h.attachment == attachment; });
    if (known != before.directions.end()) {
      holders.directions.push_back(*known);
      return;
    }
    DirectionHolder holder;
    holder.attachment = attachment;
    holder.node = attachments[attachment].node;
    const Quaternion target = (frames[attachments[attachment].frame] * attachments[attachment].pose).orientation;
    // Its roll is followed from the start; a pinned node is not twisted by being pinned.
    holder.gap = smallest_rotation(target * Vector3::UnitX(), tangent(state, holder.node));
    holder.orientation = holder.gap * target;
    holder.caught = time;
    holders.directions.push_back(holder);
  };
  // The attachments' own nodes first, then the neighbours that clamps want.
  for (const bool own : {true, false}) {
    for (int a = 0; a < static_cast<int>(attachments.size()); ++a) {
      if (attachments[a].cable != cable) continue;
      const std::vector<Target> targets = attachment_targets(model, attachments[a], frames[attachments[a].frame]);
      for (const Target& target : targets)
        if ((target.node == attachments[a].node) == own) add_node(a, target);
      if (own && holds_direction(model, attachments[a])) add_direction(a);
    }
  }
  const auto by_node = [](const auto& a, const auto& b) { return a.node < b.node; };
  std::sort(holders.nodes.begin(), holders.nodes.end(), by_node);
  std::sort(holders.directions.begin(), holders.directions.end(), by_node);
  return holders;
}

void start_holders(const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, const BoundaryInputs& inputs,
                   Holders& holders) {
  for (Holder& holder : holders.nodes) {
    const auto frame = static_cast<std::size_t>(attachments[holder.attachment].frame);
    if (frame == 0) continue;
    holder.starts = true;
    if (frame >= inputs.size() || !inputs[frame].velocity) continue;
    const FrameVelocity& of_frame = *inputs[frame].velocity;
    const Vector3 velocity = of_frame.linear + of_frame.angular.cross(holder.position - frames[frame].position);
    if (!velocity.allFinite()) continue;
    holder.starts = false;
    holder.velocity = holder.mean_velocity = holder.next_velocity = velocity;
  }
}

void aim_holders(const CableModel& model, const std::vector<Attachment>& attachments, const std::vector<Pose>& frames,
                 double time, Holders& holders) {
  for (Holder& holder : holders.nodes) {
    const Attachment& attachment = attachments[holder.attachment];
    const Pose pose = frames[attachment.frame] * attachment.pose;
    aim(target_position(model, attachment, pose, holder.node), time, holder);
  }
  for (DirectionHolder& holder : holders.directions) {
    const Attachment& attachment = attachments[holder.attachment];
    const double left = remaining(holder.caught, approach_radius, time);
    holder.next_orientation =
        Quaternion::Identity().slerp(left, holder.gap) * (frames[attachment.frame] * attachment.pose).orientation;
  }
}

Holders find_net_holders(int net, const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities,
                         const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, const Holders& before,
                         double time) {
  Holders holders;
  for (int a = 0; a < static_cast<int>(attachments.size()); ++a) {
    if (attachments[a].net != net) continue;
    const Target target{attachments[a].node, (frames[attachments[a].frame] * attachments[a].pose).position};
    add_holder(a, target, positions, velocities, before, time, holders);
  }
  std::sort(holders.nodes.begin(), holders.nodes.end(), [](const Holder& a, const Holder& b) { return a.node < b.node; });
  return holders;
}

void aim_hinges(const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, double time, Holders& holders) {
  for (Holder& holder : holders.nodes) {
    const Attachment& attachment = attachments[holder.attachment];
    aim((frames[attachment.frame] * attachment.pose).position, time, holder);
  }
}

void put_at_aim(Holders& holders) {
  for (Holder& holder : holders.nodes) {
    holder.position = holder.next_position;
    holder.next_velocity = holder.velocity;
  }
  for (DirectionHolder& holder : holders.directions) holder.orientation = holder.next_orientation;
}

Following follow_aims(const std::vector<Attachment>& attachments, double time, double time_step, Holders& holders,
                      std::vector<Jump>& over) {
  Following following;
  for (Holder& holder : holders.nodes) {
    const Vector3 mean = (holder.next_position - holder.position) / time_step;
    if (holder.starts) {
      holder.starts = false;
      if (mean.norm() <= fastest_start) holder.velocity = holder.mean_velocity = mean;
      following.started = true;
    }
    // What a node that has just been caught was doing is no motion of a frame.
    const bool is_new = time - holder.caught < 1.5 * time_step;
    if (!is_new && jumps(mean, time_step, holder)) {
      const Vector3 way = holder.next_position - holder.position - time_step * holder.mean_velocity;
      holder.position += way;
      holder.carried += way;
      holder.jumps_for += time_step;
      holder.next_velocity = holder.mean_velocity;
      if (following.jumping_node < 0) following.jumping_node = holder.node;
      for (DirectionHolder& direction : holders.directions)
        if (direction.attachment == holder.attachment) direction.orientation = direction.next_orientation;
      continue;
    }
    if (holder.jumps_for > 0 && holder.node == attachments[holder.attachment].node)
      over.push_back({holder.attachment, holder.carried.norm(), time - time_step - holder.jumps_for, holder.jumps_for});
    end_jump(holder);
    holder.next_velocity = mean + 0.5 * (mean - holder.mean_velocity);
  }
  return following;
}

void hold_at(double from, double to, const Holders& holders, Boundary& boundary) {
  boundary.nodes.resize(holders.nodes.size());
  for (std::size_t k = 0; k < holders.nodes.size(); ++k) {
    const Holder& holder = holders.nodes[k];
    HeldNode& held = boundary.nodes[k];
    held.node = holder.node;
    held.position = to == 1 ? holder.next_position : holder.position + to * (holder.next_position - holder.position);
    held.velocity = holder.velocity + to * (holder.next_velocity - holder.velocity);
  }
  boundary.directions.resize(holders.directions.size());
  for (std::size_t k = 0; k < holders.directions.size(); ++k) {
    const DirectionHolder& holder = holders.directions[k];
    boundary.directions[k].node = holder.node;
    boundary.directions[k].start = holder.orientation.slerp(from, holder.next_orientation);
    boundary.directions[k].end = holder.orientation.slerp(to, holder.next_orientation);
  }
}

void complete_step(double time_step, Holders& holders) {
  for (Holder& holder : holders.nodes) {
    holder.mean_velocity = (holder.next_position - holder.position) / time_step;
    holder.position = holder.next_position;
    holder.velocity = holder.next_velocity;
  }
  for (DirectionHolder& holder : holders.directions) holder.orientation = holder.next_orientation;
}

}  // namespace verlet_cable
