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

/// The points within `radius` [m] of the line from `start` to `end`, which may be the same, prepared for many rays.
class RoundLine {
 public:
  RoundLine(const Vector3& start, const Vector3& end, double radius);

  const Vector3& start() const { return start_; }
  /// From start to end.
  const Vector3& axis() const { return axis_; }
  double radius() const { return radius_; }
  /// Where `point` is along the axis: 0 at the start, 1 at the end.
  double part(const Vector3& point) const { return (point - start_).dot(axis_) * inverse_square_; }

  /// t of the first meeting from `lowest` on, also from the inside.
  std::optional<double> first(const Ray& ray, double lowest) const {
    // Most rays that are tried are too far away from the axis.
    const Vector3 across = ray.direction.cross(axis_);
    const double apart = across.dot(ray.origin - start_);
    if (apart * apart > radius_ * radius_ * across.squaredNorm()) return {};
    return first_of_near(ray, lowest);
  }
  std::optional<Meeting> meet(const Ray& ray, double lowest) const;

 private:
  std::optional<double> first_of_near(const Ray& ray, double lowest) const;
  std::optional<double> first_of_all(const Ray& ray, double lowest) const;

  Vector3 start_, axis_;
  double inverse_square_;  ///< of the axis; 0 without length
  double radius_;
};

/// With the plane through a triangle; its normal looks towards the ray's origin.
std::optional<Meeting> meet_plane_of(const Vector3& a, const Vector3& b, const Vector3& c, const Ray& ray);

}  // namespace verlet_cable::view
