#pragma once

#include "world/implementation.h"

namespace verlet_cable {

/// Shows tests all of a world.
struct WorldInspector {
  static State& state(World& world) { return world.implementation_->state; }
  static const State& state(const World& world) { return world.implementation_->state; }
};

}  // namespace verlet_cable
