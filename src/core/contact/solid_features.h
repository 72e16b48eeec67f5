#pragma once

#include <cstdint>
#include <vector>

#include "contact/moving_obstacle.h"
#include "verlet_cable/core/shape.h"

namespace verlet_cable {

/// Where a corner, edge, rim or axis of one solid comes close to the surface of another one.
struct FeatureContact {
  std::uint32_t feature = 0;          ///< which one it is, the same in every substep
  Vector3 point = Vector3::Zero();    ///< [m] on the first one's surface, in the second one's frame
  Vector3 foot = Vector3::Zero();     ///< [m] on the second one's
  Vector3 normal = Vector3::UnitZ();  ///< unit, out of the second one
  double distance = 0;                ///< [m] of the surfaces
};

/// [m] Edges and corners of bodies are rounded by so much: then they have a normal where they cross.
double rounding_of(const Shape& shape);

/// Which contacts are looked for.
struct FeatureSearch {
  double reach = 0;    ///< [m] of what is closer
  double padding = 0;  ///< [m] around the other solid
  PointMotion travel;  ///< [m], [rad] in the frame of the other: the way of the first that is looked ahead
};

/// Where a solid comes closer to another than a reach: at its corners, and at edges, rims, axes and curved sides where these
/// are nearest; of a mesh at its vertices. Flat ends of cylinders are polygons where they lie flat. `pose`: of the first in the
/// frame of the second; boxes and cylinders are rounded by as much as is given.
/// What will pass the other one without touching it has the normal, and the distance along that, of the place where it passes.
void find_feature_contacts(const Shape& solid, double rounding, const Pose& pose, const Shape& other, double other_rounding,
                           const FeatureSearch& search, std::vector<FeatureContact>& found);

}  // namespace verlet_cable
