#pragma once

#include <verlet_cable/RolloutGoal.h>
#include <verlet_cable/RolloutResult.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "edit_requests/checked_load.h"
#include "verlet_cable/core/world_stepper.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {

/// What a rollout starts from.
struct RolloutStart {
  World world;
  BoundaryInputs frames;
  double jump_speed = infinity;  ///< [m/s] of the scene
};

/// A load from outside, and when it starts [s].
struct TimedLoad {
  double start = 0;
  edit::ApplyLoad load;
};

/// A run of a world's copy along given motions of frames, with loads.
class Rollout {
 public:
  /// Throws SceneError with everything that is wrong with the goal.
  Rollout(const RolloutGoal& goal, RolloutStart start);

  /// Records the state it starts from.
  void begin();
  bool has_ended() const { return ended_; }
  double progress() const;  ///< 0 to 1
  /// Its next step, to be done together with those of others; then the step's result.
  WorldStep next_step();
  void take(const StepResult& done);
  void cancel();
  /// The states so far; at the end, how it ended.
  const RolloutResult& result() const { return result_; }

 private:
  double time() const { return static_cast<double>(steps_) * world_.time_step(); }
  void follow(double time);
  void apply_loads();
  void record();
  void end(bool success, const std::string& message);

  World world_;
  BoundaryInputs frames_;
  std::map<int, FrameTrack> motion_;  ///< by frame id
  std::vector<TimedLoad> loads_;      ///< in the order in which they start
  std::size_t next_load_ = 0;
  double duration_;         ///< [s]
  double rate_;             ///< [Hz]
  std::int64_t steps_ = 0;  ///< done
  std::int64_t all_steps_;
  bool ended_ = false;
  RolloutResult result_;
};

}  // namespace verlet_cable
