#include "simulation/attachment_moves.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {
namespace {

constexpr double lag = 0.03;         // [s] of the guide behind its target, and of the attachment behind its guide
constexpr double highest_speed = 4;  // [m/s]
constexpr double arrived = 1e-7;     // [m], [rad]

/// A first-order lag; two in a row begin and end without a jump of the velocity.
Pose followed(const Pose& pose, const Pose& target, double time_step) {
  const double part = 1 - std::exp(-time_step / lag);
  const Vector3 way = target.position - pose.position;
  const double longest = highest_speed * time_step;
  const double reached = std::min(part, longest / std::max(way.norm(), longest));
  return {pose.position + reached * way, pose.orientation.slerp(part, target.orientation).normalized()};
}

bool is_at(const Pose& pose, const Pose& target) {
  return (pose.position - target.position).norm() < arrived && pose.orientation.angularDistance(target.orientation) < arrived;
}

}  // namespace

void AttachmentMoves::send(const std::string& attachment, const Pose& from, const Pose& target) {
  moves_.try_emplace(attachment, Move{target, from}).first->second.target = target;
}

const Pose* AttachmentMoves::target(const std::string& attachment) const {
  const auto found = moves_.find(attachment);
  return found == moves_.end() ? nullptr : &found->second.target;
}

void AttachmentMoves::advance(double time_step, World& world) {
  for (auto entry = moves_.begin(); entry != moves_.end();) {
    auto& [name, move] = *entry;
    const int index = find(world.attachments(), name);
    if (index < 0) {
      entry = moves_.erase(entry);
      continue;
    }
    move.guide = followed(move.guide, move.target, time_step);
    const Pose pose = followed(world.attachments()[index].pose, move.guide, time_step);
    const bool there = is_at(pose, move.target);
    world.apply(edit::MoveAttachment{name, there ? move.target : pose});
    entry = there ? moves_.erase(entry) : std::next(entry);
  }
}

}  // namespace verlet_cable
