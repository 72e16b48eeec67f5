#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../support/meshes.h"
#include "../support/scenes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

/// A thin cable that falls across the edges of a block which is turned about the vertical by `yaw` [rad].
SceneDesc thin_cable_on_a_block(double radius, int segments, double yaw, ShapeType type) {
  SceneDesc scene = scenes::one_cable(segments);
  MaterialDesc& material = scene.materials[0].material;
  material.radius = radius;
  material.linear_density = 0.02;
  material.friction = 0.4;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {-0.44, 0.03, 0.12};
  scene.cables[0].initial.to = {0.56, 0.03, 0.12};
  ObstacleDesc block;
  block.name = "block";
  block.type = type;
  block.size = {0.3, 0.4, 0.1};
  block.radius = 0.15;
  block.length = 0.1;
  if (type == ShapeType::mesh) block.mesh = box_triangles(block.size).mesh();
  block.pose = {0, 0, 0, 0, 0, yaw};
  scene.obstacles.push_back(block);
  return scene;
}

/// How deep a cable's centre line is below an obstacle's surface, at any point [m].
double depth_of_centre_line(const SimulatedCable& cable, const Obstacle& obstacle) {
  const Pose to_shape = obstacle.pose.inverse();
  const auto local = [&](const Vector3& point) { return Vector3(to_shape.position + to_shape.orientation * point); };
  const std::vector<Vector3>& x = cable.state.positions;
  double deepest = -infinity;
  for (std::size_t i = 0; i + 1 < x.size(); ++i)
    deepest = std::max(deepest, -deepest_point(obstacle.shape, local(x[i]), local(x[i + 1])).surface.distance);
  return deepest;
}

TEST(Edge, ThinCablesThatSlideOverItDoNotStayInside) {
  for (const ShapeType type : {ShapeType::box, ShapeType::mesh, ShapeType::cylinder})
    for (const double radius : {0.25e-3, 0.5e-3})
      for (const int segments : {100, 200}) {
        World world(thin_cable_on_a_block(radius, segments, 0.5, type), BoundaryInputs(1));
        double since = 0;
        for (int i = 0; i < 1500; ++i) {
          // What gets inside says so.
          EXPECT_LE(world.step(BoundaryInputs(1)).status, StepResult::Status::inside_obstacle);
          if (i % 5 != 0) continue;
          const double depth = depth_of_centre_line(world.cables()[0], world.obstacles()[0]);
          if (depth <= 0) since = world.time();
          // Fast segments that are twenty times as long as thick get in between two steps, but out at once.
          ASSERT_LT(world.time() - since, 0.03) << depth << " m deep, radius " << radius << ", " << segments << " segments";
        }
      }
}

