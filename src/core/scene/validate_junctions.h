#pragma once

#include "scene/scene_errors.h"
#include "scene/validate_holders.h"

namespace verlet_cable {

/// The part of `validate` that is about junctions.
void check_junctions(const SceneDesc& scene, const SceneNames& scene_names, Errors& errors);

}  // namespace verlet_cable
