#include "geometry/part_over_face.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable {

namespace {

/// Ends of a part over a face of a mesh are found at once where edges are straight; at corners each trial comes nearer.
constexpr int most_trials = 8;

struct Interval {
  double begin = 0, end = 1;
};

PartOverFace on_plane(const Interval& part, const Vector3& start, const Vector3& end, int axis, double side, double height) {
  const auto at = [&](double fraction) {
    SegmentSurfacePoint found;
    found.fraction = fraction;
    found.surface.point = start + fraction * (end - start);
    found.surface.distance = side * found.surface.point[axis] - height;
    found.surface.point[axis] = side * height;
    found.surface.normal = side * Vector3::Unit(axis);
    return found;
  };
  return {at(part.begin), at(part.end)};
}

/// The face that the normal points out of most.
std::optional<PartOverFace> part_over(const BoxShape& box, const Vector3& start, const Vector3& end,
                                      const SegmentSurfacePoint& deepest, double) {
  int axis;
  deepest.surface.normal.cwiseAbs().maxCoeff(&axis);
  Interval part;
  for (int i = 0; i < 3; ++i) {
    if (i == axis) continue;
    const double half = 0.5 * box.size[i], way = end[i] - start[i];
    if (way == 0) {
      if (std::abs(start[i]) > half) return {};
      continue;
    }
    const double low = (-half - start[i]) / way, high = (half - start[i]) / way;
    part.begin = std::max(part.begin, std::min(low, high));
    part.end = std::min(part.end, std::max(low, high));
  }
  if (!(part.begin < part.end)) return {};
  return on_plane(part, start, end, axis, std::copysign(1.0, deepest.surface.normal[axis]), 0.5 * box.size[axis]);
}

/// A flat end.
std::optional<PartOverFace> part_over(const CylinderShape& cylinder, const Vector3& start, const Vector3& end,
                                      const SegmentSurfacePoint& deepest, double) {
  const Vector3& normal = deepest.surface.normal;
  if (std::abs(normal.z()) < normal.head<2>().norm()) return {};
  const Eigen::Vector2d from = start.head<2>(), way = (end - start).head<2>();
  const double square = way.squaredNorm(), beyond = from.squaredNorm() - cylinder.radius * cylinder.radius;
  Interval part;
  if (square > 0) {
    const double middle = -from.dot(way) / square, root = middle * middle - beyond / square;
    if (!(root > 0)) return {};
    part = {std::max(0.0, middle - std::sqrt(root)), std::min(1.0, middle + std::sqrt(root))};
  } else if (beyond > 0) {
    return {};
  }
  if (!(part.begin < part.end)) return {};
  return on_plane(part, start, end, 2, std::copysign(1.0, normal.z()), 0.5 * cylinder.length);
}

/// Beside the deepest point, which is on a face's edge where the segment is not parallel to it.
std::optional<PartOverFace> part_over(const MeshShape& mesh, const Vector3& start, const Vector3& end,
                                      const SegmentSurfacePoint& deepest, double near) {
  const Vector3 way = end - start;
  const double length = way.norm(), step = near / length;
  if (!(length > 0)) return {};
  const auto at = [&](double fraction) {
    const Vector3 place = start + fraction * way;
    return SegmentSurfacePoint{fraction,
                               mesh.is_sheet() ? mesh.mesh->closest_point_of_sheet(place) : mesh.mesh->closest_point(place)};
  };
  const auto same = [](const SegmentSurfacePoint& a, const SegmentSurfacePoint& b) {
    return a.surface.normal.dot(b.surface.normal) > same_normal;
  };
  const SegmentSurfacePoint before = at(std::max(0.0, deepest.fraction - step)),
                            behind = at(std::min(1.0, deepest.fraction + step));
  const SegmentSurfacePoint& on_face = before.surface.distance < behind.surface.distance ? before : behind;
  if (!same(on_face, at(0.5 * (on_face.fraction + deepest.fraction)))) return {};
  const Vector3& normal = on_face.surface.normal;
  const double raised = mesh.is_sheet() ? 0.5 * mesh.thickness : 0;
  // From outside: feet are on the edge where the face ends, which is straight, until the segment is over it.
  const auto edge = [&](double from) {
    SegmentSurfacePoint place = at(from);
    for (int i = 0; i < most_trials && !same(place, on_face); ++i) {
      const Vector3 arm = start + place.fraction * way - place.surface.point, outwards = arm - normal.dot(arm) * normal;
      const double climb = way.dot(outwards);
      if (climb == 0) break;
      const double fraction = place.fraction - arm.dot(outwards) / climb;
      if (!(std::abs(fraction - on_face.fraction) < std::abs(place.fraction - on_face.fraction))) break;
      place = at(fraction);
    }
    place.surface.distance -= raised;
    return place;
  };
  const PartOverFace part{edge(0), edge(1)};
  if (!same(part.begin, on_face) || !same(part.end, on_face)) return {};
  return part;
}

template <typename Round>
std::optional<PartOverFace> part_over(const Round&, const Vector3&, const Vector3&, const SegmentSurfacePoint&, double) {
  return {};
}

}  // namespace

std::optional<PartOverFace> part_over_face(const Shape& shape, const Vector3& start, const Vector3& end,
                                           const SegmentSurfacePoint& deepest, double near) {
  return std::visit([&](const auto& of_type) { return part_over(of_type, start, end, deepest, near); }, shape);
}

}  // namespace verlet_cable
