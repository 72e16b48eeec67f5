#include "contact_scenes.h"

#include <cmath>
#include <memory>
#include <vector>

#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable::bench {

namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double cylinder_radius = 0.05;  // [m]

/// The same numbers on every machine, 0 to 1.
class Numbers {
 public:
  explicit Numbers(int seed) : state_(static_cast<std::uint32_t>(seed) * 2654435761u + 1) {}
  double next() { return (state_ = state_ * 1664525u + 1013904223u) / 4294967296.0; }
  double around_zero(double width) { return width * (next() - 0.5); }

 private:
  std::uint32_t state_;
};

SceneDesc scene_of_rope() {
  SceneDesc scene;
  MaterialDesc rope;
  rope.linear_density = 0.1;
  rope.radius = contact_radius;
  rope.bending_stiffness = 1e-3;
  rope.bending_damping = 5e-5;
  rope.drag = 0.1;
  scene.materials.push_back({"rope", rope});
  return scene;
}

CableDesc cable_of_rope(const std::string& name, double length, int segments) {
  CableDesc cable;
  cable.name = name;
  cable.length = length;
  cable.segments = segments;
  cable.material = "rope";
  return cable;
}

void add_floor(SceneDesc& scene) {
  ObstacleDesc floor;
  floor.name = "floor";
  floor.type = ShapeType::plane;
  scene.obstacles.push_back(floor);
}

double polyline_length(const std::vector<Vector3>& points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

AttachmentDesc held(const std::string& frame, PlaceDesc::At at, const Vector3& place) {
  AttachmentDesc attachment;
  attachment.name = attachment.frame = frame;
  attachment.place.at = at;
  attachment.initial_pose = InitialPose{place.x(), place.y(), place.z(), 0, 0, 0};
  return attachment;
}

void hold_ends(CableDesc& cable) {
  const std::vector<Vector3>& points = cable.initial.points;
  cable.attachments = {held("first", PlaceDesc::At::start, points.front()), held("second", PlaceDesc::At::end, points.back())};
}

std::shared_ptr<const TriangleMesh> torus(double large, double small) {
  constexpr int around = 24, across = 12;
  std::vector<Vector3> vertices;
  std::vector<TriangleMesh::Triangle> triangles;
  const auto vertex = [&](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i)
    for (int j = 0; j < across; ++j) {
      const double a = 2 * pi * i / around, b = 2 * pi * j / across, distance = large + small * std::cos(b);
      vertices.emplace_back(distance * std::cos(a), distance * std::sin(a), small * std::sin(b));
      triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
      triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
    }
  return std::make_shared<TriangleMesh>(vertices, triangles);
}

}  // namespace

Vector3 capstan_first_pull() {
  return -Vector3::UnitZ();
}

Vector3 capstan_second_pull(double angle) {
  return {std::sin(angle), 0, std::cos(angle)};
}

SceneDesc capstan(double friction, double angle, int segments) {
  SceneDesc scene = scene_of_rope();
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.002;
  material.axial_stiffness = 2000;
  material.axial_damping = 2;
  material.bending_stiffness = material.bending_damping = material.drag = 0;
  scene.gravity.acceleration.setZero();
  const double wrap = cylinder_radius + contact_radius;
  std::vector<Vector3> points{Vector3(-wrap, 0, 0) + capstan_arm * capstan_first_pull()};
  constexpr int corners = 400;
  for (int i = 0; i <= corners; ++i) {
    const double turned = angle * i / corners;
    points.emplace_back(-wrap * std::cos(turned), 0, wrap * std::sin(turned));
  }
  points.push_back(points.back() + capstan_arm * capstan_second_pull(angle));
  // So much shorter that it is under tension from the start.
  CableDesc cable = cable_of_rope("cable", polyline_length(points) * 0.998, segments);
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = points;
  hold_ends(cable);
  scene.cables.push_back(cable);
  ObstacleDesc cylinder;
  cylinder.name = "capstan";
  cylinder.type = ShapeType::cylinder;
  cylinder.radius = cylinder_radius;
  cylinder.length = 1;
  cylinder.pose = {0, 0, 0, pi / 2, 0, 0};
  cylinder.friction = friction;
  scene.obstacles.push_back(cylinder);
  return scene;
}

