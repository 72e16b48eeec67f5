#include "robot_model.h"

#include <console_bridge/console.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"
#include "verlet_cable/scene/resource.h"
#include "xml_outline.h"

namespace verlet_cable {
namespace {

constexpr std::size_t largest_text = std::size_t{4} << 20;  // [byte]
constexpr std::size_t deepest_level = 64;
constexpr std::size_t most_links = 1000;
constexpr std::size_t most_attributes = 1000;  // of an element: the parser compares each with all before it
constexpr std::size_t most_collisions = 5000;  // of all links in use
constexpr std::size_t most_reference_digits = 7;
/// urdfdom uses texts of the file as formats of its messages, where `%n` writes to memory: it is shown this for each `%`.
constexpr char percent_stand_in = '\x1f';

std::string replaced(std::string text, char from, char to) {
  std::replace(text.begin(), text.end(), from, to);
  return text;
}

/// A text of the model as the file has it.
std::string original(const std::string& text) {
  return replaced(text, percent_stand_in, '%');
}

/// What urdfdom would print, as long as this is there.
class CapturedErrors : public console_bridge::OutputHandler {
 public:
  CapturedErrors() { console_bridge::useOutputHandler(this); }
  ~CapturedErrors() override { console_bridge::restorePreviousOutputHandler(); }
  CapturedErrors(const CapturedErrors&) = delete;
  CapturedErrors& operator=(const CapturedErrors&) = delete;

  void log(const std::string& text, console_bridge::LogLevel level, const char*, int) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR) text_ += (text_.empty() ? "" : "; ") + text;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
};

InitialPose to_pose(const urdf::Pose& pose) {
  InitialPose numbers{pose.position.x, pose.position.y, pose.position.z};
  pose.rotation.getRPY(numbers[3], numbers[4], numbers[5]);
  return numbers;
}

void set_shape(const urdf::Geometry& geometry, ObstacleDesc& obstacle) {
  switch (geometry.type) {
    case urdf::Geometry::SPHERE:
      obstacle.type = ShapeType::sphere;
      obstacle.radius = static_cast<const urdf::Sphere&>(geometry).radius;
      break;
    case urdf::Geometry::CYLINDER:
      obstacle.type = ShapeType::cylinder;
      obstacle.radius = static_cast<const urdf::Cylinder&>(geometry).radius;
      obstacle.length = static_cast<const urdf::Cylinder&>(geometry).length;
      break;
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
      obstacle.type = ShapeType::box;
      obstacle.size = {size.x, size.y, size.z};
      break;
    }
    case urdf::Geometry::MESH: {
      const urdf::Mesh& mesh = static_cast<const urdf::Mesh&>(geometry);
      obstacle.type = ShapeType::mesh;
      obstacle.uri = original(mesh.filename);
      obstacle.scale = {mesh.scale.x, mesh.scale.y, mesh.scale.z};
      break;
    }
  }
}

[[noreturn]] void refuse(std::size_t byte, const std::string& what) {
  throw ResourceError("no URDF: byte " + std::to_string(byte) + ": " + what);
}

/// XML has no control characters, one of which stands for `%`, and references must not become `%`: some parsers keep only the
/// last byte of a character's number.
void check_characters(const std::string& text) {
  const auto is_control = [](char c) { return c >= 0 && c < ' ' && c != '\t' && c != '\r' && c != '\n'; };
  const auto control = std::find_if(text.begin(), text.end(), is_control);
  if (control != text.end()) refuse(static_cast<std::size_t>(control - text.begin()), "a control character");
  for (std::size_t at = text.find("&#"); at != std::string::npos; at = text.find("&#", at + 1)) {
    const bool is_hexadecimal = text.compare(at + 2, 1, "x") == 0;
    const std::size_t first = at + (is_hexadecimal ? 3 : 2);
    const std::size_t end = text.find_first_not_of(is_hexadecimal ? "0123456789abcdefABCDEF" : "0123456789", first);
    if (end == std::string::npos || text[end] != ';' || end == first || end - first > most_reference_digits)
      refuse(at, "a reference to no character");
    if (std::strtoul(text.c_str() + first, nullptr, is_hexadecimal ? 16 : 10) % 256 == '%')
      refuse(at, "a reference to the character %, or to one that some parsers take for it");
  }
}

void check_number(std::size_t number, std::size_t most, const std::string& what) {
  if (number > most)
    throw ResourceError("no URDF: " + std::to_string(number) + " " + what + ", more than " + std::to_string(most));
}

