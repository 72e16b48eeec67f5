#include "body/mass_properties.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <variant>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable {

namespace {

/// Of sums of moments that are written with a few digits.
constexpr double inertia_tolerance = 1e-9;

MassProperties around_origin(double mass, const Vector3& moments) {
  return {mass, Vector3::Zero(), moments.asDiagonal()};
}

/// What a mass in one point at `arm` from an axis's origin adds to the inertia there (Steiner).
Eigen::Matrix3d point_inertia(double mass, const Vector3& arm) {
  return mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
}

MassProperties properties_of(const PlaneShape&) {
  return {};
}

MassProperties properties_of(const SphereShape& sphere) {
  const double square = sphere.radius * sphere.radius, mass = 4.0 / 3 * M_PI * square * sphere.radius;
  return around_origin(mass, Vector3::Constant(0.4 * mass * square));
}

MassProperties properties_of(const CylinderShape& cylinder) {
  const double square = cylinder.radius * cylinder.radius, mass = M_PI * square * cylinder.length;
  const double across = mass * (3 * square + cylinder.length * cylinder.length) / 12;
  return around_origin(mass, {across, across, 0.5 * mass * square});
}

/// A cylinder with half a sphere at each end, whose own center of mass is 3/8 of the radius away from its flat side.
MassProperties properties_of(const CapsuleShape& capsule) {
  const MassProperties cylinder = properties_of(CylinderShape{capsule.radius, capsule.length});
  const MassProperties sphere = properties_of(SphereShape{capsule.radius});
  const double shift = sphere.mass * (0.25 * capsule.length * capsule.length + 0.375 * capsule.length * capsule.radius);
  return around_origin(cylinder.mass + sphere.mass, (cylinder.inertia + sphere.inertia).diagonal() + Vector3(shift, shift, 0));
}

MassProperties properties_of(const BoxShape& box) {
  const Vector3 squares = box.size.cwiseAbs2();
  const double mass = box.size.prod();
  return around_origin(mass, mass / 12 * (Vector3::Constant(squares.sum()) - squares));
}

/// What is open, or a sheet, has no volume. Of a mesh's shape or description.
template <class Mesh>
bool has_volume(const Mesh& shape) {
  return shape.mesh->is_closed() && shape.sheet != Sheet::yes;
}

/// Sums over the tetrahedra between the triangles and a point (Blow and Binstock, How to find the inertia tensor of an arbitrary
/// polyhedron, 2004): the integral of x x' over that of the corners 0, a, b and c is det(a, b, c) / 120 (a a' + b b' + c c' + s
/// s') with s = a + b + c.
MassProperties properties_of(const MeshShape& shape) {
  if (!has_volume(shape)) return {};
  const TriangleMesh& mesh = *shape.mesh;
  const Vector3 origin = mesh.vertices().front();
  double volume = 0;
  Vector3 first = Vector3::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const TriangleMesh::Triangle& triangle : mesh.triangles()) {
    const Vector3 a = mesh.vertices()[triangle[0]] - origin, b = mesh.vertices()[triangle[1]] - origin,
                  c = mesh.vertices()[triangle[2]] - origin, sum = a + b + c;
    const double determinant = a.dot(b.cross(c));
    volume += determinant / 6;
    first += determinant / 24 * sum;
    second += determinant / 120 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  const Vector3 center = first / volume;
  second -= volume * center * center.transpose();
  return {volume, origin + center, second.trace() * Eigen::Matrix3d::Identity() - second};
}

/// Seen from the frame that `pose` is in.
MassProperties moved(const MassProperties& properties, const Pose& pose) {
  const Eigen::Matrix3d axes = pose.orientation.toRotationMatrix();
  return {properties.mass, pose.position + axes * properties.center_of_mass, axes * properties.inertia * axes.transpose()};
}

/// Of all shapes together, with 1 kg/m^3.
MassProperties sum_of(const std::vector<ShapeDesc>& shapes) {
  std::vector<MassProperties> parts;
  MassProperties whole;
  for (const ShapeDesc& shape : shapes) {
    const MassProperties& part = parts.emplace_back(moved(mass_properties(shape_of(shape)), pose_of(shape.pose)));
    whole.mass += part.mass;
    whole.center_of_mass += part.mass * part.center_of_mass;
  }
  if (whole.mass == 0) return {};
  whole.center_of_mass /= whole.mass;
  for (const MassProperties& part : parts)
    whole.inertia += part.inertia + point_inertia(part.mass, part.center_of_mass - whole.center_of_mass);
  return whole;
}

}  // namespace

MassProperties mass_properties(const Shape& shape) {
  return std::visit([](const auto& solid) { return properties_of(solid); }, shape);
}

std::optional<MassProperties> mass_properties(const BodyDesc& body) {
  const auto is_solid = [](const ShapeDesc& shape) { return shape.type != ShapeType::mesh || has_volume(shape); };
  const MassProperties filled = sum_of(body.shapes);
  const bool follows = filled.mass > 0 && std::all_of(body.shapes.begin(), body.shapes.end(), is_solid);
  if (!body.inertia && !follows) return std::nullopt;
  MassProperties result{body.mass, body.center_of_mass.value_or(filled.center_of_mass), Eigen::Matrix3d::Zero()};
  if (body.inertia) {
    result.inertia = body.inertia->asDiagonal();
  } else {
    result.inertia =
        body.mass / filled.mass * filled.inertia + point_inertia(body.mass, filled.center_of_mass - result.center_of_mass);
  }
  return result;
}

bool is_inertia(const Vector3& moments) {
  return moments.allFinite() && moments.minCoeff() > 0 && 2 * moments.maxCoeff() <= (1 + inertia_tolerance) * moments.sum();
}

}  // namespace verlet_cable
