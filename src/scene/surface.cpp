#include "surface.h"

#include <array>
#include <cmath>
#include <variant>

namespace verlet_cable {
namespace {

constexpr int corners_of_circle = 32;
constexpr int rings_of_half_sphere = 8;

/// A circle around the z axis.
struct Ring {
  double radius;  ///< [m] 0: a point
  double z;       ///< [m]
};

/// The surface between rings from below, of which the first and the last are points.
Surface revolved(const std::vector<Ring>& rings) {
  Surface surface;
  std::vector<int> first_of_ring;
  for (const Ring& ring : rings) {
    first_of_ring.push_back(static_cast<int>(surface.points.size()));
    const int corners = ring.radius > 0 ? corners_of_circle : 1;
    for (int k = 0; k < corners; ++k) {
      const double angle = 2 * M_PI * k / corners_of_circle;
      surface.points.emplace_back(ring.radius * std::cos(angle), ring.radius * std::sin(angle), ring.z);
    }
  }
  for (std::size_t i = 0; i + 1 < rings.size(); ++i)
    for (int k = 0; k < corners_of_circle; ++k) {
      const int next = (k + 1) % corners_of_circle, lower = first_of_ring[i], upper = first_of_ring[i + 1];
      if (rings[i].radius == 0)
        surface.faces.push_back({lower, upper + next, upper + k});
      else if (rings[i + 1].radius == 0)
        surface.faces.push_back({lower + k, lower + next, upper});
      else
        surface.faces.push_back({lower + k, lower + next, upper + next, upper + k});
    }
  return surface;
}

Surface capsule_surface(double radius, double length) {
  std::vector<Ring> rings{{0, -0.5 * length - radius}};
  for (const int side : {-1, 1})
    for (int k = 0; k < rings_of_half_sphere; ++k) {
      const int from_equator = side < 0 ? rings_of_half_sphere - 1 - k : k;
      if (length == 0 && side > 0 && from_equator == 0) continue;  // a sphere has one
      const double latitude = 0.5 * M_PI * from_equator / rings_of_half_sphere;
      rings.push_back({radius * std::cos(latitude), side * (0.5 * length + radius * std::sin(latitude))});
    }
  rings.push_back({0, 0.5 * length + radius});
  return revolved(rings);
}

struct SurfaceOfShape {
  double reach;

  Surface operator()(const PlaneShape&) const {
    return {{{-reach, -reach, 0}, {reach, -reach, 0}, {reach, reach, 0}, {-reach, reach, 0}}, {{0, 1, 2, 3}}};
  }
  Surface operator()(const SphereShape& sphere) const { return capsule_surface(sphere.radius, 0); }
  Surface operator()(const CapsuleShape& capsule) const { return capsule_surface(capsule.radius, capsule.length); }
  Surface operator()(const CylinderShape& cylinder) const {
    const double half = 0.5 * cylinder.length;
    return revolved({{0, -half}, {cylinder.radius, -half}, {cylinder.radius, half}, {0, half}});
  }
  Surface operator()(const BoxShape& box) const {
    Surface surface;
    for (const double z : {-0.5, 0.5})
      for (const double y : {-0.5, 0.5})
        for (const double x : {-0.5, 0.5}) surface.points.push_back(box.size.cwiseProduct(Vector3(x, y, z)));
    surface.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    return surface;
  }
  Surface operator()(const MeshShape& mesh) const {
    Surface surface{mesh.mesh->vertices(), {}};
    for (const auto& triangle : mesh.mesh->triangles()) surface.faces.emplace_back(triangle.begin(), triangle.end());
    return surface;
  }
};

}  // namespace

Surface surface_of(const Shape& shape, double plane_reach) {
  return std::visit(SurfaceOfShape{plane_reach}, shape);
}

double plane_reach(const World& world) {
  double reach = 1;
  for (const Obstacle& obstacle : world.obstacles()) {
    if (!std::holds_alternative<PlaneShape>(obstacle.shape) || !obstacle.present) continue;
    const Vector3 middle = (world.frame_pose(obstacle.frame) * obstacle.pose).position;
    const auto cover = [&](const Vector3& point) { reach = std::max(reach, std::ceil((point - middle).norm()) + 1); };
    for (const SimulatedCable& cable : world.cables())
      for (const Vector3& position : cable.state.positions) cover(position);
    for (const SimulatedNet& net : world.nets())
      for (const Vector3& position : net.state.positions) cover(position);
    for (const SimulatedParticle& particle : world.particles()) cover(particle.position);
    for (const SimulatedBody& body : world.bodies()) cover(body.pose.position);
  }
  return reach;
}

}  // namespace verlet_cable
