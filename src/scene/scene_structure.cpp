#include "scene_structure.h"

#include <algorithm>
#include <cstddef>

#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

/// As the keys of scenes name them.
/// @{
const char* text_of(AttachmentType type) {
  return type == AttachmentType::hinge ? "hinge" : type == AttachmentType::clamp ? "clamp" : "axle";
}
const char* text_of(GuideDesc::Type type) {
  return type == GuideDesc::Type::eyelet ? "eyelet" : type == GuideDesc::Type::sheave ? "sheave" : "clip";
}
const char* text_of(LinkType type) {
  return type == LinkType::spring ? "spring" : type == LinkType::limited ? "limited" : "rigid";
}
const char* text_of(ShapeType type) {
  switch (type) {
    case ShapeType::plane:
      return "plane";
    case ShapeType::sphere:
      return "sphere";
    case ShapeType::capsule:
      return "capsule";
    case ShapeType::cylinder:
      return "cylinder";
    case ShapeType::box:
      return "box";
    case ShapeType::mesh:
      return "mesh";
  }
  return "";
}
/// @}

std::string counted(std::size_t count, const std::string& thing) {
  return std::to_string(count) + " " + thing + (count == 1 ? "" : "s");
}

template <class Items, class Text>
std::vector<std::string> texts_of(const Items& items, const Text& text_of_one) {
  std::vector<std::string> texts;
  for (const auto& item : items) texts.push_back(text_of_one(item));
  return texts;
}

std::string in_frame(const std::string& frame, const SceneDesc& scene) {
  return frame.empty() ? scene.frame_id : frame;
}

std::string of_cable(const CableDesc& cable) {
  std::string text = cable.name + " of " + counted(static_cast<std::size_t>(cable.segments), "segment") + " of " + cable.material;
  for (const SectionDesc& section : cable.sections) text += " and " + section.material;
  return text;
}

/// Which nodes a net's links join, as a number: a list may be long.
std::size_t sum_of(const std::vector<std::array<int, 2>>& links) {
  std::size_t sum = 0;
  for (const auto& link : links)
    for (const int node : link) sum = sum * 31 + static_cast<std::size_t>(node);
  return sum;
}

std::string of_net(const NetDesc& net) {
  const std::string nodes = net.grid ? std::to_string(net.grid->rows) + " x " + std::to_string(net.grid->columns) + " nodes"
                                     : counted(net.node_count(), "node") + " and " + counted(net.link_count(), "link") +
                                           " of sum " + std::to_string(sum_of(net.links));
  return net.name + " (" + nodes + "; " + text_of(net.link_type) + ")";
}

std::string of_body(const BodyDesc& body) {
  std::string shapes;
  for (const ShapeDesc& shape : body.shapes) shapes += (shapes.empty() ? " (" : " and ") + std::string(text_of(shape.type));
  return body.name + shapes + (shapes.empty() ? "" : ")");
}

std::string of_junction(const JunctionDesc& junction) {
  std::string text =
      junction.name + " (" + (junction.type == JunctionDesc::Type::rigid ? "rigid" : "hinge") + " on " + junction.cable;
  for (const BranchDesc& branch : junction.branches)
    text += " and " + branch.cable + (branch.end == BranchDesc::End::start ? "'s start" : "'s end");
  return text + ")";
}

std::vector<std::string> attachments_of(const SceneDesc& scene) {
  std::vector<std::string> texts;
  const auto add = [&](const std::string& name, AttachmentType type, const std::string& holder) {
    texts.push_back(name + " (" + text_of(type) + " on " + in_frame(holder, scene) + ")");
  };
  const auto add_all = [&](const auto& attachments) {
    for (const auto& a : attachments) add(a.name, a.type, a.body.empty() ? a.frame : a.body);
  };
  for (const CableDesc& cable : scene.cables) add_all(cable.attachments);
  for (const NetDesc& net : scene.nets)
    for (const NetAttachmentDesc& a : net.attachments) add(a.name, AttachmentType::hinge, a.frame);
  for (const BodyDesc& body : scene.bodies) add_all(body.attachments);
  return texts;
}

}  // namespace

SceneStructure structure_of(const SceneDesc& scene) {
  const auto name = [](const auto& item) { return item.name; };
  const auto of_guide = [&](const GuideDesc& guide) {
    return guide.name + " (" + text_of(guide.type) + " for " + guide.cable + " on " +
           in_frame(guide.body.empty() ? guide.frame : guide.body, scene) + ")";
  };
  const auto of_obstacle = [&](const ObstacleDesc& obstacle) {
    return obstacle.name + " (" + text_of(obstacle.type) + " in " + in_frame(obstacle.frame, scene) + ")";
  };
  return {
      {"frames", frame_names(scene)},
      {"materials", texts_of(scene.materials, name)},
      {"cables", texts_of(scene.cables, of_cable)},
      {"nets", texts_of(scene.nets, of_net)},
      {"particles", texts_of(scene.particles, name)},
      {"bodies", texts_of(scene.bodies, of_body)},
      {"junctions", texts_of(scene.junctions, of_junction)},
      {"guides", texts_of(scene.guides, of_guide)},
      {"attachments", attachments_of(scene)},
      {"obstacles", texts_of(all_obstacles(scene), of_obstacle)},
      {"time_step", {number_text(scene.time_step) + " s"}},
  };
}

}  // namespace verlet_cable
