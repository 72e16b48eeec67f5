#pragma once

#include "keys.h"

namespace verlet_cable {

/// Appends `junctions`.
void append_junction_keys(Keys<SceneDesc>& keys);

}  // namespace verlet_cable
