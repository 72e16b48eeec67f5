#pragma once

#include "keys.h"

namespace verlet_cable {

/// Appends `obstacles`, `robot` and `contact`. What they name in files is not read yet.
void append_obstacle_keys(Keys<SceneDesc>& keys);

}  // namespace verlet_cable
