#pragma once

#include <cstdint>
#include <memory>
#include <optional>
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
  /// As it was before all tuning.
  const SceneDesc& scene_at_first() const { return *scene_at_first_; }

  /// Id of a frame that can be given a pose. Throws UnknownName.
  int find_frame(const std::string& name) const;
  /// Names of those.
  std::vector<std::string> frame_names() const;
  /// Where a frame of any kind is; none where nothing has that name.
  std::optional<Pose> frame_pose(const std::string& name) const;
  /// A new frame, there until it is given another pose. Throws std::invalid_argument.
  void add_frame(const std::string& name, const Pose& pose);
  /// Follows the frames that the world has had from an id on, and that its scene does not know: a robot's link follows its
  /// parent, others rest where they are.
  void follow_frames_from(std::size_t first);
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
  std::shared_ptr<const FrameSource> frames_with(const std::string& name, std::size_t id, const Pose& resting) const;
  /// Of the frames that were given poses, now.
  PosesById given_now() const;

  struct GivenPoses {
    int frame = 0;
    std::vector<Pose> poses;
    std::size_t next = 0;
  };

  std::shared_ptr<const SceneDesc> scene_, scene_at_first_;
  std::shared_ptr<const FrameSource> frames_;
  BoundaryInputs inputs_;   ///< of the last step, at first those of the start
  BoundaryInputs targets_;  ///< where the motion has the frames
  World world_;
  std::uint64_t hash_of_start_;
  std::vector<GivenPoses> given_;
};

}  // namespace verlet_cable
