#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/frame_source.h"
#include "scene/world_file.h"
#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/loads.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {

/// A world, what moves its frames, and what acts on it, as cable_sim has them: a motion; poses that are given in between, which
/// go before it from then on; and loads. A value, as the world is.
class DrivenWorld {
 public:
  /// Throws SceneError.
  DrivenWorld(std::shared_ptr<const SceneDesc> scene, const Motion& motion, LoadPlayer loads = {});

  /// As `save` has written it. Throws std::invalid_argument with what is wrong with the bytes.
  static DrivenWorld load(const SceneDesc& scene, const std::string& data);
  /// The world, and what moves its frames.
  std::string save() const;

  const World& world() const { return world_; }
  World& world() { return world_; }
  const SceneDesc& scene() const { return *scene_; }
  /// As it was before all tuning.
  const SceneDesc& scene_at_first() const { return *scene_at_first_; }

  /// Id of a frame that can be given a pose. Throws UnknownName.
  int find_frame(const std::string& name) const;
  /// Likewise; -1 where there is none of that name.
  int index_of_frame(const std::string& name) const;
  /// Names of those.
  std::vector<std::string> frame_names() const;
  /// Where a frame of any kind is; none where nothing has that name.
  std::optional<Pose> frame_pose(const std::string& name) const;
  /// A new frame, there until it is given another pose. Throws std::invalid_argument.
  void add_frame(const std::string& name, const Pose& pose);
  /// Follows the frames that the world has had from an id on, and that its scene does not know: a robot's link follows its
  /// parent, others rest where they are.
  void follow_frames_from(std::size_t first);
  /// Where a frame is at the end of each of the next steps, at least one; it stays at the last one. A frame that nothing has
  /// placed yet is at the first of them from the start on: once all are placed, a world that is as it began begins anew with
  /// them. Throws SceneError if it cannot begin so; then nothing is changed. Returns whether it did.
  bool set_frame(int frame, const Pose* poses, std::size_t count);
  bool has_unplaced_frames() const { return !unplaced_.empty(); }
  /// Throws std::invalid_argument if nothing has placed a frame that an attachment or guide needs. `where`: before the message.
  void require_placed_frames(const std::string& where = "") const;

  /// Whether nothing was done to it: no step, no settling, no edit.
  bool is_as_it_began() const { return world_.hash() == hash_of_start_; }
  /// Begins at t = 0 with another scene, which differs in materials only; motion and given poses stay. Throws SceneError.
  void begin_anew(std::shared_ptr<const SceneDesc> scene);
  /// See World::tune.
  void tune(std::shared_ptr<const SceneDesc> scene);

  /// The frames at the end of the next step, of which there is one for each call; loads that begin with it are applied. Valid
  /// until the next call.
  const BoundaryInputs& next_inputs();
  StepResult step() { return world_.step(next_inputs()); }
  /// Ids of the frames that moved faster than the scene's `max_frame_speed` to the last of these.
  const std::vector<int>& held_back() const { return held_back_; }
  /// Loads whose time came with it, and that cannot be applied.
  const std::vector<RefusedLoad>& refused_loads() const { return refused_loads_; }

 private:
  DrivenWorld(std::shared_ptr<const SceneDesc> scene, std::shared_ptr<const FrameSource> frames, LoadPlayer loads);
  explicit DrivenWorld(WorldFile file);
  void read_frames(const std::string& frames);
  void let_frames_rest();
  bool place(std::ptrdiff_t unplaced, int frame, const Pose& pose);

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
  BoundaryInputs inputs_;         ///< of the last step, at first those of the start
  BoundaryInputs targets_;        ///< where the motion has the frames
  LoadPlayer all_loads_, loads_;  ///< from the start on, and those that are still to come
  World world_;
  std::uint64_t hash_of_start_;
  std::vector<std::string> unplaced_;  ///< frames that hold something, at the origin until they are given a pose
  std::vector<int> held_back_;
  std::vector<RefusedLoad> refused_loads_;
  std::vector<GivenPoses> given_;
};

}  // namespace verlet_cable
