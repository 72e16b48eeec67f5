#include "obstacle_keys.h"

#include "verlet_cable/scene/resource.h"

namespace verlet_cable {
namespace {

constexpr const char* pose_words = "six numbers: x, y, z [m], roll, pitch, yaw [rad]";
constexpr const char* link_words = "all, or a list of at least one link";

void read_friction(const Value& value, ObstacleDesc& obstacle) {
  obstacle.friction = read_number(value, not_negative.text());
}

/// One factor for all directions, or three.
void read_scale(const Value& value, ShapeDesc& shape) {
  const std::string allowed = "one or three numbers above 0";
  if (value.node.IsScalar()) {
    shape.scale.setConstant(read_number(value, allowed));
  } else {
    const auto factors = read_numbers<3>(value, allowed);
    shape.scale = {factors[0], factors[1], factors[2]};
  }
}

const Keys<ShapeDesc>& shape_keys() {
  static const Keys<ShapeDesc> keys = [] {
    Keys<ShapeDesc> shape{
        choice_key("type", &ShapeDesc::type,
                   {{"plane", ShapeType::plane},
                    {"sphere", ShapeType::sphere},
                    {"capsule", ShapeType::capsule},
                    {"cylinder", ShapeType::cylinder},
                    {"box", ShapeType::box},
                    {"mesh", ShapeType::mesh}},
                   true),
        {"pose", pose_words, false, [](const Value& value, ShapeDesc& s) { s.pose = read_numbers<6>(value, pose_words); }},
        vector_key("size", &ShapeDesc::size, "m"),
        text_key("uri", &ShapeDesc::uri, uri_words),
        {"scale", "one or three numbers above 0", false, read_scale},
    };
    append_fields(shape, shape_fields);
    return shape;
  }();
  return keys;
}

const Keys<ObstacleDesc>& obstacle_keys() {
  static const Keys<ObstacleDesc> keys = [] {
    Keys<ObstacleDesc> obstacle{
        text_key("name", &ObstacleDesc::name, name_words, true),
        text_key("frame", &ObstacleDesc::frame, frame_words),
        {"friction", not_negative.text(), false, read_friction},
        {"initial_pose", pose_words, false,
         [](const Value& value, ObstacleDesc& o) { o.initial_pose = read_numbers<6>(value, pose_words); }},
    };
    append_keys(obstacle, shape_keys());
    return obstacle;
  }();
  return keys;
}

/// Dimensions go with their type: others are errors, and all that the type has are required but `scale`.
void check_dimensions(const Value& value, const std::set<std::string>& given, ShapeType type) {
  if (!given.count("type") || value.errors->is_unread(value.child("type", {}).key)) {
    for (const char* key : {"radius", "length", "size", "uri"}) value.errors->mark(value.child(key, {}).key);
    return;
  }
  for (const char* key : {"radius", "length", "size", "uri", "scale"}) {
    const std::string full_key = value.child(key, {}).key;
    const bool has = has_dimension(type, key);
    if (given.count(key) && !has) value.errors->add(full_key, "given with another type", "only with a type that has this key");
    if (!given.count(key) && has && key != std::string("scale"))
      value.errors->add_unread(full_key, "missing", "a value, as obstacles of this type need it");
  }
}

void read_obstacle(const Value& value, ObstacleDesc& obstacle) {
  check_dimensions(value, read_map(value, obstacle_keys(), obstacle), obstacle.type);
}

void read_links(const Value& value, RobotDesc& robot) {
  if (value.node.IsScalar() && value.node.Scalar() == "all") return;
  if (!value.node.IsSequence() || value.node.size() == 0) return value.reject(link_words);
  robot.links = read_list<std::string>(
      value, [](const Value& element, std::string& link) { link = read_text(element, "the name of a link"); });
}

const Keys<RobotDesc>& robot_keys() {
  static const Keys<RobotDesc> keys{
      text_key("description", &RobotDesc::description, "the name of a parameter"),
      text_key("file", &RobotDesc::file, "a URDF file"),
      {"links", link_words, false, read_links},
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
