#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "scene/frame_source.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// A world and what moves its frames, as cable_sim has it: a motion; and poses that are given in between, which go before it from
/// then on. A value, as the world is.
class DrivenWorld {
 public:
  /// `frames` is of that scene. Throws SceneError.
  DrivenWorld(std::shared_ptr<const SceneDesc> scene, std::shared_ptr<const FrameSource> frames);

  const World& world() const { return world_; }
  World& world() { return world_; }
  const SceneDesc& scene() const { return *scene_; }

  /// Id of a frame that can be given a pose. Throws UnknownName.
  int find_frame(const std::string& name) const;
  /// Where a frame is at the end of each of the next steps, at least one; it stays at the last one.
  void set_frame(int frame, std::vector<Pose> poses);

  /// Whether nothing was done to it: no step, no settling, no edit.
  bool is_as_it_began() const { return world_.hash() == hash_of_start_; }
  /// Begins at t = 0 with another scene, which differs in materials only; motion and given poses stay. Throws SceneError.
  void begin_anew(std::shared_ptr<const SceneDesc> scene);
  /// See World::tune.
  void tune(std::shared_ptr<const SceneDesc> scene);

  /// The frames at the end of the next step, of which there is one for each call. Valid until the next call.
  const BoundaryInputs& next_inputs();
  StepResult step() { return world_.step(next_inputs()); }

 private:
  struct GivenPoses {
    int frame = 0;
    std::vector<Pose> poses;
    std::size_t next = 0;
  };

  std::shared_ptr<const SceneDesc> scene_;
  std::shared_ptr<const FrameSource> frames_;
  BoundaryInputs inputs_;   ///< of the last step, at first those of the start
  BoundaryInputs targets_;  ///< where the motion has the frames
  World world_;
  std::uint64_t hash_of_start_;
  std::vector<GivenPoses> given_;
};

}  // namespace verlet_cable
