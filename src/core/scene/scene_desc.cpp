#include "verlet_cable/core/scene_desc.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

namespace {

std::string lines(const std::vector<std::string>& errors) {
  std::string text;
  for (const std::string& error : errors) text += (text.empty() ? "" : "\n") + error;
  return text;
}

bool is_fixed_frame(const SceneDesc& scene, const std::string& frame) {
  return frame.empty() || frame == scene.frame_id;
}

}  // namespace

bool InitialShapeDesc::is_given() const {
  return type == Type::straight || type == Type::points;
}

bool RestCurvatureDesc::is_straight() const {
  const std::array<double, 2> none{0, 0};
  if (type == Type::straight) return true;
  if (zero_counts) return false;
  return (type == Type::constant && curvature == none) ||
         (type == Type::profile && std::all_of(profile.begin(), profile.end(), [&](const auto& place) { return place == none; }));
}

Pose pose_of(const InitialPose& pose) {
  return {{pose[0], pose[1], pose[2]}, quaternion_from_rpy({pose[3], pose[4], pose[5]})};
}

std::vector<ObstacleDesc> all_obstacles(const SceneDesc& scene) {
  std::vector<ObstacleDesc> obstacles = scene.obstacles;
  if (scene.robot) {
    for (const LinkDesc& link : scene.robot->tree)
      obstacles.insert(obstacles.end(), link.obstacles.begin(), link.obstacles.end());
  }
  return obstacles;
}

SceneError::SceneError(std::vector<std::string> errors) : std::runtime_error(lines(errors)), errors_(std::move(errors)) {}

Vector3 GravityDesc::at(const Vector3& position) const {
  if (type == Type::uniform) return acceleration;
  const Vector3 inwards = center - position;
  const double distance = inwards.norm();
  return distance > 0 ? Vector3(mu / (distance * distance * distance) * inwards) : Vector3(Vector3::Zero());
}

double GravityDesc::potential_at(const Vector3& position) const {
  if (type == Type::uniform) return -acceleration.dot(position);
  const double distance = (center - position).norm();
  return distance > 0 ? -mu / distance : 0;
}

std::size_t NetDesc::node_count() const {
  return grid ? static_cast<std::size_t>(std::max(0, grid->rows)) * static_cast<std::size_t>(std::max(0, grid->columns))
              : nodes.size();
}

std::size_t NetDesc::link_count() const {
  if (!grid) return links.size();
  if (grid->rows < 1 || grid->columns < 1) return 0;
  const std::size_t rows = static_cast<std::size_t>(grid->rows), columns = static_cast<std::size_t>(grid->columns);
  return rows * (columns - 1) + (rows - 1) * columns + 2 * (rows - 1) * (columns - 1);
}

const MaterialDesc* SceneDesc::find_material(const std::string& name) const {
  const auto found = std::find_if(materials.begin(), materials.end(), [&](const NamedMaterial& m) { return m.name == name; });
  return found == materials.end() ? nullptr : &found->material;
}

int section_at(const CableDesc& cable, int segment) {
  const double middle = (segment + 0.5) * cable.length / cable.segments;
  const auto found = std::find_if(cable.sections.begin(), cable.sections.end(),
                                  [middle](const SectionDesc& section) { return middle >= section.from && middle < section.to; });
  return found == cable.sections.end() ? -1 : static_cast<int>(found - cable.sections.begin());
}

int node_at(const CableDesc& cable, const PlaceDesc& place) {
  switch (place.at) {
    case PlaceDesc::At::start:
      return 0;
    case PlaceDesc::At::end:
      return cable.segments;
    case PlaceDesc::At::arc_length:
      break;
  }
  const double node = std::round(place.arc_length / cable.length * cable.segments);
  return static_cast<int>(std::clamp(node, 0.0, static_cast<double>(cable.segments)));
}

std::vector<std::string> frame_names(const SceneDesc& scene) {
  std::vector<std::string> names{scene.frame_id};
  std::set<std::string> seen;
  const auto add = [&](const std::string& frame) {
    if (!is_fixed_frame(scene, frame) && seen.insert(frame).second) names.push_back(frame);
  };
  for (const CableDesc& cable : scene.cables)
    for (const AttachmentDesc& attachment : cable.attachments) add(attachment.frame);
  for (const NetDesc& net : scene.nets)
    for (const NetAttachmentDesc& attachment : net.attachments) add(attachment.frame);
  for (const BodyDesc& body : scene.bodies)
    for (const BodyAttachmentDesc& attachment : body.attachments) add(attachment.frame);
  for (const GuideDesc& guide : scene.guides) add(guide.frame);
  for (const ObstacleDesc& obstacle : all_obstacles(scene)) add(obstacle.frame);
  return names;
}

std::vector<std::string> computed_frame_names(const SceneDesc& scene) {
  std::vector<std::string> names;
  for (const BodyDesc& body : scene.bodies) names.push_back(body.name);
  // With a space, which no name of a scene has.
  for (const JunctionDesc& junction : scene.junctions) names.push_back("junction " + junction.name);
  return names;
}

BoundaryInputs initial_frames(const SceneDesc& scene) {
  std::map<std::string, InitialPose> poses;
  const auto add = [&](const auto& user) {
    if (user.initial_pose) poses.emplace(user.frame, *user.initial_pose);
  };
  for (const CableDesc& cable : scene.cables) std::for_each(cable.attachments.begin(), cable.attachments.end(), add);
  for (const NetDesc& net : scene.nets) std::for_each(net.attachments.begin(), net.attachments.end(), add);
  for (const BodyDesc& body : scene.bodies) std::for_each(body.attachments.begin(), body.attachments.end(), add);
  std::for_each(scene.guides.begin(), scene.guides.end(), add);
  std::for_each(scene.obstacles.begin(), scene.obstacles.end(), add);
  const std::vector<std::string> names = frame_names(scene);
  BoundaryInputs frames(names.size(), FrameInput{Pose{}, false});
  frames.front().known = true;
  for (std::size_t i = 1; i < names.size(); ++i) {
    const auto pose = poses.find(names[i]);
    if (pose != poses.end()) frames[i] = {pose_of(pose->second), true};
  }
  return frames;
}

}  // namespace verlet_cable
