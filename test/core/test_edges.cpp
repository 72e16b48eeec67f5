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
          EXPECT_EQ(world.step(BoundaryInputs(1)).status, StepResult::Status::ok);
          if (i % 5 != 0) continue;
          const double depth = depth_of_centre_line(world.cables()[0], world.obstacles()[0]);
          if (depth <= 0) since = world.time();
          // Fast segments that are twenty times as long as thick get in between two steps, but out at once.
          ASSERT_LT(world.time() - since, 0.03) << depth << " m deep, radius " << radius << ", " << segments << " segments";
        }
      }
}

}  // namespace
}  // namespace verlet_cable
