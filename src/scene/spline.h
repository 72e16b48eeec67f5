#pragma once

#include <algorithm>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The cubic Hermite spline between two rows: the way from the first one at a part `u` (0 to 1) of the time between them, where
/// the whole way and the tangents at both rows, times that duration, are given. What stands does so exactly.
inline Vector3 spline_way(double u, const Vector3& way, const Vector3& start, const Vector3& end) {
  return u * u * (3 - 2 * u) * way + u * (1 - u) * ((1 - u) * start - u * end);
}

/// A tangent no longer than three times the slower one of the mean velocities on both sides of its row (the condition of Fritsch
/// and Carlson 1980, with which a cubic does not turn back), its direction kept.
inline Vector3 shortened(const Vector3& tangent, double slower) {
  const double length = tangent.stableNorm(), longest = 3 * slower;
  return length > longest ? Vector3(longest / length * tangent) : tangent;
}

}  // namespace verlet_cable
