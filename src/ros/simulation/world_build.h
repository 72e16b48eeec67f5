#pragma once

#include <atomic>
#include <future>
#include <memory>

#include "threads/background_tasks.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

struct BuiltWorld {
  World world;
  double time = 0;  ///< [s] that it took
};

/// Throws SceneError. `cancelled` as for World.
BuiltWorld build_world(const SceneDesc& scene, const BoundaryInputs& frames, const std::atomic<bool>* cancelled = nullptr);

/// A world that a thread of its own builds, from values. Whoever has no use for it any more drops it: its construction ends soon,
/// and is not waited for.
class WorldBuild {
 public:
  /// Begins. `tasks` outlives it.
  WorldBuild(const SceneDesc& scene, const BoundaryInputs& frames, BackgroundTasks& tasks);
  ~WorldBuild();
  WorldBuild(WorldBuild&&) = default;
  WorldBuild& operator=(WorldBuild&&) = delete;

  /// Whether it has ended, now or within `patience` [s].
  bool is_ready(double patience = 0) const;
  /// Waits for it; only once. Throws what the construction threw.
  BuiltWorld take() { return world_.get(); }

 private:
  BackgroundTasks* tasks_;
  std::shared_ptr<std::atomic<bool>> cancelled_;
  std::future<BuiltWorld> world_;
};

}  // namespace verlet_cable
