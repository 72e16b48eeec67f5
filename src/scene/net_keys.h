#pragma once

#include "keys.h"

namespace verlet_cable {

/// Appends `particles`, `nets` and `integrator`.
void append_net_keys(Keys<SceneDesc>& keys);

}  // namespace verlet_cable
