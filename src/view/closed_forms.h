#pragma once

#include <optional>

#include "packets/line_law.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable::view {

/// A line of sight: the points `origin` + t `direction`, where t [1] is what is searched for; `direction` has any length.
struct Ray {
  Vector3 origin;
  Vector3 direction;

  Vector3 at(double t) const { return origin + t * direction; }
};

/// t of the first meeting from `lowest` on with a cylinder around z through the origin, all in its frame; also from the inside.
/// `normal`: unit, out of it.
std::optional<double> meet_cylinder(double radius, double half_length, const Ray& ray, double lowest, Vector3& normal);

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
  LineNumbers numbers() const { return {axis_.x(), axis_.y(), axis_.z(), inverse_square_, radius_}; }

  /// t of the first meeting from `lowest` on, also from the inside.
  std::optional<double> first(const Ray& ray, double lowest) const;

 private:
  std::optional<double> first_of_all(const Ray& ray, double lowest) const;

  Vector3 start_, axis_;
  double inverse_square_;  ///< of the axis; 0 without length
  double radius_;
};

}  // namespace verlet_cable::view
