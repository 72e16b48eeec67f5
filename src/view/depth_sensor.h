#pragma once

#include "verlet_cable/view/render.h"

namespace verlet_cable::view {

/// What a sensor makes of depths. All of these have one number a pixel, row by row.
struct TrueDepth {
  const float* depth;   ///< [m] also below `near`; NaN where nothing is seen
  const float* cosine;  ///< of the angle between line of sight and normal; below 0 where the second imager sees nothing
};

/// Whether it leaves all depths as they are.
bool is_perfect(const SensorModel& sensor);

/// Measures one row into `measured`, which has the row's pixels.
void measure_row(const CameraModel& model, const SensorModel& sensor, const NoiseSeed& noise, const TrueDepth& truth, int row,
                 float* measured);

}  // namespace verlet_cable::view
