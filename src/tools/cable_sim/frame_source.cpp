#include "frame_source.h"

#include <algorithm>

namespace verlet_cable::cable_sim {

FrameSource::FrameSource(const SceneDesc& scene, const Motion& motion) {
  const std::vector<std::string> names = frame_names(scene);
  const BoundaryInputs initial = initial_frames(scene);
  for (std::size_t i = 0; i < names.size(); ++i) add_frame(names[i], initial[i], motion);
  ids_ = static_cast<int>(names.size());
  if (!scene.robot) return;
  for (const LinkDesc& desc : scene.robot->tree) {
    Link link;
    link.parent = desc.parent;
    link.origin = pose_of(desc.origin);
    const auto id = static_cast<std::size_t>(std::find(names.begin(), names.end(), desc.name) - names.begin());
    const bool used = id < names.size();
    if (motion.count(desc.name) || (used && initial[id].known)) {
      link.frame = used ? static_cast<int>(id) : add_frame(desc.name, {}, motion);
    } else if (used) {
      link.id = static_cast<int>(id);
    }
    links_.push_back(link);
  }
}

int FrameSource::add_frame(const std::string& name, const FrameInput& resting, const Motion& motion) {
  const auto track = motion.find(name);
  frames_.push_back({track == motion.end() ? FrameTrack{} : track->second, resting.pose});
  return static_cast<int>(frames_.size()) - 1;
}

BoundaryInputs FrameSource::at(double time) const {
  std::vector<Pose> poses;
  for (const Frame& frame : frames_) poses.push_back(frame.track.empty() ? frame.resting : frame.track.at(time));
  std::vector<Pose> links;
  for (const Link& link : links_) {
    const Pose parent = link.parent < 0 ? Pose{} : links[link.parent];
    links.push_back(link.frame < 0 ? parent * link.origin : poses[link.frame]);
    if (link.id >= 0) poses[link.id] = links.back();
  }
  BoundaryInputs inputs;
  for (int id = 0; id < ids_; ++id) inputs.push_back({poses[id], true});
  return inputs;
}

std::vector<std::string> unused_frames(const SceneDesc& scene, const Motion& motion) {
  std::vector<std::string> used = frame_names(scene);
  if (scene.robot)
    for (const LinkDesc& link : scene.robot->tree) used.push_back(link.name);
  std::vector<std::string> unused;
  for (const auto& track : motion) {
    if (std::find(used.begin(), used.end(), track.first) == used.end()) unused.push_back(track.first);
  }
  return unused;
}

}  // namespace verlet_cable::cable_sim
