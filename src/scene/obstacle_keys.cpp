#include "obstacle_keys.h"

#include "shape_keys.h"

namespace verlet_cable {
namespace {

constexpr const char* link_words = "all, or a list of at least one link";

void read_friction(const Value& value, ObstacleDesc& obstacle) {
  obstacle.friction = read_number(value, not_negative.text());
}

const Keys<ObstacleDesc>& obstacle_keys() {
  static const Keys<ObstacleDesc> keys = [] {
    Keys<ObstacleDesc> obstacle{
        text_key("name", &ObstacleDesc::name, name_words, true),
        text_key("frame", &ObstacleDesc::frame, frame_words),
        {"friction", not_negative.text(), false, read_friction},
        pose_key("initial_pose", &ObstacleDesc::initial_pose),
    };
    append_keys(obstacle, shape_keys());
    return obstacle;
  }();
  return keys;
}

void read_obstacle(const Value& value, ObstacleDesc& obstacle) {
  const std::set<std::string> given = read_map(value, obstacle_keys(), obstacle);
  check_dimensions(value, given, obstacle.type);
}

void read_links(const Value& value, RobotDesc& robot) {
  if (value.node.IsScalar() && value.node.Scalar() == "all") return;
  if (!value.node.IsSequence() || value.node.size() == 0) return value.reject(link_words);
  robot.links = read_list<std::string>(
      value, [](const Value& element, std::string& link) { link = read_text(element, "the name of a link"); });
  std::set<std::string> seen;
  for (std::size_t i = 0; i < robot.links.size(); ++i) {
    const std::string& link = robot.links[i];
    // What could not be read is empty.
    if (!link.empty() && !seen.insert(link).second)
      value.errors->add(value.element(i, {}).key, in_quotes(link) + " given twice", "each link once");
  }
}

const Keys<RobotDesc>& robot_keys() {
  static const Keys<RobotDesc> keys{
      text_key("description", &RobotDesc::description, "the name of a parameter, or file:PATH"),
      text_key("file", &RobotDesc::file, "a URDF file"),
      {"links", link_words, false, read_links},
      choice_key("on_bad_mesh", &RobotDesc::on_bad_mesh,
                 {{"warn", RobotDesc::OnBadMesh::warn}, {"error", RobotDesc::OnBadMesh::error}}),
      choice_key("geometry", &RobotDesc::geometry,
                 {{"collision", RobotDesc::Geometry::collision},
                  {"visual", RobotDesc::Geometry::visual},
                  {"collision_or_visual", RobotDesc::Geometry::collision_or_visual}}),
      field_key(robot_fields[0]),
  };
  return keys;
}

const Keys<ContactDesc>& contact_keys() {
  static const Keys<ContactDesc> keys{switch_key("self", &ContactDesc::self),
                                      switch_key("between_cables", &ContactDesc::between_cables), field_key(contact_fields[0])};
  return keys;
}

}  // namespace

void append_obstacle_keys(Keys<SceneDesc>& keys) {
  keys.push_back({"obstacles", "a list of obstacles", false,
                  [](const Value& value, SceneDesc& scene) { scene.obstacles = read_list<ObstacleDesc>(value, read_obstacle); }});
  keys.push_back({"robot", "a map", false,
                  [](const Value& value, SceneDesc& scene) { read_map(value, robot_keys(), scene.robot.emplace()); }});
  keys.push_back({"contact", "a map", false,
                  [](const Value& value, SceneDesc& scene) { read_map(value, contact_keys(), scene.contact.emplace()); }});
}

}  // namespace verlet_cable
