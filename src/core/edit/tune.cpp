#include <memory>

#include "rod/rod_frames.h"
#include "verlet_cable/core/world.h"
#include "world/implementation.h"

namespace verlet_cable {

void World::tune(const SceneDesc& scene) {
  State& state = implementation_->state;
  auto tuned = std::make_shared<SceneDesc>(*state.scene);
  tuned->gravity = scene.gravity;
  tuned->fluid = scene.fluid;
  tuned->materials = scene.materials;
  if (tuned->contact && scene.contact) tuned->contact->friction = scene.contact->friction;
  state.scene = std::move(tuned);
  for (int i = 0; i < static_cast<int>(state.cables.size()); ++i) {
    CableModel& model = state.cables[i].model;
    model.material = *scene.find_material(model.material_name);
    std::vector<DirectionTarget>& clamps = state.cable_progress[i].targets.directions;
    if (model.is_whole_rod())
      give_frames(state.cables[i], clamps);
    else
      drop_frames(state.cables[i], clamps);
    // A clamp holds the direction where the cable is stiff, the neighbouring node where it is not.
    implementation_->find_targets_of(i);
  }
  implementation_->islands.value.invalidate();  // their pairs are those of the radii before
}

}  // namespace verlet_cable
