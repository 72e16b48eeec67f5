#pragma once

#include <algorithm>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The fraction of the way from `start` to `end` that is nearest to a point.
inline double closest_fraction(const Vector3& start, const Vector3& end, const Vector3& point) {
  const Vector3 along = end - start;
  const double squared = along.squaredNorm();
  return squared > 0 ? std::clamp(along.dot(point - start) / squared, 0.0, 1.0) : 0.0;
}

struct SegmentFractions {
  double first = 0, second = 0;  ///< 0 to 1
};

/// Where two segments are nearest to each other (Ericson, Real-Time Collision Detection, 2005, section 5.1.9). Of parallel ones,
/// any of the nearest points.
inline SegmentFractions closest_fractions(const Vector3& start1, const Vector3& end1, const Vector3& start2,
                                          const Vector3& end2) {
  const Vector3 d1 = end1 - start1, d2 = end2 - start2, r = start1 - start2;
  const double a = d1.squaredNorm(), e = d2.squaredNorm(), f = d2.dot(r);
  if (!(a > 0)) return {0, closest_fraction(start2, end2, start1)};
  if (!(e > 0)) return {closest_fraction(start1, end1, start2), 0};
  const double b = d1.dot(d2), c = d1.dot(r), denominator = a * e - b * b;
  const double s = denominator > 0 ? std::clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  const double t = (b * s + f) / e;
  if (t < 0) return {std::clamp(-c / a, 0.0, 1.0), 0};
  if (t > 1) return {std::clamp((b - c) / a, 0.0, 1.0), 1};
  return {s, t};
}

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
