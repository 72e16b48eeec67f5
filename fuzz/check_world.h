#pragma once

#include "verlet_cable/core/world.h"

namespace verlet_cable::fuzz {

/// Ends the process where a number of a world is not finite, or arrays that belong together differ in size.
void check_world(const World& world);

/// [kg] of all cables, nets and bodies.
double mass(const World& world);

}  // namespace verlet_cable::fuzz
