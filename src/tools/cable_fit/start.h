#pragma once

#include <vector>

#include "prediction.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable::cable_fit {

/// A scene is an error where the start is 5 % longer or shorter than the cable; rounding stays inside.
constexpr double start_tolerance = 0.0499;

/// [m] where the markers on a cable are.
std::vector<Vector3> marker_positions(const SimulatedCable& cable, const Markers& markers);

/// The place at a fraction of a number of evenly spaced segments.
struct SegmentPlace {
  int segment;
  double fraction;  ///< along it
};
SegmentPlace place_on(int segments, double place);

/// Starts along a smooth curve through points [m], at their velocities [m/s].
void start_smoothly(const std::vector<Vector3>& points, const std::vector<Vector3>& velocities, InitialShapeDesc& initial);

/// Brings a cable's length within what a scene allows of its `initial`, which is given by points.
void allow_length(CableDesc& cable);

/// Sets `initial` of the scene's cable by the first two rows of a recording: along the markers; those with offsets tell the
/// centre line beside them, by the material's orientation in a cable that starts along them. Brings the length within what a
/// scene allows of such a start. `inputs`: of the scene's frames at the start; `smooth`: between markers without offsets, too.
void start_along(const Markers& markers, const Recording& recording, const BoundaryInputs& inputs, bool smooth, SceneDesc& scene);

}  // namespace verlet_cable::cable_fit
