#include "geometry/segment_geometry.h"

#include <algorithm>

namespace verlet_cable {

namespace {

/// Draws the points to the middles: relative to the square of a segment's length. Moves them by less than a hundredth of it
/// where segments cross.
constexpr double centring = 0.02;

}  // namespace

ClosestPoints closest_points(const Vector3& a, const Vector3& along_a, const Vector3& b, const Vector3& along_b) {
  const Vector3 between = a - b;
  const double aa = along_a.squaredNorm(), bb = along_b.squaredNorm(), ab = along_a.dot(along_b);
  const double pull_a = centring * aa, pull_b = centring * bb;
  // Minimum of |between + s along_a - t along_b|² + pull_a (s - 1/2)² + pull_b (t - 1/2)² in the unit square
  const double m_aa = aa + pull_a, m_bb = bb + pull_b;
  const double r_a = 0.5 * pull_a - along_a.dot(between), r_b = 0.5 * pull_b + along_b.dot(between);
  ClosestPoints points;
  const auto best_first = [&](double t) { return std::clamp((r_a + ab * t) / m_aa, 0.0, 1.0); };
  const auto best_second = [&](double s) { return std::clamp((r_b + ab * s) / m_bb, 0.0, 1.0); };
  points.first = std::clamp((r_a * m_bb + ab * r_b) / (m_aa * m_bb - ab * ab), 0.0, 1.0);
  points.second = best_second(points.first);
  points.first = best_first(points.second);
  points.second = best_second(points.first);
  points.between = between + points.first * along_a - points.second * along_b;
  return points;
}

}  // namespace verlet_cable
