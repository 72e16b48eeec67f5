#include "verlet_cable/core/shape.h"

#include <algorithm>
#include <cmath>

#include "geometry/segment_geometry.h"
#include "verlet_cable/core/shape_desc.h"

namespace verlet_cable {

namespace {

/// Shorter arms [m] have no direction.
constexpr double no_length = 1e-100;

SurfacePoint closest_point_of(const PlaneShape&, const Vector3& p, double) {
  return {p.z(), {p.x(), p.y(), 0}, Vector3::UnitZ()};
}

/// Of the surface at `radius` around `center`; `otherwise`: the normal of the centre itself.
SurfacePoint around(const Vector3& center, double radius, const Vector3& otherwise, const Vector3& p) {
  const Vector3 arm = p - center;
  const double length = arm.norm();
  const Vector3 normal = length > no_length ? Vector3(arm / length) : otherwise;
  return {length - radius, center + radius * normal, normal};
}

SurfacePoint closest_point_of(const SphereShape& sphere, const Vector3& p, double) {
  return around(Vector3::Zero(), sphere.radius, Vector3::UnitZ(), p);
}

SurfacePoint closest_point_of(const CapsuleShape& capsule, const Vector3& p, double) {
  const double half = 0.5 * capsule.length;
  return around({0, 0, std::clamp(p.z(), -half, half)}, capsule.radius, Vector3::UnitX(), p);
}

SurfacePoint closest_point_of(const CylinderShape& cylinder, const Vector3& p, double) {
  const double half = 0.5 * cylinder.length;
  const double from_axis = std::sqrt(p.x() * p.x() + p.y() * p.y());
  const Vector3 radial = from_axis > no_length ? Vector3(p.x() / from_axis, p.y() / from_axis, 0) : Vector3::UnitX();
  const Vector3 axial(0, 0, std::copysign(1.0, p.z()));
  const double beside = from_axis - cylinder.radius, beyond = std::abs(p.z()) - half;
  if (const double distance = std::sqrt(beside * beside + beyond * beyond); beside > 0 && beyond > 0 && distance > no_length)
    return {distance, cylinder.radius * radial + half * axial, (beside * radial + beyond * axial) / distance};
  if (beside > beyond) return {beside, cylinder.radius * radial + Vector3(0, 0, p.z()), radial};
  return {beyond, {p.x(), p.y(), half * axial.z()}, axial};
}

SurfacePoint closest_point_of(const BoxShape& box, const Vector3& p, double) {
  const Vector3 half = 0.5 * box.size;
  const Vector3 beyond = p.cwiseAbs() - half;
  int nearest_face;
  const double most = beyond.maxCoeff(&nearest_face);
  if (most > 0) {
    const Vector3 on_surface = p.cwiseMax(-half).cwiseMin(half);
    const Vector3 arm = p - on_surface;
    if (const double distance = arm.norm(); distance > no_length) return {distance, on_surface, arm / distance};
  }
  Vector3 on_surface = p, normal = Vector3::Zero();
  normal[nearest_face] = std::copysign(1.0, p[nearest_face]);
  on_surface[nearest_face] = normal[nearest_face] * half[nearest_face];
  return {most, on_surface, normal};
}

/// Of a surface that is further out.
SurfacePoint raised(SurfacePoint surface, double height) {
  surface.distance -= height;
  surface.point += height * surface.normal;
  return surface;
}

SurfacePoint closest_point_of(const MeshShape& mesh, const Vector3& p, double reach) {
  if (!mesh.is_sheet()) return mesh.mesh->closest_point(p, reach);
  const double half = 0.5 * mesh.thickness;
  return raised(mesh.mesh->closest_point_of_sheet(p, reach + half), half);
}

template <typename ShapeType>
SegmentSurfacePoint at_fraction(const ShapeType& shape, const Vector3& start, const Vector3& end, double fraction) {
  return {fraction, closest_point_of(shape, start + fraction * (end - start), infinity)};
}

/// The signed distance of a convex shape along a segment is convex: every slope bounds it from below on both sides.
struct Probe {
  SegmentSurfacePoint at;
  double slope = 0;  ///< [m] of the distance over the fraction

