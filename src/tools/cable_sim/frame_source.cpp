#include "frame_source.h"

#include <algorithm>

namespace verlet_cable::cable_sim {

FrameSource::FrameSource(const SceneDesc& scene, const Motion& motion) : resting_(initial_frames(scene)) {
  for (FrameInput& frame : resting_) frame.known = true;
  for (const std::string& name : frame_names(scene)) {
    const auto track = motion.find(name);
    tracks_.push_back(track == motion.end() ? FrameTrack{} : track->second);
  }
}

BoundaryInputs FrameSource::at(double time) const {
  BoundaryInputs frames = resting_;
  for (std::size_t i = 0; i < tracks_.size(); ++i) {
    if (!tracks_[i].empty()) frames[i].pose = tracks_[i].at(time);
  }
  return frames;
}

std::vector<std::string> unused_frames(const SceneDesc& scene, const Motion& motion) {
  const std::vector<std::string> used = frame_names(scene);
  std::vector<std::string> unused;
  for (const auto& track : motion) {
    if (std::find(used.begin(), used.end(), track.first) == used.end()) unused.push_back(track.first);
  }
  return unused;
}

}  // namespace verlet_cable::cable_sim
