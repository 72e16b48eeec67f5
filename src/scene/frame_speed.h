#pragma once

#include <vector>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Holds back a frame that would move further than `distance` [m]: it goes that far on the straight way, and turns by the same
/// fraction. Whether it was held back.
bool limit_motion(const Pose& from, double distance, Pose& to);

/// The same of all frames that would move further than `distance` [m] from `before` to `frames` (one entry a frame id each).
/// Returns the ids of those held back, ascending.
std::vector<int> limit_frame_motion(const BoundaryInputs& before, double distance, BoundaryInputs& frames);

/// Slows down the velocities of frames that are above `speed` [m/s], and their turning by the same fraction.
void limit_frame_velocities(double speed, BoundaryInputs& frames);

}  // namespace verlet_cable
