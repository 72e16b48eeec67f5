#include <algorithm>

#include "verlet_cable/core/world.h"
#include "world_implementation.h"

namespace verlet_cable {

namespace {

Pose between(const Pose& a, const Pose& b, double part) {
  return {a.position + part * (b.position - a.position), a.orientation.slerp(part, b.orientation)};
}

double largest_distance(const Aabb& box, const Vector3& from) {
  return (box.max() - from).cwiseAbs().cwiseMax((box.min() - from).cwiseAbs()).norm();
}

}  // namespace

void note_intrusions(ContactGroup& group) {
  std::vector<Intrusion>& noted = group.scratch.intrusions;
  for (const Intrusion& found : group.contacts.intrusions()) {
    const auto same = std::find_if(noted.begin(), noted.end(), [&](const Intrusion& other) {
      return other.cable == found.cable && other.obstacle == found.obstacle;
    });
    if (same == noted.end()) {
      noted.push_back(found);
    } else if (same->depth < found.depth) {
      *same = found;
    }
  }
}

/// Cables that may touch each other are one group; else each is its own.
void World::Implementation::form_groups() {
  groups.clear();
  if (scene.contact && scene.contact->between_cables) {
    groups.resize(cables.empty() ? 0 : 1);
    for (std::size_t i = 0; i < cables.size(); ++i) groups.front().cables.push_back(static_cast<int>(i));
    return;
  }
  groups.resize(cables.size());
  for (std::size_t i = 0; i < cables.size(); ++i) groups[i].cables.push_back(static_cast<int>(i));
}

/// The obstacles that are there, as they move over a part of the step.
void World::Implementation::move_obstacles(double from, double to, std::vector<MovingObstacle>& all) const {
  all.clear();
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    const Obstacle& obstacle = obstacles[i];
    if (!obstacle.present) continue;
    const Pose &before = previous_poses[obstacle.frame], &after = poses[obstacle.frame];
    MovingObstacle moving;
    moving.obstacle = &obstacle;
    moving.index = static_cast<int>(i);
    moving.start = between(before, after, from) * obstacle.pose;
    moving.end = between(before, after, to) * obstacle.pose;
    moving.box = bounds(obstacle.shape, moving.start);
    const double angle = before.orientation.angularDistance(after.orientation);
    double distance = (after.position - before.position).norm();
    if (angle > 0) distance += angle * largest_distance(moving.box, moving.start.position);
    moving.speed = distance / scene.time_step;
    all.push_back(moving);
  }
}

ContactRules World::Implementation::contact_rules(bool still) const {
  ContactRules rules;
  rules.still = still;
  rules.time_step = scene.time_step;
  if (scene.contact) {
    rules.pairs = {scene.contact->self, scene.contact->between_cables};
    rules.cable_friction = scene.contact->friction;
  }
  return rules;
}

void World::Implementation::find_contacts(ContactGroup& group, double from, double to) {
  move_obstacles(from, to, group.scratch.obstacles);
  group.contacts.find(cables, group.cables, group.scratch.obstacles, attachments, contact_rules(false),
                      (to - from) * scene.time_step);
}

std::vector<SimulatedContact> World::contacts() const {
  std::vector<SimulatedContact> contacts;
  for (const ContactGroup& group : implementation_->groups)
    for (const Touch& touch : group.contacts.touches()) {
      if (touch.mode == Touch::Mode::open) continue;
      contacts.push_back({touch.point.cable, touch.point.segment, touch.position, touch.normal, touch.force, touch.obstacle,
                          touch.other.cable, touch.other.segment});
    }
  return contacts;
}

}  // namespace verlet_cable
