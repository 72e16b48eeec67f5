#include <algorithm>

#include "verlet_cable/core/cable_materials.h"
#include "verlet_cable/core/contact.h"
#include "verlet_cable/core/world.h"
#include "world/implementation.h"

namespace verlet_cable {

std::vector<SimulatedContact> contacts_of_both(const World& world) {
  std::vector<SimulatedContact> contacts = world.findings().contacts;
  const auto radius = [&](int cable, int segment) { return CableMaterials(world.cables()[cable])[segment].radius; };
  for (std::size_t i = 0, once = contacts.size(); i < once; ++i) {
    const SimulatedContact c = contacts[i];
    if (c.other_cable < 0) continue;
    const Vector3 across = (radius(c.cable, c.segment) + radius(c.other_cable, c.other_segment)) * c.normal;
    SimulatedContact& other = contacts.emplace_back();
    other.cable = c.other_cable;
    other.segment = c.other_segment;
    other.position = c.position - across;
    other.normal = -c.normal;
    other.force = -c.force;
    other.other_cable = c.cable;
    other.other_segment = c.segment;
    other.length = c.other_length;
    other.other_length = c.length;
  }
  return contacts;
}

const std::string& World::touched_name(const SimulatedContact& contact) const {
  return name_of_touched(contact, implementation_->state);
}

std::vector<std::string> solid_names(const World& world) {
  std::vector<std::string> names;
  for (const Obstacle& obstacle : world.obstacles()) names.push_back(obstacle.name);
  for (const SimulatedBody& body : world.bodies())
    if (!body.is_junction) names.push_back(body.name);
  return names;
}

ContactWrench World::contact_wrench(const std::string& name) const {
  const State& state = implementation_->state;
  ContactWrench wrench;
  const int body = find(state.bodies, name);
  const auto has_name = [&](const LinkDesc& link) { return link.name == name; };
  const std::optional<RobotDesc>& robot = state.scene->robot;
  const bool is_link = robot && std::any_of(robot->tree.begin(), robot->tree.end(), has_name);
  const auto is_meant = [&](const Obstacle& obstacle) {
    return obstacle.name == name || (is_link && state.frames.names[obstacle.frame] == name);
  };
  if (body >= 0) wrench.frame = state.bodies[body].frame;
  for (const Obstacle& obstacle : state.obstacles)
    if (is_meant(obstacle)) wrench.frame = obstacle.frame;
  if (wrench.frame < 0) return wrench;
  const Vector3& origin = state.frames.poses[wrench.frame].position;
  const auto add = [&](const SimulatedContact& contact, double sign) {
    wrench.force += sign * contact.force;
    wrench.torque += sign * (contact.torque + (contact.position - origin).cross(contact.force));
  };
  for (const auto* contacts : {&findings().contacts, &findings().body_contacts})
    for (const SimulatedContact& contact : *contacts) {
      if (contact.obstacle >= 0 && is_meant(state.obstacles[contact.obstacle])) add(contact, -1);
      if (body >= 0 && contact.body == body) add(contact, contact.cable < 0 ? 1 : -1);
    }
  return wrench;
}

}  // namespace verlet_cable
