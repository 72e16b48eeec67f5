#pragma once

#include "verlet_cable/core/world.h"

namespace verlet_cable::fuzz {

/// Ends the process where a number of a world is not finite, or arrays that belong together differ in size.
void check_world(const World& world);

/// Likewise where a number of its step's result is not finite, or an index is that of nothing.
void check_result(const World& world, const StepResult& result);

/// [kg] of all cables, nets and bodies.
double mass(const World& world);

}  // namespace verlet_cable::fuzz
