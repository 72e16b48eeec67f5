#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {

/// Where a scene's frames are over time: by the motion, else at their `initial_pose`; else a robot's link is where its parent has it
/// with the joint at zero; else at the origin.
class FrameSource {
 public:
  FrameSource(const SceneDesc& scene, const Motion& motion);

  /// One entry a frame id, all known, with the velocities of the motions that begin then.
  BoundaryInputs at(double time) const;
  /// Whether no frame moves: they are everywhere as at(0).
  bool rests() const;
  /// Those that a run begins with: a motion that does not go on for longer than a jump (5 ms) is one, and no velocity to begin
  /// with.
  BoundaryInputs at_start() const;

 private:
  /// `lead` [s]: how much later the velocities are of.
  BoundaryInputs at(double time, double lead) const;

  struct Frame {
    FrameTrack track;  ///< empty where it rests
    Pose resting;
  };
  struct Link {
    int frame = -1;   ///< what places it, index into frames_; -1: its parent does
    int parent = -1;  ///< index into links_
    Pose origin;      ///< in the parent
    int id = -1;      ///< of the frame that it places, -1 if it places none
  };

  int add_frame(const std::string& name, const FrameInput& resting, const Motion& motion);

  std::vector<Frame> frames_;  ///< by id, then those of links that nothing else uses
  int ids_ = 0;                ///< how many of them have ids
  std::vector<Link> links_;    ///< parents first
};

/// Names of the motion's frames that nothing in the scene uses.
std::vector<std::string> unused_frames(const SceneDesc& scene, const Motion& motion);

/// Names of the scene's frames that nothing gives a place: they stand at the origin.
std::vector<std::string> unplaced_frames(const SceneDesc& scene, const Motion& motion);

}  // namespace verlet_cable
