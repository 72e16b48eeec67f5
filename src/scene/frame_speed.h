#pragma once

#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Holds back frames that would move further than `distance` [m] from `before` to `frames` (one entry a frame id each): they go
/// that far on the straight way, and turn by the same fraction. Returns the ids of those held back, ascending.
std::vector<int> limit_frame_motion(const BoundaryInputs& before, double distance, BoundaryInputs& frames);

/// Slows down the velocities of frames that are above `speed` [m/s], and their turning by the same fraction.
void limit_frame_velocities(double speed, BoundaryInputs& frames);

}  // namespace verlet_cable
