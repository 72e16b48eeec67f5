#include "holders.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

namespace {

/// A holder that would have to be faster [m/s] has jumped: its frame was set anew.
constexpr double fastest_holder = 50;
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

/// Aims a holder at a target. False if it would have to jump.
bool aim(const Vector3& target, double time, double time_step, Holder& holder) {
  const double left = remaining(holder.caught, holder.gap.norm(), time);
  holder.next_position = target + left * holder.gap;
  const Vector3 mean = (holder.next_position - holder.position) / time_step;
  holder.next_velocity = mean + 0.5 * (mean - holder.mean_velocity);
  return mean.norm() <= fastest_holder;
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
    holder.gap = Quaternion::FromTwoVectors(target * Vector3::UnitX(), tangent(state, holder.node));
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

bool aim_holders(const CableModel& model, const std::vector<Attachment>& attachments, const std::vector<Pose>& frames,
                 double time, double time_step, Holders& holders) {
  bool followed = true;
  for (Holder& holder : holders.nodes) {
    const Attachment& attachment = attachments[holder.attachment];
    const Pose pose = frames[attachment.frame] * attachment.pose;
    if (!aim(target_position(model, attachment, pose, holder.node), time, time_step, holder)) followed = false;
  }
  for (DirectionHolder& holder : holders.directions) {
    const Attachment& attachment = attachments[holder.attachment];
    const double left = remaining(holder.caught, approach_radius, time);
    holder.next_orientation =
        Quaternion::Identity().slerp(left, holder.gap) * (frames[attachment.frame] * attachment.pose).orientation;
  }
  return followed;
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

bool aim_hinges(const std::vector<Attachment>& attachments, const std::vector<Pose>& frames, double time, double time_step,
                Holders& holders) {
  bool followed = true;
  for (Holder& holder : holders.nodes) {
    const Attachment& attachment = attachments[holder.attachment];
    if (!aim((frames[attachment.frame] * attachment.pose).position, time, time_step, holder)) followed = false;
  }
  return followed;
}

void jump_to_aim(Holders& holders) {
  for (Holder& holder : holders.nodes) {
    holder.position = holder.next_position;
    holder.velocity = holder.next_velocity = holder.mean_velocity = Vector3::Zero();
  }
  for (DirectionHolder& holder : holders.directions) holder.orientation = holder.next_orientation;
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
