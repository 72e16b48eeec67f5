#include "verlet_cable/core/frame_keys.h"

#include "scene/validate_holders.h"

namespace verlet_cable {

std::vector<std::string> keys_of_frame(const SceneDesc& scene, const std::string& frame) {
  std::vector<std::string> keys;
  const auto check = [&](const std::string& key, const std::string& name) {
    if (name == frame) keys.push_back(key);
  };
  check("frame_id", scene.frame_id);
  visit_frame_users(scene, [&](const std::string& key, const auto& user) { check(key + ".frame", user.frame); });
  for (std::size_t i = 0; scene.broadcast_tf && i < scene.bodies.size(); ++i)
    check(indexed("bodies", i) + ".name", scene.bodies[i].name);
  if (!scene.robot) return keys;
  for (const LinkDesc& link : scene.robot->tree) check("robot." + escaped(link.name), link.name);
  return keys;
}

}  // namespace verlet_cable
