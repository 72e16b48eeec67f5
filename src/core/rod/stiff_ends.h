#pragma once

#include <array>

#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Sets how much of the cable around each node bends: not what lies in the stiff lengths [m] at the start and the end.
void set_stiff_ends(const std::array<double, 2>& lengths, CableState& state);

}  // namespace verlet_cable
