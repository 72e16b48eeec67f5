#pragma once

#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Lays a cable between two of its nodes around a circle that begins in the cable's direction at the first and ends where it
/// began. What follows goes along with the last node. Changes positions only.
void lay_loop(int first, int last, CableState& state);

}  // namespace verlet_cable
