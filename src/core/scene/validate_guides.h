#pragma once

#include "scene/scene_errors.h"
#include "scene/validate_holders.h"

namespace verlet_cable {

/// The part of `validate` that is about guides. `names`: those of cables, nets, particles, bodies and guides.
void check_guides(const SceneDesc& scene, const SceneNames& scene_names, UniqueNames& names, Errors& errors);

/// Lines likewise for guides of a sound scene that worlds cannot have yet.
std::vector<std::string> not_simulated_guides(const SceneDesc& scene);

}  // namespace verlet_cable
