#include "geometry/triangle_geometry.h"

#include "geometry/segment_geometry.h"

namespace verlet_cable {

namespace {

void keep_nearer(const Vector3& point, double fraction, const TrianglePoint& candidate, SegmentTriangle& nearest) {
  const double squared = (point - candidate.point).squaredNorm();
  if (squared < nearest.squared_distance) nearest = {squared, fraction, candidate};
}

}  // namespace

// Ericson, Real-Time Collision Detection, 2005, section 5.1.5. Of a triangle without area an edge or a corner is found.
TrianglePoint closest_point_of_triangle(const Corners& corners, const Vector3& p) {
  const auto& [a, b, c] = corners;
  const Vector3 ab = b - a, ac = c - a;
  const Vector3 ap = p - a, bp = p - b, cp = p - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {a, 0};
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {b, 1};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return {a + d1 / (d1 - d3) * ab, first_edge};
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {c, 2};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return {a + d2 / (d2 - d6) * ac, first_edge + 2};
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 >= d3 && d5 >= d6) return {b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b), first_edge + 1};
  const double sum = va + vb + vc;
  return {a + vb / sum * ab + vc / sum * ac, whole_face};
}

SegmentTriangle closest_points(const Vector3& start, const Vector3& end, const Corners& corners) {
  SegmentTriangle nearest;
  keep_nearer(start, 0, closest_point_of_triangle(corners, start), nearest);
  keep_nearer(end, 1, closest_point_of_triangle(corners, end), nearest);
  for (int i = 0; i < 3; ++i) {
    const Vector3 &first = corners[i], &second = corners[(i + 1) % 3];
    const SegmentFractions f = closest_fractions(start, end, first, second);
    const int feature = f.second <= 0 ? i : f.second >= 1 ? (i + 1) % 3 : first_edge + i;
    keep_nearer(start + f.first * (end - start), f.first, {first + f.second * (second - first), feature}, nearest);
  }
  const Vector3 normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
  const double above_start = normal.dot(start - corners[0]), above_end = normal.dot(end - corners[0]);
  if ((above_start > 0) == (above_end > 0)) return nearest;
  const double fraction = above_start / (above_start - above_end);
  const Vector3 crossing = start + fraction * (end - start);
  for (int i = 0; i < 3; ++i)
    if (normal.dot((corners[(i + 1) % 3] - corners[i]).cross(crossing - corners[i])) < 0) return nearest;
  return {0, fraction, {crossing, whole_face}};
}

}  // namespace verlet_cable
