#include <algorithm>
#include <utility>

#include "verlet_cable/ros/simulation.h"

namespace verlet_cable {

EditResult Simulation::load_scene(const SceneDesc& scene) {
  World world(scene, initial_frames(scene));
  use_scene(scene);
  grid_ = TimeGrid(scene.time_step, scene.publish_rate);
  pacer_.use(grid_, longest_backlog(scene));
  world_ = std::move(world);
  moves_.clear();
  frames_.follow_scene(scene, stamp_);
  place_added_obstacles();
  events_.set_frame_id(scene.frame_id);
  frame_watch_.watch(scene);
  snapshots_.clear();
  faulted_ = waits_for_frames_ = keeps_world_ = false;
  const std::string message = "the scene is replaced by one of " + std::to_string(scene.cables.size()) + " cables";
  if (started_) {
    start(grid_.step_at_or_after(stamp_));
    announce(CableEvent::RESET, {}, message);
  }
  return {true, message, {}};
}

void Simulation::tune(const SceneDesc& scene) {
  world_.tune(scene);
  use_scene(scene);
}

void Simulation::use_scene(const SceneDesc& scene) {
  scene_ = scene;
  ++scene_version_;
  publishers_.show(scene);
}

}  // namespace verlet_cable
