#pragma once

#include "keys.h"

namespace verlet_cable {

/// Appends `bodies` and `broadcast_tf`. Meshes of shapes are not read yet.
void append_body_keys(Keys<SceneDesc>& keys);

}  // namespace verlet_cable
