#include "scene/validate_obstacles.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {
namespace {

/// Each is looked at for each segment in each step.
constexpr std::size_t most_obstacles = 10'000;

void check_vector_is_positive(const std::string& key, const Vector3& v, const char* unit, Errors& errors) {
  check_numbers(key, std::array<double, 3>{v.x(), v.y(), v.z()}, positive, unit, errors);
}

void check_obstacle(const std::string& key, const ObstacleDesc& obstacle, Errors& errors) {
  const std::string prefix = key + ".";
  if (!obstacle.frame.empty() && !is_frame_name(obstacle.frame))
    errors.add(prefix + "frame", in_quotes(obstacle.frame), frame_words);
  check_numbers(prefix + "pose", obstacle.pose, coordinate, "m, rad", errors);
  if (obstacle.initial_pose) check_numbers(prefix + "initial_pose", *obstacle.initial_pose, coordinate, "m, rad", errors);
  check_shape(prefix, obstacle, errors);
  if (obstacle.friction && !not_negative.contains(*obstacle.friction))
    errors.add(prefix + "friction", number_text(*obstacle.friction), not_negative.text());
}

}  // namespace

void check_shape(const std::string& prefix, const ShapeDesc& shape, Errors& errors) {
  for (const Field<ShapeDesc>& field : shape_fields) {
    const double value = shape.*field.member;
    if (has_dimension(shape.type, field.key) && !field.range.contains(value))
      errors.add(prefix + field.key, number_text(value), field.range.text(field.unit));
  }
  if (shape.type == ShapeType::box) check_vector_is_positive(prefix + "size", shape.size, "m", errors);
  if (shape.type != ShapeType::mesh) return;
  // Signs mirror.
  const auto is_scale = [](double factor) { return positive.contains(std::abs(factor)); };
  if (!std::all_of(shape.scale.begin(), shape.scale.end(), is_scale))
    errors.add(prefix + "scale", list_text(shape.scale), scale_words);
  if (!shape.mesh) errors.add(prefix + "uri", in_quotes(shape.uri), "a mesh file that could be read");
}

void check_obstacles(const SceneDesc& scene, UniqueNames names, Errors& errors) {
  if (scene.obstacles.size() > most_obstacles)
    errors.add("obstacles", std::to_string(scene.obstacles.size()) + " obstacles", "at most " + std::to_string(most_obstacles));
  for (std::size_t i = 0; i < scene.obstacles.size(); ++i) {
    const std::string key = indexed("obstacles", i);
    names.check(key + ".name", scene.obstacles[i].name, errors);
    check_obstacle(key, scene.obstacles[i], errors);
  }
  if (scene.contact) check_fields("contact.", contact_fields, *scene.contact, errors);
  if (!scene.robot) return;
  check_fields("robot.", robot_fields, *scene.robot, errors);
  for (const LinkDesc& link : scene.robot->tree) {
    check_numbers("robot." + escaped(link.name) + ".origin", link.origin, coordinate, "m, rad", errors);
    for (const ObstacleDesc& obstacle : link.obstacles) {
      const std::string key = "robot." + escaped(obstacle.name);
      names.claim(key, obstacle.name, errors);  // any letters: links are named by the robot's makers
      check_obstacle(key, obstacle, errors);
    }
  }
}

}  // namespace verlet_cable
