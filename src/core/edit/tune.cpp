#include <memory>
#include <utility>

#include "scene/validate_materials.h"
#include "verlet_cable/core/world.h"
#include "world/implementation.h"
#include "world/invariant.h"
#include "world/limits.h"

namespace verlet_cable {

void World::tune(const SceneDesc& scene) {
  State& state = implementation_->state;
  Errors errors;
  for (const SimulatedCable& cable : state.cables) check_torsional_stiffness(cable, scene, errors);
  if (std::vector<std::string> lines = errors.take(); !lines.empty()) throw SceneError(std::move(lines));
  const double energy = implementation_->energy().total();
  auto tuned = std::make_shared<SceneDesc>(*state.scene);
  tuned->gravity = scene.gravity;
  tuned->fluid = scene.fluid;
  tuned->materials = scene.materials;
  if (tuned->contact && scene.contact) tuned->contact->friction = scene.contact->friction;
  state.scene = std::move(tuned);
  state.waves = waves_of(*state.scene);
  for (int i = 0; i < static_cast<int>(state.cables.size()); ++i) {
    CableModel model = *state.cables[i].model;
    model.material = *scene.find_material(model.material_name);
    for (NamedMaterial& other : model.section_materials) other.material = *scene.find_material(other.name);
    state.cables[i].model = std::make_shared<const CableModel>(std::move(model));
    watch_limits(state.cables[i]);
    // A clamp holds the direction where the cable is stiff, the neighbouring node where it is not.
    implementation_->find_targets_of(i);
  }
  implementation_->islands.value.invalidate();  // their pairs are those of the radii before
  implementation_->account_for_edit_since(energy);
  assert_no_violation(state);
}

}  // namespace verlet_cable
