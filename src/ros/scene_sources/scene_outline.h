#pragma once

#include <string>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// What there is in a scene, in a line: how many of each kind, the fixed frame, the time step.
std::string scene_outline(const SceneDesc& scene);

}  // namespace verlet_cable
