#pragma once

#include <optional>

#include "verlet_cable/core/shape.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable::view {

/// A line of sight: the points `origin` + t `direction`, where t [1] is what is searched for; `direction` has any length.
struct Ray {
  Vector3 origin;
  Vector3 direction;

  Vector3 at(double t) const { return origin + t * direction; }
};

/// Where a ray meets a surface.
struct Meeting {
  double t = 0;
  Vector3 normal = Vector3::UnitZ();  ///< unit, out of the solid
};

/// The first meeting with t from `lowest` on, all in the shape's frame. A plane is met from its outside only, other solids from
/// the inside, too. Not for meshes, which have none here.
std::optional<Meeting> meet(const Shape& shape, const Ray& ray, double lowest);

/// The same with the points within `radius` of the line from `start` to `end`.
std::optional<Meeting> meet_tube(const Vector3& start, const Vector3& end, double radius, const Ray& ray, double lowest);

/// With the plane through a triangle; its normal looks towards the ray's origin.
std::optional<Meeting> meet_plane_of(const Vector3& a, const Vector3& b, const Vector3& c, const Ray& ray);

}  // namespace verlet_cable::view
