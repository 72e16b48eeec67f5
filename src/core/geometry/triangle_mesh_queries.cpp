#include <array>
#include <cmath>

#include "geometry/triangle_geometry.h"
#include "geometry/winding_number.h"
#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable {

namespace {

/// Nodes of a tree that are still to be looked at: one a level, and one more. Trees of 2^31 triangles have 31 levels.
struct Pending {
  int node;
  double squared_distance;
};
using Stack = std::array<Pending, 64>;

/// Closer than this to the surface [of the coordinates], the direction to it is rounding.
constexpr double rounding_of_surface = 1e-12;

}  // namespace

struct TriangleMesh::Nearest {
  TrianglePoint at;
  int triangle = 0;
};

struct TriangleMesh::NearestOfSegment {
  SegmentTriangle at;
  int triangle = 0;
};

const Vector3& TriangleMesh::normal(int triangle, int feature) const {
  if (feature == whole_face) return face_normals_[triangle];
  return feature >= first_edge ? edge_normals_[3 * triangle + feature - first_edge]
                               : vertex_normals_[triangles_[triangle][feature]];
}

SurfacePoint TriangleMesh::surface_point(const Vector3& point, const Vector3& on_surface, int triangle, int feature) const {
  const Vector3 arm = point - on_surface;
  const Vector3& pseudonormal = normal(triangle, feature);
  const double length = arm.norm();
  const bool inside = winding_ ? winding_number(point) > 0.5 : pseudonormal.dot(arm) < 0;
  const double sign = inside ? -1 : 1;
  // What is open may be touched from the side that a triangle faces away from, and not be inside.
  if ((feature != whole_face || winding_) && length > rounding_of_surface * on_surface.cwiseAbs().maxCoeff())
    return {sign * length, on_surface, sign / length * arm};
  return {sign * length, on_surface, pseudonormal};
}

SurfacePoint TriangleMesh::sheet_point(const Vector3& point, const Vector3& on_surface, const Vector3& otherwise) const {
  const Vector3 arm = point - on_surface;
  const double length = arm.norm();
  if (length > rounding_of_surface * on_surface.cwiseAbs().maxCoeff()) return {length, on_surface, arm / length};
  return {length, on_surface, otherwise};
}

SurfacePoint TriangleMesh::closest_point(const Vector3& point, double reach) const {
  const double to_bounds = std::sqrt(bounds().squaredExteriorDistance(point));
  if (to_bounds > 0 && to_bounds >= reach) return {to_bounds, point, Vector3::UnitZ()};
  const Nearest found = nearest(point);
  return surface_point(point, found.at.point, found.triangle, found.at.feature);
}

SurfacePoint TriangleMesh::closest_point_of_sheet(const Vector3& point, double reach) const {
  const double to_bounds = std::sqrt(bounds().squaredExteriorDistance(point));
  if (to_bounds > 0 && to_bounds >= reach) return {to_bounds, point, Vector3::UnitZ()};
  const Nearest found = nearest(point);
  return sheet_point(point, found.at.point, face_normals_[found.triangle]);
}

TriangleMesh::Nearest TriangleMesh::nearest(const Vector3& point) const {
  Stack stack;
  int pending = 0;
  stack[pending++] = {0, 0};
  double squared_distance = infinity;
  Nearest found;
  while (pending > 0) {
    const Pending next = stack[--pending];
    if (next.squared_distance >= squared_distance) continue;
    const Node& node = nodes_[next.node];
    for (int t = node.first; t < node.first + node.count; ++t) {
      const TrianglePoint candidate = closest_point_of_triangle(corners(t), point);
      const double squared = (point - candidate.point).squaredNorm();
      if (squared >= squared_distance) continue;
      squared_distance = squared;
      found = {candidate, t};
    }
    if (node.count > 0) continue;
    Pending near{next.node + 1, nodes_[next.node + 1].box.squaredExteriorDistance(point)};
    Pending far{node.first, nodes_[node.first].box.squaredExteriorDistance(point)};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    stack[pending++] = far;
    stack[pending++] = near;
  }
  return found;
}

