#pragma once

#include <string>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// Throws SceneError where scenes differ in more than numbers: in names, types and numbers of things, or the time step; see
/// structure_of. `name`: what messages call `other`.
void check_alike(const SceneDesc& first, const SceneDesc& other, const std::string& name);

}  // namespace verlet_cable
