#include "verlet_cable/core/shape.h"

namespace verlet_cable {

namespace {

/// Half the extent along the axes of a segment of length 2 `half` along `axis`.
Vector3 half_extent(const Vector3& axis, double half) {
  return half * axis.cwiseAbs();
}

Aabb around(const Vector3& center, const Vector3& half) {
  return {center - half, center + half};
}

Aabb bounds_of(const PlaneShape&, const Pose&) {
  return {Vector3::Constant(-infinity), Vector3::Constant(infinity)};
}

Aabb bounds_of(const SphereShape& sphere, const Pose& pose) {
  return around(pose.position, Vector3::Constant(sphere.radius));
}

Aabb bounds_of(const CapsuleShape& capsule, const Pose& pose) {
  const Vector3 axis = pose.orientation * Vector3::UnitZ();
  return around(pose.position, half_extent(axis, 0.5 * capsule.length) + Vector3::Constant(capsule.radius));
}

Aabb bounds_of(const CylinderShape& cylinder, const Pose& pose) {
  const Vector3 axis = pose.orientation * Vector3::UnitZ();
  // A disc across the axis: radius times the sine of the angle between the axis and x, y, z.
  const Vector3 disc = cylinder.radius * (Vector3::Ones() - axis.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  return around(pose.position, half_extent(axis, 0.5 * cylinder.length) + disc);
}

Aabb box_around(const Vector3& center, const Vector3& half, const Pose& pose) {
  return around(pose.position + pose.orientation * center, pose.orientation.toRotationMatrix().cwiseAbs() * half);
}

Aabb bounds_of(const BoxShape& box, const Pose& pose) {
  return box_around(Vector3::Zero(), 0.5 * box.size, pose);
}

Aabb bounds_of(const MeshShape& mesh, const Pose& pose) {
  const Aabb& box = mesh.mesh->bounds();
  const double half = mesh.is_sheet() ? 0.5 * mesh.thickness : 0;
  return box_around(box.center(), 0.5 * box.sizes() + Vector3::Constant(half), pose);
}

}  // namespace

Aabb bounds(const Shape& shape, const Pose& pose) {
  return std::visit([&](const auto& of_type) { return bounds_of(of_type, pose); }, shape);
}

}  // namespace verlet_cable
