#pragma once

#include <optional>

#include "verlet_cable/core/shape.h"

namespace verlet_cable {

/// Cosine of the largest angle between normals that are the same but for rounding.
constexpr double same_normal = 1 - 1e-11;

/// The part of a segment that lies over a flat face of a solid: what is nearest to it is inside of the face.
struct PartOverFace {
  SegmentSurfacePoint begin, end;  ///< where it begins and ends, ascending; their surface points are the face's
};

/// The part over the face that the deepest point of a segment from `start` to `end` [m], in the shape's frame, belongs to, or
/// that ends beside it. None where surfaces are round, and where there is no face within `near` [m] along the segment. Below 0
/// distances of its ends need not be those of the solid.
std::optional<PartOverFace> part_over_face(const Shape& shape, const Vector3& start, const Vector3& end,
                                           const SegmentSurfacePoint& deepest, double near);

}  // namespace verlet_cable