SceneDesc drop(ShapeType type, int number) {
  Numbers numbers(number);
  SceneDesc scene = scene_of_rope();
  scene.materials[0].material.friction = 0.3 + 0.4 * numbers.next();
  CableDesc cable = cable_of_rope("cable", 1, 50);
  cable.initial.type = InitialShapeDesc::Type::straight;
  const double azimuth = 2 * pi * numbers.next(), elevation = numbers.around_zero(0.8 * pi);
  const Vector3 along{std::cos(azimuth) * std::cos(elevation), std::sin(azimuth) * std::cos(elevation), std::sin(elevation)};
  const Vector3 middle{numbers.around_zero(0.3), numbers.around_zero(0.3),
                       0.45 + 0.2 * numbers.next() + 0.5 * std::abs(along.z())};
  cable.initial.from = middle - 0.5 * along;
  cable.initial.to = middle + 0.5 * along;
  scene.cables.push_back(cable);
  add_floor(scene);
  ObstacleDesc obstacle;
  obstacle.name = "obstacle";
  obstacle.type = type;
  obstacle.radius = 0.1;
  obstacle.length = 0.3;
  obstacle.size = {0.3, 0.2, 0.2};
  obstacle.pose = {0, 0, 0.2, 3 * numbers.next(), 3 * numbers.next(), 3 * numbers.next()};
  if (type == ShapeType::plane) obstacle.pose = {0, 0, 0.1, numbers.around_zero(0.3), numbers.around_zero(0.3), 0};
  if (type == ShapeType::mesh) obstacle.mesh = torus(0.15, 0.05);
  scene.obstacles.push_back(obstacle);
  scene.contact = ContactDesc{};
  return scene;
}

SceneDesc coils(int segments, bool contact) {
  SceneDesc scene = scene_of_rope();
  std::vector<Vector3> points;
  const double wanted = 0.01 * segments;
  double length = 0;
  for (double turned = 0; length < wanted; turned += 0.05) {
    const double radius = 0.12 + 0.03 * std::sin(0.37 * turned);
    points.emplace_back(radius * std::cos(turned), radius * std::sin(turned), 0.02 + 0.0145 * turned / (2 * pi));
    if (points.size() > 1) length += (points.back() - points[points.size() - 2]).norm();
  }
  CableDesc cable = cable_of_rope("cable", length, segments);
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = points;
  scene.cables.push_back(cable);
  add_floor(scene);
  if (contact) scene.contact = ContactDesc{};
  return scene;
}

SceneDesc crosswise(int cables, int segments) {
  SceneDesc scene = scene_of_rope();
  Numbers numbers(1);
  for (int i = 0; i < cables; ++i) {
    CableDesc cable = cable_of_rope("cable_" + std::to_string(i), 1, segments);
    const double azimuth = pi * 0.381966 * i;
    const Vector3 along{std::cos(azimuth), std::sin(azimuth), 0};
    const Vector3 middle{numbers.around_zero(0.1), numbers.around_zero(0.1), 0.05 + 0.03 * i};
    cable.initial.type = InitialShapeDesc::Type::straight;
    cable.initial.from = middle - 0.5 * along;
    cable.initial.to = middle + 0.5 * along;
    scene.cables.push_back(cable);
  }
  add_floor(scene);
  scene.contact = ContactDesc{};
  return scene;
}

SceneDesc overhand_knot(double friction, int segments) {
  SceneDesc scene = scene_of_rope();
  scene.materials[0].material.bending_stiffness = 1e-4;
  scene.materials[0].material.bending_damping = 2e-6;
  // The polynomial trefoil (Shastri, Polynomial representations of knots, 1992) with long ends
  std::vector<Vector3> points;
  for (int i = 0; i <= 400; ++i) {
    const double t = 2.05 * (i - 200) / 200.0, size = 0.075;
    points.emplace_back(size * (std::pow(t, 3) - 3 * t), 0.6 * size * (std::pow(t, 4) - 4 * t * t),
                        0.8 * size * (0.2 * std::pow(t, 5) - 2 * t));
  }
  CableDesc cable = cable_of_rope("cable", polyline_length(points), segments);
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = points;
  hold_ends(cable);
  scene.cables.push_back(cable);
  scene.contact = ContactDesc{true, true, friction};
  return scene;
}

}  // namespace verlet_cable::bench
