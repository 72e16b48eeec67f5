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

Vector3 remaining_gap(const Holder& holder, double time) {
  const double duration = shortest_approach + holder.gap.norm() / approach_speed;
  const double part = std::clamp((time - holder.caught) / duration, 0.0, 1.0);
  return (1 - part * part * (3 - 2 * part)) * holder.gap;
}

}  // namespace

std::vector<Target> attachment_targets(const CableModel& model, const Attachment& attachment, const Pose& frame) {
  const Pose pose = frame * attachment.pose;
  const int node = attachment.node;
  std::vector<Target> targets{{node, pose.position}};
  if (attachment.type == AttachmentType::hinge || model.material.bending_stiffness > 0) return targets;
  const Vector3 axis = pose.orientation * Vector3::UnitX();
  if (node > 0) targets.push_back({node - 1, pose.position - model.rest_lengths[node - 1] * axis});
  if (node < model.segments()) targets.push_back({node + 1, pose.position + model.rest_lengths[node] * axis});
  return targets;
}

std::vector<Holder> find_holders(int cable, const CableModel& model, const CableState& state,
                                 const std::vector<Attachment>& attachments, const std::vector<Pose>& frames,
                                 const std::vector<Holder>& before, double time) {
  std::vector<Holder> holders;
  const auto add = [&](int attachment, const Target& target) {
    const auto same_node = [&](const Holder& h) { return h.node == target.node; };
    if (std::any_of(holders.begin(), holders.end(), same_node)) return;
    const auto known =
        std::find_if(before.begin(), before.end(), [&](const Holder& h) { return same_node(h) && h.attachment == attachment; });
    if (known != before.end()) {
      holders.push_back(*known);
      return;
    }
    Holder holder;
    holder.attachment = attachment;
    holder.node = target.node;
    holder.position = state.positions[target.node];
    holder.velocity = state.velocities[target.node];
    holder.mean_velocity = holder.velocity;
    holder.gap = holder.position - target.position;
    holder.caught = time;
    holders.push_back(holder);
  };
  // The attachments' own nodes first, then the neighbours that clamps want.
  for (const bool own : {true, false}) {
    for (int a = 0; a < static_cast<int>(attachments.size()); ++a) {
      if (attachments[a].cable != cable) continue;
      const std::vector<Target> targets = attachment_targets(model, attachments[a], frames[attachments[a].frame]);
      for (const Target& target : targets)
        if ((target.node == attachments[a].node) == own) add(a, target);
    }
  }
  std::sort(holders.begin(), holders.end(), [](const Holder& a, const Holder& b) { return a.node < b.node; });
  return holders;
}

bool aim_holders(const CableModel& model, const std::vector<Attachment>& attachments, const std::vector<Pose>& frames,
                 double time, double time_step, std::vector<Holder>& holders) {
  bool followed = true;
  for (Holder& holder : holders) {
    const Attachment& attachment = attachments[holder.attachment];
    const Pose pose = frames[attachment.frame] * attachment.pose;
    holder.next_position = pose.position + remaining_gap(holder, time);
    if (holder.node != attachment.node) {
      const int between = std::min(holder.node, attachment.node);
      const double side = holder.node < attachment.node ? -1 : 1;
      holder.next_position += side * model.rest_lengths[between] * (pose.orientation * Vector3::UnitX());
    }
    const Vector3 mean = (holder.next_position - holder.position) / time_step;
    holder.next_velocity = mean + 0.5 * (mean - holder.mean_velocity);
    if (!(mean.norm() <= fastest_holder)) followed = false;
  }
  return followed;
}

void hold_at(double part, const std::vector<Holder>& holders, std::vector<HeldNode>& held) {
  held.resize(holders.size());
  for (std::size_t k = 0; k < holders.size(); ++k) {
    const Holder& holder = holders[k];
    held[k].node = holder.node;
    held[k].position = holder.position + part * (holder.next_position - holder.position);
    held[k].velocity = holder.velocity + part * (holder.next_velocity - holder.velocity);
    if (part == 1) held[k].position = holder.next_position;
  }
}

void complete_step(double time_step, std::vector<Holder>& holders) {
  for (Holder& holder : holders) {
    holder.mean_velocity = (holder.next_position - holder.position) / time_step;
    holder.position = holder.next_position;
    holder.velocity = holder.next_velocity;
  }
}

}  // namespace verlet_cable
