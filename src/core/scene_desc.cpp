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

const MaterialDesc* SceneDesc::find_material(const std::string& name) const {
  const auto found = std::find_if(materials.begin(), materials.end(), [&](const NamedMaterial& m) { return m.name == name; });
  return found == materials.end() ? nullptr : &found->material;
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
  for (const CableDesc& cable : scene.cables) {
    for (const AttachmentDesc& attachment : cable.attachments) {
      if (is_fixed_frame(scene, attachment.frame)) continue;
      if (seen.insert(attachment.frame).second) names.push_back(attachment.frame);
    }
  }
  for (const ObstacleDesc& obstacle : all_obstacles(scene)) {
    if (is_fixed_frame(scene, obstacle.frame)) continue;
    if (seen.insert(obstacle.frame).second) names.push_back(obstacle.frame);
  }
  return names;
}

BoundaryInputs initial_frames(const SceneDesc& scene) {
  std::map<std::string, InitialPose> poses;
  for (const CableDesc& cable : scene.cables) {
    for (const AttachmentDesc& attachment : cable.attachments) {
      if (attachment.initial_pose) poses.emplace(attachment.frame, *attachment.initial_pose);
    }
  }
  for (const ObstacleDesc& obstacle : scene.obstacles) {
    if (obstacle.initial_pose) poses.emplace(obstacle.frame, *obstacle.initial_pose);
  }
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
