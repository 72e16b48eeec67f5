#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable::cable_sim {

/// Where a scene's frames are over time: by the motion, else at their `initial_pose`, else at the origin.
class FrameSource {
 public:
  FrameSource(const SceneDesc& scene, const Motion& motion);

  /// One entry a frame id, all known.
  BoundaryInputs at(double time) const;

 private:
  BoundaryInputs resting_;
  std::vector<FrameTrack> tracks_;  ///< one a frame id, empty where it rests
};

/// Names of the motion's frames that nothing in the scene uses.
std::vector<std::string> unused_frames(const SceneDesc& scene, const Motion& motion);

}  // namespace verlet_cable::cable_sim
