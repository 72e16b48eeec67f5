#pragma once

#include <array>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

using Corners = std::array<Vector3, 3>;

/// Parts of a triangle: 0 to 2 its corners, 3 to 5 its edges from corner i - 3 to the next, 6 its face.
constexpr int first_edge = 3;
constexpr int whole_face = 6;

struct TrianglePoint {
  Vector3 point;
  int feature = whole_face;
};

/// The point of a triangle that is nearest to `p`, and the part of it that has that point.
TrianglePoint closest_point_of_triangle(const Corners& corners, const Vector3& p);

struct SegmentTriangle {
  double squared_distance = infinity;
  double fraction = 0;  ///< of the segment
  TrianglePoint nearest;
};

/// Where a segment and a triangle are nearest to each other; a distance of 0 where they cross.
SegmentTriangle closest_points(const Vector3& start, const Vector3& end, const Corners& corners);

}  // namespace verlet_cable
