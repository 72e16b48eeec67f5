#include "holders.h"

#include <algorithm>
#include <cmath>

#include "verlet_cable/core/rotation.h"

namespace verlet_cable {

namespace {

/// No hand or machine changes its velocity by more [m/s] within a step: a holder that does jumps, if that does not last longer [s].
constexpr double greatest_change = 5;
constexpr double longest_jump = 5e-3;
/// A change of velocity that is not greater than the one before by this fraction goes on with an acceleration.
constexpr double sudden = 0.5;
/// In steps longer than a jump all changes are great: one that is so many times greater than those before is no motion.
constexpr double out_of_proportion = 3;
constexpr double fading = 0.5;  // of what went before, in a step
/// Below this change [m/s] in a step a velocity is a motion's; above it may be noise, and the average over some time [s] is
/// better.
constexpr double steady_change = 1;
constexpr double averaging_time = 0.02;
/// A jump at one speed may begin and end inside steps: up to this fraction it is one speed.
constexpr double one_speed = 0.1;
/// Frames may be on vehicles: one that starts is believed to move as fast as this [m/s].
constexpr double fastest_start = 50;
constexpr double rounding = 1e-6;
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

void end_jump(Holder& holder) {
  holder.jumping_steps = 0;
  holder.jumped_from = holder.carried = Vector3::Zero();
  holder.first_excess = holder.last_excess = holder.least_excess = holder.greatest_excess = 0;
}

/// Whether a jump may begin in a step with this mean velocity, and its velocity before. An acceleration that goes on is none, nor
/// is what comes back from a change that was no jump.
bool may_begin_jump(const Vector3& mean, double time_step, Holder& holder) {
  const Vector3 change = mean - holder.mean_velocity;
  if (!is_greater_than_a_motion(change)) return false;
  const double jerk = (change - holder.change).norm();
  if (jerk <= greatest_change || jerk <= sudden * holder.change.norm()) return false;
  if (time_step > longest_jump * (1 + rounding) && change.norm() <= out_of_proportion * holder.liveliness) return false;
  const Vector3 before = holder.change.norm() <= steady_change ? holder.mean_velocity : holder.average_velocity;
  if (!is_greater_than_a_motion(mean - before)) return false;
  holder.mean_velocity = before;
  return true;
}

/// Whether what has gone on for some steps, and goes on with this excess of velocity, may be a jump. Where it does not fit into
/// the longest time with its whole first and last step, it does with parts of them if it has one speed.
bool is_short(double excess, double time_step, const Holder& holder) {
  const int steps = holder.jumping_steps + 1;
  const double longest = longest_jump / time_step * (1 + rounding);
  // Two steps may both be parts: how long it lasted in them cannot be told.
  if (steps <= std::max(longest, 2.0)) return true;
  const double least = holder.jumping_steps > 2 ? std::min(holder.least_excess, holder.last_excess) : holder.last_excess;
  const double greatest = std::max(holder.greatest_excess, holder.last_excess);
  return greatest - least <= one_speed * greatest && steps - 2 + (holder.first_excess + excess) / greatest <= longest;
}

void begin_or_continue_jump(double excess, Holder& holder) {
  if (holder.jumping_steps == 0) {
    holder.jumped_from = holder.position;
    holder.first_excess = excess;
  } else if (holder.jumping_steps > 1) {
    holder.least_excess = holder.jumping_steps == 2 ? holder.last_excess : std::min(holder.least_excess, holder.last_excess);
    holder.greatest_excess = std::max(holder.greatest_excess, holder.last_excess);
  }
  holder.last_excess = excess;
  ++holder.jumping_steps;
}

/// What a change of velocity turns out to be.
enum class Change { none, undecided, jump, motion };

/// The change in a step with this mean velocity. One that lasts is a motion, and to be followed; until that is known it may be a
/// jump. What trembles goes as its mean does.
Change judge(const Vector3& mean, double time_step, Holder& holder) {
  if (holder.jumping_steps == 0 && !may_begin_jump(mean, time_step, holder)) return Change::none;
  const double excess = (mean - holder.mean_velocity).norm();
  if (excess <= greatest_change) return Change::jump;
  if (is_short(excess, time_step, holder)) {
    begin_or_continue_jump(excess, holder);
    return Change::undecided;
  }
  const Vector3 lasting = (holder.next_position - holder.jumped_from) / ((holder.jumping_steps + 1) * time_step);
  if (is_greater_than_a_motion(lasting - holder.mean_velocity)) return Change::motion;
  end_jump(holder);
  holder.mean_velocity = lasting;
  if (!is_greater_than_a_motion(mean - lasting)) return Change::none;
  begin_or_continue_jump((mean - lasting).norm(), holder);
  return Change::undecided;
}

/// Keeps in mind how a holder moves in a step.
void note_motion(const Vector3& change, const Vector3& mean, double time_step, Holder& holder) {
  holder.change = change;
  holder.liveliness = std::max(fading * holder.liveliness, change.norm());
  holder.average_velocity += time_step / (averaging_time + time_step) * (mean - holder.average_velocity);
}

/// Catches a node where it is.
Holder caught(int attachment, const Target& target, const Vector3& position, const Vector3& velocity, double time) {
  Holder holder;
  holder.attachment = attachment;
  holder.node = target.node;
  holder.position = position;
  holder.velocity = velocity;
  holder.mean_velocity = holder.frame_velocity = holder.average_velocity = velocity;
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

std::vector<int> attachments_of(int index, bool net, const std::vector<Attachment>& attachments) {
  std::vector<int> own;
  for (int a = 0; a < static_cast<int>(attachments.size()); ++a)
    if ((net ? attachments[a].net : attachments[a].cable) == index) own.push_back(a);
  return own;
}

Holders find_holders(const CableModel& model, const CableState& state, const std::vector<Attachment>& attachments,
                     const std::vector<int>& attached, const std::vector<Pose>& frames, const Holders& before, double time) {
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
    for (const int a : attached) {
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
    holder.liveliness = greatest_change;
    if (frame >= inputs.size() || !inputs[frame].velocity) continue;
    const FrameVelocity& of_frame = *inputs[frame].velocity;
    const Vector3 velocity = of_frame.linear + of_frame.angular.cross(holder.position - frames[frame].position);
    if (!velocity.allFinite()) continue;
    holder.starts = false;
    holder.velocity = holder.mean_velocity = holder.next_velocity = velocity;
    holder.frame_velocity = holder.average_velocity = velocity;
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

Holders find_net_holders(const std::vector<Vector3>& positions, const std::vector<Vector3>& velocities,
                         const std::vector<Attachment>& attachments, const std::vector<int>& attached,
                         const std::vector<Pose>& frames, const Holders& before, double time) {
  Holders holders;
  for (const int a : attached) {
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
      if (mean.norm() <= fastest_start) holder.velocity = holder.mean_velocity = holder.average_velocity = mean;
      following.started = true;
    }
    // What a node that has just been caught was doing is no motion of a frame.
    const bool is_new = time - holder.caught < 1.5 * time_step;
    const Change change = is_new ? Change::none : judge(mean, time_step, holder);
    if (change == Change::undecided) {
      const Vector3 way = holder.next_position - holder.position - time_step * holder.mean_velocity;
      holder.position += way;
      holder.carried += way;
      holder.frame_velocity = mean;
      holder.next_velocity = holder.mean_velocity;
      if (following.jumping_node < 0) following.jumping_node = holder.node;
      for (DirectionHolder& direction : holders.directions)
        if (direction.attachment == holder.attachment) direction.orientation = direction.next_orientation;
      continue;
    }
    if (change == Change::jump && holder.node == attachments[holder.attachment].node) {
      const double duration = holder.jumping_steps * time_step;
      over.push_back({holder.attachment, holder.carried.norm(), time - time_step - duration, duration});
    }
    if (change == Change::motion) {
      note_motion(mean - holder.frame_velocity, mean, time_step, holder);
      holder.average_velocity = holder.mean_velocity = mean;
    } else {
      note_motion(mean - holder.mean_velocity, mean, time_step, holder);
      if (is_new) holder.average_velocity = mean;
    }
    end_jump(holder);
    holder.frame_velocity = mean;
    holder.next_velocity = mean + 0.5 * (mean - holder.mean_velocity);
  }
  return following;
}

void show_velocities(const Holders& holders, std::vector<Vector3>& velocities) {
  for (const Holder& holder : holders.nodes)
    if (holder.jumping_steps > 0 && holder.frame_velocity.norm() < holder.velocity.norm())
      velocities[holder.node] = holder.frame_velocity;
}

void take_back_shown_velocities(const Holders& holders, std::vector<Vector3>& velocities) {
  for (const Holder& holder : holders.nodes)
    if (holder.jumping_steps > 0) velocities[holder.node] = holder.velocity;
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

Boundary boundary_now(const Holders& holders) {
  Boundary boundary;
  hold_at(0, 0, holders, boundary);
  return boundary;
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
