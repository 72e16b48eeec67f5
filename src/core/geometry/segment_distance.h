#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The points of two segments that are closest to each other.
struct ClosestPoints {
  double first = 0, second = 0;  ///< fractions along the segments, 0 to 1
  Vector3 between;               ///< [m] from the second point to the first
};

/// Of the segments that start at `a` and `b` and go along `along_a` and `along_b` [m]. Where nearly parallel segments have many
/// such points, those near their middles are taken, so that the points do not jump. (Ericson, Real-Time Collision Detection,
/// 2005, 5.1.9)
ClosestPoints closest_points(const Vector3& a, const Vector3& along_a, const Vector3& b, const Vector3& along_b);

}  // namespace verlet_cable