SegmentSurfacePoint TriangleMesh::deepest_point(const Vector3& start, const Vector3& end, double reach) const {
  const double to_bounds = bounds().exteriorDistance(Aabb(start.cwiseMin(end), start.cwiseMax(end)));
  if (to_bounds > 0 && to_bounds >= reach) return {0, {to_bounds, start, Vector3::UnitZ()}};
  const auto [closest, triangle] = nearest(start, end);
  if (!(closest.squared_distance > 0)) return deepest_inside(start, end);
  const Vector3 point = start + closest.fraction * (end - start);
  const SurfacePoint surface = surface_point(point, closest.nearest.point, triangle, closest.nearest.feature);
  return surface.distance < 0 ? deepest_inside(start, end) : SegmentSurfacePoint{closest.fraction, surface};
}

SegmentSurfacePoint TriangleMesh::closest_point_of_sheet(const Vector3& start, const Vector3& end, double reach) const {
  const double to_bounds = bounds().exteriorDistance(Aabb(start.cwiseMin(end), start.cwiseMax(end)));
  if (to_bounds > 0 && to_bounds >= reach) return {0, {to_bounds, start, Vector3::UnitZ()}};
  const auto [closest, triangle] = nearest(start, end);
  const Vector3 point = start + closest.fraction * (end - start);
  const Vector3 longer = closest.fraction < 0.5 ? end - point : start - point;
  const Vector3& face = face_normals_[triangle];
  return {closest.fraction, sheet_point(point, closest.nearest.point, face.dot(longer) < 0 ? Vector3(-face) : face)};
}

TriangleMesh::NearestOfSegment TriangleMesh::nearest(const Vector3& start, const Vector3& end) const {
  const Aabb box(start.cwiseMin(end), start.cwiseMax(end));
  Stack stack;
  int pending = 0;
  stack[pending++] = {0, 0};
  SegmentTriangle closest;
  int closest_triangle = 0;
  while (pending > 0) {
    const Pending next = stack[--pending];
    if (next.squared_distance >= closest.squared_distance) continue;
    const Node& node = nodes_[next.node];
    for (int t = node.first; t < node.first + node.count; ++t) {
      const SegmentTriangle candidate = closest_points(start, end, corners(t));
      if (candidate.squared_distance >= closest.squared_distance) continue;
      closest = candidate;
      closest_triangle = t;
    }
    if (node.count > 0) continue;
    Pending near{next.node + 1, nodes_[next.node + 1].box.squaredExteriorDistance(box)};
    Pending far{node.first, nodes_[node.first].box.squaredExteriorDistance(box)};
    if (far.squared_distance < near.squared_distance) std::swap(near, far);
    stack[pending++] = far;
    stack[pending++] = near;
  }
  return {closest, closest_triangle};
}

/// Branch and bound: along a segment the distance changes by no more than the way, which bounds it between two points.
SegmentSurfacePoint TriangleMesh::deepest_inside(const Vector3& start, const Vector3& end) const {
  constexpr int levels = 10;  // a thousandth of the segment
  struct Interval {
    SegmentSurfacePoint low, high;
    int level;
  };
  const double length = (end - start).norm();
  const auto probe = [&](double fraction) {
    return SegmentSurfacePoint{fraction, closest_point(start + fraction * (end - start))};
  };
  const SegmentSurfacePoint at_start = probe(0), at_end = probe(1);
  SegmentSurfacePoint deepest = at_start.surface.distance < at_end.surface.distance ? at_start : at_end;
  std::array<Interval, levels + 1> stack;
  int pending = 0;
  stack[pending++] = {at_start, at_end, 0};
  while (pending > 0) {
    const Interval interval = stack[--pending];
    const double width = interval.high.fraction - interval.low.fraction;
    const double bound = 0.5 * (interval.low.surface.distance + interval.high.surface.distance - width * length);
    if (interval.level == levels || bound >= deepest.surface.distance) continue;
    const SegmentSurfacePoint middle = probe(interval.low.fraction + 0.5 * width);
    if (middle.surface.distance < deepest.surface.distance) deepest = middle;
    stack[pending++] = {interval.low, middle, interval.level + 1};
    stack[pending++] = {middle, interval.high, interval.level + 1};
  }
  return deepest;
}

}  // namespace verlet_cable