/// A light rope that is drawn over the edge of a wedge of this turn [rad]: a box for a right angle, a mesh for others. The frames
/// "first" and "second" hold its ends.
SceneDesc rope_over_an_edge(double turn, double friction) {
  SceneDesc scene = scenes::one_cable(50);
  scene.gravity.acceleration.setZero();
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.002;
  material.axial_stiffness = 200;
  material.axial_damping = 0.2;
  const double half = 0.5 * turn, arm = 0.25;
  const Vector3 up{std::cos(half), 0, std::sin(half)}, down{std::cos(half), 0, -std::sin(half)};
  CableDesc& cable = scene.cables[0];
  cable.initial.type = InitialShapeDesc::Type::points;
  std::vector<Vector3>& points = cable.initial.points;
  for (int i = 0; i <= 20; ++i) {
    const double angle = -half + turn * i / 20;
    points.push_back(material.radius * Vector3(std::sin(angle), 0, std::cos(angle)));
  }
  points.insert(points.begin(), points.front() - arm * up);
  points.push_back(points.back() + arm * down);
  cable.length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) cable.length += (points[i] - points[i - 1]).norm();
  cable.length *= 0.98;  // tight from the start
  for (const bool first : {true, false}) {
    const char* frame = first ? "first" : "second";
    const Vector3& end = first ? points.front() : points.back();
    AttachmentDesc held = scenes::attachment(frame, first ? PlaceDesc::At::start : PlaceDesc::At::end, Vector3::Zero(), frame);
    held.initial_pose = InitialPose{end.x(), end.y(), end.z(), 0, 0, 0};
    cable.attachments.push_back(held);
  }
  ObstacleDesc wedge;
  wedge.name = "wedge";
  wedge.friction = friction;
  if (turn == 0.5 * M_PI) {
    wedge.type = ShapeType::box;
    wedge.size = {1, 1, 1};
    wedge.pose = {0, 0, -std::sqrt(0.5), 0, 0.25 * M_PI, 0};
  } else {
    Triangles prism;
    for (const double y : {-0.5, 0.5})
      for (const Vector3& corner : {Vector3(0, y, 0), Vector3(-up + Vector3(0, y, 0)), Vector3(down + Vector3(0, y, 0))})
        prism.vertices.push_back(corner);
    prism.triangles = {{0, 1, 2}, {3, 5, 4}, {0, 4, 1}, {0, 3, 4}, {0, 5, 3}, {0, 2, 5}, {1, 5, 2}, {1, 4, 5}};
    wedge.type = ShapeType::mesh;
    wedge.mesh = prism.mesh();
  }
  scene.obstacles.push_back(wedge);
  return scene;
}

struct Ratios {
  double mean = 0, largest = 0;
};

/// Of the forces at the ends of a rope that is drawn over an edge, slowly, by two segments' lengths.
Ratios ratios_over_an_edge(double turn, double friction) {
  const double half = 0.5 * turn, speed = 0.005, time_step = 1e-3;
  const SceneDesc scene = rope_over_an_edge(turn, friction);
  BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  double first = 0, second = 0;
  Ratios ratios;
  for (int i = 1; i <= 6000; ++i) {
    frames[1].pose.position += speed * time_step * Vector3(std::cos(half), 0, std::sin(half));
    frames[2].pose.position += speed * time_step * Vector3(std::cos(half), 0, -std::sin(half));
    EXPECT_EQ(world.step(frames).status, StepResult::Status::ok);
    if (i <= 2000) continue;
    const double before = world.attachments()[0].force.norm(), behind = world.attachments()[1].force.norm();
    first += before;
    second += behind;
    ratios.largest = std::max(ratios.largest, behind / before);
  }
  ratios.mean = second / first;
  return ratios;
}

TEST(Edge, HoldsTheTensionsOfACapstanWhateverElementIsThere) {
  for (const double turn : {0.5 * M_PI, 0.25 * M_PI})
    for (const double friction : {0.1, 0.3, 0.6}) {
      const Ratios ratios = ratios_over_an_edge(turn, friction);
      const double expected = std::exp(friction * turn);
      EXPECT_NEAR(ratios.mean, expected, 0.005 * expected) << "turn " << turn << ", friction " << friction;
      // From one substep to the next it sticks and slides.
      EXPECT_LT(ratios.largest, 1.025 * expected) << "turn " << turn << ", friction " << friction;
    }
}

/// A cable that falls into the gap between two blocks which lean away from each other by an `angle` [rad], through a viscous
/// fluid, where nothing rubs.
SceneDesc cable_over_a_gap(double angle, double density, double stiffness, int segments, const Vector3& from, const Vector3& to) {
  SceneDesc scene = scenes::one_cable(segments, (to - from).norm());
  scene.time_step = 0.01;
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = density;
  material.radius = from.z();
  material.friction = 0;
  material.drag = 8 * density;
  material.axial_stiffness = stiffness;
  if (stiffness < infinity) material.axial_damping = 0.002 * stiffness;
  CableDesc& cable = scene.cables[0];
  cable.initial.type = InitialShapeDesc::Type::straight;
  cable.initial.from = from;
  cable.initial.to = to;
  for (const double side : {-1.0, 1.0}) {
    ObstacleDesc block;
    block.name = side < 0 ? "left" : "right";
    block.type = ShapeType::box;
    block.size = {0.4, 0.6, 0.2};
    const double along = 0.2 * std::cos(angle) + 0.1 * std::sin(angle), down = 0.2 * std::sin(angle) + 0.1 * std::cos(angle);
    block.pose = {side * along, 0, -down, 0, side * angle, 0};
    block.friction = 0;
    scene.obstacles.push_back(block);
  }
  ObstacleDesc floor;
  floor.name = "floor";
  floor.pose = {0, 0, -0.25, 0, 0, 0};
  floor.friction = 0;
  scene.obstacles.push_back(floor);
  return scene;
}

