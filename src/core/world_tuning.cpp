#include "verlet_cable/core/world.h"
#include "world_implementation.h"

namespace verlet_cable {

void World::tune(const SceneDesc& scene) {
  Implementation& w = *implementation_;
  w.scene.gravity = scene.gravity;
  w.scene.fluid = scene.fluid;
  w.scene.materials = scene.materials;
  if (w.scene.contact && scene.contact) w.scene.contact->friction = scene.contact->friction;
  for (int i = 0; i < static_cast<int>(w.cables.size()); ++i) {
    CableModel& model = w.cables[i].model;
    model.material = *scene.find_material(model.material_name);
    // A clamp holds the direction where the cable is stiff, the neighbouring node where it is not.
    w.update_holders(i);
  }
}

}  // namespace verlet_cable
