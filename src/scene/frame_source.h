#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "verlet_cable/core/bytes.h"
#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {

/// Of frames, by their ids.
using PosesById = std::map<int, Pose>;

/// Where a scene's frames are over time: by the motion, else at their `initial_pose`; else a robot's link is where its parent has
/// it with the joint at zero; else at the origin.
class FrameSource {
 public:
  FrameSource(const SceneDesc& scene, const Motion& motion);
  /// As one that was written. Throws std::invalid_argument where the bytes are none of a source with at most so many
  /// frame ids.
  FrameSource(ByteReader& bytes, std::size_t most_ids);
  void write(ByteWriter& bytes) const;

  /// One entry a frame id, with the velocities of the motions that begin then; all known, but for ids that are not of these
  /// frames.
  BoundaryInputs at(double time) const;
  /// The same, with frames that are given a pose instead, and what robots' links there carry.
  BoundaryInputs at(double time, const PosesById& given) const;
  /// Whether no frame moves: they are everywhere as at(0).
  bool rests() const;
  /// Whether there is a robot: its links carry others.
  bool has_links() const { return !links_.empty(); }
  bool is_link(const std::string& name) const;
  /// Follows one more frame, of a world that names more than its scene does: a link of the robot, or one that rests at `resting`.
  void add(const std::string& name, int id, const Pose& resting);
  /// Where a frame is that nothing else has placed.
  void place(int id, const Pose& resting);

 private:
  struct Frame {
    int id = -1;       ///< -1: nothing but a link uses it
    FrameTrack track;  ///< empty where it rests; its jumps are found
    Pose resting;
  };
  struct Link {
    std::string name;
    int frame = -1;   ///< what places it, index into frames_; -1: its parent does
    int parent = -1;  ///< index into links_
    Pose origin;      ///< in the parent
    int id = -1;      ///< of its frame, -1 if nothing uses it
  };

  int add_frame(int id, const std::string& name, const FrameInput& resting, const Motion& motion);

  double jump_speed_ = infinity;  ///< [m/s]
  std::vector<Frame> frames_;
  int ids_ = 0;              ///< one more than the last of them
  std::vector<Link> links_;  ///< parents first
};

/// Names of the motion's frames that nothing in the scene uses.
std::vector<std::string> unused_frames(const SceneDesc& scene, const Motion& motion);

/// Names of the scene's frames that nothing gives a place: they stand at the origin.
std::vector<std::string> unplaced_frames(const SceneDesc& scene, const Motion& motion);
/// Those of them that an attachment or guide is in.
std::vector<std::string> unplaced_holders(const SceneDesc& scene, const Motion& motion);

}  // namespace verlet_cable
