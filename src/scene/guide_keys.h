#pragma once

#include "keys.h"

namespace verlet_cable {

/// Appends `guides`.
void append_guide_keys(Keys<SceneDesc>& keys);

}  // namespace verlet_cable
