#pragma once

#include <vector>

#include "target/kinematic_targets.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Sets the unloaded curvature and twist. Curvature that is to be taken from the initial shape is there, but no number yet.
void set_rest_shape(const CableDesc& desc, const CableModel& model, CableState& state);

/// Sets the unloaded curvature to the present one, which frames measure, `clamps` holding the ends.
void take_rest_curvature(const std::vector<DirectionTarget>& clamps, CableState& state);

}  // namespace verlet_cable
