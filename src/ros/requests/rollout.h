#pragma once

#include <verlet_cable/RolloutGoal.h>
#include <verlet_cable/RolloutResult.h>

#include <functional>
#include <map>

#include "verlet_cable/core/world.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {

/// What a rollout starts from.
struct RolloutStart {
  World world;
  BoundaryInputs frames;
};

/// A run of a world's copy along given motions of frames.
class Rollout {
 public:
  /// Throws SceneError with everything that is wrong with the goal.
  Rollout(const RolloutGoal& goal, RolloutStart start);

  /// Runs to the end, or until `goes_on`, which is told the progress (0 to 1) now and then, says no. False if it was ended, or
  /// the simulation failed; `result` then has the states so far and says why.
  bool run(const std::function<bool(double)>& goes_on, RolloutResult& result);

 private:
  void record(double time, RolloutResult& result) const;

  World world_;
  BoundaryInputs frames_;
  std::map<int, FrameTrack> motion_;  ///< by frame id
  double duration_;                   ///< [s]
  double rate_;                       ///< [Hz]
};

}  // namespace verlet_cable
