#pragma once

#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable::fuzz {

/// The scenes in fuzz/worlds: all that a scene can have, with few segments. In the order of their file names.
std::vector<SceneDesc> small_worlds();

}  // namespace verlet_cable::fuzz