/// Checks a text, since the parser and the model call themselves for each level of elements and of links, and blanks what is not
/// needed: urdfdom takes no geometry of a link after an inertia, a material or a visual element that it does not understand.
std::string needed_text(std::string text, RobotDesc::Geometry geometry) {
  check_number(text.size(), largest_text, "bytes");
  std::set<std::string> unneeded = {"inertial", "material"};
  if (geometry == RobotDesc::Geometry::collision) unneeded.insert("visual");
  const XmlOutline outline = outline_of(text, unneeded);
  check_number(outline.levels, deepest_level, "levels of nested elements");
  check_number(outline.links, most_links, "links");
  check_number(outline.attributes, most_attributes, "attributes on one element");
  if (!outline.problem.empty()) throw ResourceError("no URDF: " + outline.problem);
  check_characters(text);
  for (const auto& [first, end] : outline.named)
    std::fill(text.begin() + static_cast<std::ptrdiff_t>(first), text.begin() + static_cast<std::ptrdiff_t>(end), ' ');
  return text;
}

class TreeBuilder {
 public:
  TreeBuilder(const urdf::ModelInterface& model, const RobotDesc& robot)
      : robot_(robot), selected_(robot.links.begin(), robot.links.end()) {
    std::size_t collisions = 0;
    for (const auto& link : model.links_) {
      const std::string name = original(link.first);
      if (name.empty()) throw ResourceError("no URDF: a link with the name \"\"");
      if (name.size() > most_name_characters)
        throw ResourceError("no URDF: link " + in_quotes(name) + ", a name of " + std::to_string(name.size()) +
                            " characters, more than " + std::to_string(most_name_characters));
      taken_.insert(name);
      if (is_selected(name)) collisions += geometry_of(*link.second).size();
    }
    check_number(collisions, most_collisions, robot.links.empty() ? "collisions" : "collisions of the links in robot.links");
    add(*model.getRoot(), -1);
  }

  std::vector<LinkDesc> take() && { return std::move(tree_); }

 private:
  bool is_selected(const std::string& link) const { return selected_.empty() || selected_.count(link) > 0; }

  void add(const urdf::Link& link, int parent) {
    const int index = static_cast<int>(tree_.size());
    LinkDesc desc;
    desc.name = original(link.name);
    desc.parent = parent;
    if (link.parent_joint) {
      desc.fixed = link.parent_joint->type == urdf::Joint::FIXED;
      desc.origin = to_pose(link.parent_joint->parent_to_joint_origin_transform);
    }
    if (is_selected(desc.name)) add_obstacles(link, desc);
    tree_.push_back(std::move(desc));
    for (const urdf::LinkSharedPtr& child : link.child_links) add(*child, index);
  }

  struct Placed {
    urdf::GeometrySharedPtr geometry;
    urdf::Pose origin;
  };
  template <class Elements>
  static std::vector<Placed> placed(const Elements& elements) {
    std::vector<Placed> all;
    for (const auto& element : elements)
      if (element && element->geometry) all.push_back({element->geometry, element->origin});
    return all;
  }
  std::vector<Placed> geometry_of(const urdf::Link& link) const {
    using Geometry = RobotDesc::Geometry;
    std::vector<Placed> found;
    if (robot_.geometry != Geometry::visual) found = placed(link.collision_array);
    if (robot_.geometry == Geometry::visual || (robot_.geometry == Geometry::collision_or_visual && found.empty()))
      found = placed(link.visual_array);
    return found;
  }

  void add_obstacles(const urdf::Link& link, LinkDesc& desc) {
    int number = 0;
    for (const Placed& placed : geometry_of(link)) {
      ObstacleDesc obstacle;
      obstacle.name = desc.name;
      while (!desc.obstacles.empty() && !taken_.insert(obstacle.name).second)
        obstacle.name = desc.name + "_" + std::to_string(++number);
      obstacle.frame = desc.name;
      obstacle.pose = to_pose(placed.origin);
      obstacle.padding = robot_.padding;
      set_shape(*placed.geometry, obstacle);
      desc.obstacles.push_back(std::move(obstacle));
    }
  }

  const RobotDesc& robot_;
  const std::set<std::string> selected_;  ///< names of links; empty: all
  std::set<std::string> taken_;           ///< names
  std::vector<LinkDesc> tree_;
};

}  // namespace

std::vector<LinkDesc> read_urdf(const std::string& text, const RobotDesc& robot) {
  const std::string needed = needed_text(text, robot.geometry);
  const CapturedErrors errors;
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(replaced(needed, '%', percent_stand_in));
  // urdfdom goes on without a collision that it cannot read.
  if (!model || !model->getRoot() || !errors.text().empty()) {
    const std::string reason = errors.text().empty() ? "it does not parse" : errors.text();
    throw ResourceError("no URDF: " + escaped(original(reason), longest_message));
  }
  return TreeBuilder(*model, robot).take();
}

}  // namespace verlet_cable
