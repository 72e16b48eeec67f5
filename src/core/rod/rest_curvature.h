#pragma once

#include <vector>

#include "target/kinematic_targets.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Sets the cable's unloaded curvature; where it is taken from the initial shape, from the present one, `clamps` holding its
/// ends.
void set_rest_curvature(const RestCurvatureDesc& desc, const std::vector<DirectionTarget>& clamps, CableState& state);

}  // namespace verlet_cable
