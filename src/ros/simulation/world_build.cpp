#include "simulation/world_build.h"

#include <chrono>
#include <utility>

namespace verlet_cable {

BuiltWorld build_world(const SceneDesc& scene, const BoundaryInputs& frames, const std::atomic<bool>* cancelled) {
  const auto begin = std::chrono::steady_clock::now();
  World world(scene, frames, cancelled);
  return {std::move(world), std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count()};
}

WorldBuild::WorldBuild(const SceneDesc& scene, const BoundaryInputs& frames, BackgroundTasks& tasks)
    : tasks_(&tasks), cancelled_(std::make_shared<std::atomic<bool>>(false)) {
  const auto promise = std::make_shared<std::promise<BuiltWorld>>();
  world_ = promise->get_future();
  tasks.run([promise, scene = scene, frames = frames, cancelled = cancelled_] {
    try {
      promise->set_value(build_world(scene, frames, cancelled.get()));
    } catch (...) {
      promise->set_exception(std::current_exception());
    }
  });
}

WorldBuild::~WorldBuild() {
  if (cancelled_) *cancelled_ = true;
  if (world_.valid() && is_ready()) tasks_->dispose(std::move(world_));
}

bool WorldBuild::is_ready(double patience) const {
  return world_.wait_for(std::chrono::duration<double>(patience)) == std::future_status::ready;
}

}  // namespace verlet_cable
