#pragma once

#include <Eigen/Geometry>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A box along the axes [m].
using Aabb = Eigen::AlignedBox3d;

/// The point of a surface that is nearest to another point.
struct SurfacePoint {
  double distance = 0;                ///< [m] of the other point; negative inside
  Vector3 point = Vector3::Zero();    ///< [m] on the surface
  Vector3 normal = Vector3::UnitZ();  ///< unit, out of the solid, in the direction of growing distance
};

/// The point of a segment at which the signed distance to a surface is smallest.
struct SegmentSurfacePoint {
  double fraction = 0;  ///< of the way from the segment's start to its end, 0 to 1
  SurfacePoint surface;
};

}  // namespace verlet_cable