  double distance() const { return at.surface.distance; }
};

template <typename ShapeType>
Probe probe(const ShapeType& shape, const Vector3& start, const Vector3& end, double fraction) {
  Probe p{at_fraction(shape, start, end, fraction)};
  p.slope = p.at.surface.normal.dot(end - start);
  return p;
}

/// Where between two probes the next one should be. Outside of a box the square of the distance is piecewise quadratic, so that a
/// secant of its slope hits the minimum; inside the distance is piecewise linear, so that the lines through the probes meet
/// there.
double next_fraction(const Probe& low, const Probe& high, double lines_meet) {
  if (!(low.distance() > 0 && high.distance() > 0)) return lines_meet;
  const double slope_low = low.distance() * low.slope, slope_high = high.distance() * high.slope;
  return (low.at.fraction * slope_high - high.at.fraction * slope_low) / (slope_high - slope_low);
}

/// The minimum of a convex function by its slopes, which bound it from below: ends when the bound is met.
template <typename ShapeType>
SegmentSurfacePoint deepest_of_convex(const ShapeType& shape, const Vector3& start, const Vector3& end, double reach) {
  constexpr int most_probes = 64;
  constexpr double tolerance = 1e-14;  // of the distances that are compared: rounding
  Probe low = probe(shape, start, end, 0), high = probe(shape, start, end, 1);
  if (low.slope == 0 && high.slope == 0) return at_fraction(shape, start, end, 0.5);
  if (low.slope >= 0) return low.at;
  if (high.slope <= 0) return high.at;
  SegmentSurfacePoint best = low.distance() < high.distance() ? low.at : high.at;
  for (int i = 0; i < most_probes; ++i) {
    const double width = high.at.fraction - low.at.fraction;
    const double step = (low.distance() - high.distance() + high.slope * width) / (high.slope - low.slope);
    const double bound = low.distance() + low.slope * step;
    if (bound >= reach) break;
    if (best.surface.distance - bound <= tolerance * (std::abs(best.surface.distance) + high.slope - low.slope)) break;
    // Every third probe halves the interval: the others may creep up from one side.
    const double fraction = i % 3 == 2 ? low.at.fraction + 0.5 * width : next_fraction(low, high, low.at.fraction + step);
    if (!(fraction > low.at.fraction && fraction < high.at.fraction)) break;
    const Probe next = probe(shape, start, end, fraction);
    if (next.distance() < best.surface.distance) best = next.at;
    if (next.slope == 0) break;
    (next.slope < 0 ? low : high) = next;
  }
  return best;
}

SegmentSurfacePoint deepest_point_of(const PlaneShape& plane, const Vector3& start, const Vector3& end, double) {
  const double fraction = start.z() < end.z() ? 0 : start.z() > end.z() ? 1 : 0.5;
  return at_fraction(plane, start, end, fraction);
}

SegmentSurfacePoint deepest_point_of(const SphereShape& sphere, const Vector3& start, const Vector3& end, double) {
  return at_fraction(sphere, start, end, closest_fraction(start, end, Vector3::Zero()));
}

SegmentSurfacePoint deepest_point_of(const CapsuleShape& capsule, const Vector3& start, const Vector3& end, double) {
  const Vector3 tip(0, 0, 0.5 * capsule.length);
  return at_fraction(capsule, start, end, closest_fractions(start, end, -tip, tip).first);
}

SegmentSurfacePoint deepest_point_of(const CylinderShape& cylinder, const Vector3& start, const Vector3& end, double reach) {
  return deepest_of_convex(cylinder, start, end, reach);
}

SegmentSurfacePoint deepest_point_of(const BoxShape& box, const Vector3& start, const Vector3& end, double reach) {
  return deepest_of_convex(box, start, end, reach);
}

SegmentSurfacePoint deepest_point_of(const MeshShape& mesh, const Vector3& start, const Vector3& end, double reach) {
  if (!mesh.is_sheet()) return mesh.mesh->deepest_point(start, end, reach);
  const double half = 0.5 * mesh.thickness;
  const SegmentSurfacePoint found = mesh.mesh->closest_point_of_sheet(start, end, reach + half);
  return {found.fraction, raised(found.surface, half)};
}

}  // namespace

Shape shape_of(const ShapeDesc& desc) {
  switch (desc.type) {
    case ShapeType::plane:
      return PlaneShape{};
    case ShapeType::sphere:
      return SphereShape{desc.radius};
    case ShapeType::capsule:
      return CapsuleShape{desc.radius, desc.length};
    case ShapeType::cylinder:
      return CylinderShape{desc.radius, desc.length};
    case ShapeType::box:
      return BoxShape{desc.size};
    case ShapeType::mesh:
      break;
  }
  return MeshShape{desc.mesh, desc.uri, desc.scale, desc.sheet, desc.thickness};
}

SurfacePoint closest_point(const Shape& shape, const Vector3& point, double reach) {
  return std::visit([&](const auto& of_type) { return closest_point_of(of_type, point, reach); }, shape);
}

SegmentSurfacePoint deepest_point(const Shape& shape, const Vector3& start, const Vector3& end, double reach) {
  return std::visit([&](const auto& of_type) { return deepest_point_of(of_type, start, end, reach); }, shape);
}

}  // namespace verlet_cable