TEST(Edge, StrikesDoNoWork) {
  for (const SceneDesc& scene : {cable_over_a_gap(0.234, 0.6, infinity, 26, {-0.3426, -0.0701, 0.008}, {0.1769, 0.0362, 0.008}),
                                 cable_over_a_gap(0.281, 0.005, 1e4, 44, {-0.3838, -0.2416, 0.002}, {0.25, 0.1574, 0.002}),
                                 cable_over_a_gap(0.1, 0.005, infinity, 40, {-0.4, -0.2, 0.002}, {0.25, 0.1, 0.002})}) {
    World world(scene, BoundaryInputs(1));
    const double length = scene.cables[0].length;
    const double size = scene.materials[0].material.linear_density * length * 9.81 * length;
    double most = 0;
    for (int i = 0; i < 300; ++i) {
      world.step(BoundaryInputs(1));
      const double lost = world.ledger().balance.dissipated.contact;
      most = std::max(most, lost);
      EXPECT_GT(lost, most - 0.01 * size) << i;
    }
  }
}

/// On a box that is tilted, on its edges and on a thin board, limp or stiff.
TEST(Edge, CablesComeToRestOnBoxesWithFriction) {
  for (const double time_step : {0.001, 0.002, 0.005, 0.01})
    for (const double tilt : {0.0, 0.2})
      for (const double thickness : {0.004, 0.1})
        for (const double stiffness : {0.0, 0.01}) {
          SCOPED_TRACE(testing::Message() << time_step << " s, " << tilt << ", " << thickness << " m, " << stiffness);
          SceneDesc scene = scenes::one_cable(30, 0.6);
          scene.time_step = time_step;
          MaterialDesc& material = scene.materials[0].material;
          material.friction = 0.5;
          material.drag = 0.8;
          material.bending_stiffness = stiffness;
          material.bending_damping = 0.02 * stiffness;
          CableDesc& cable = scene.cables[0];
          const Vector3 up(std::sin(tilt), 0, std::cos(tilt)), along(std::cos(tilt), 0, -std::sin(tilt));
          const Vector3 middle = 0.015 * up + 0.05 * along, half = 0.3 * (0.8 * along + 0.6 * Vector3::UnitY());
          cable.initial.type = InitialShapeDesc::Type::straight;
          cable.initial.from = middle - half;
          cable.initial.to = middle + half;
          ObstacleDesc box;
          box.name = "box";
          box.type = ShapeType::box;
          box.size = {0.4, 0.6, thickness};
          box.pose = {-0.5 * thickness * up.x(), 0, -0.5 * thickness * up.z(), 0, tilt, 0};
          box.friction = 0.5;
          scene.obstacles.push_back(box);
          World world(scene, BoundaryInputs(1));
          for (int i = 0; i < std::lround(3 / time_step); ++i) world.step(BoundaryInputs(1));
          for (const Vector3& velocity : world.cables()[0].state.velocities) EXPECT_LT(velocity.norm(), 0.002);
          const Ledger ledger = world.ledger();
          const double size = 0.1 * 0.6 * 9.81 * 0.6;
          EXPECT_GT(ledger.balance.dissipated.contact, 0);
          EXPECT_LT(std::abs(ledger.unaccounted()), 1e-4 * size);
        }
}

}  // namespace
}  // namespace verlet_cable
