#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/meshes.h"
#include "../support/scenes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

constexpr double radius = 0.005;

Triangles square_triangles(double half) {
  return {{{-half, -half, 0}, {half, -half, 0}, {half, half, 0}, {-half, half, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

/// A rope of 5 mm that lies straight along x at a height [m], above a mesh at the origin.
SceneDesc rope_above(const Triangles& mesh, double height, double time_step) {
  SceneDesc scene = scenes::one_cable(30, 0.6);
  scene.time_step = time_step;
  scene.materials[0].material.linear_density = 0.05;
  scene.materials[0].material.radius = radius;
  scene.materials[0].material.drag = 0.1;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {-0.3, 0, height};
  scene.cables[0].initial.to = Vector3(0.3, 0, height);
  ObstacleDesc obstacle;
  obstacle.name = "mesh";
  obstacle.type = ShapeType::mesh;
  obstacle.mesh = mesh.mesh();
  scene.obstacles.push_back(obstacle);
  return scene;
}

/// Heights [m] of the nodes after a duration [s].
std::pair<double, double> heights_after(const SceneDesc& scene, double duration) {
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  for (const double end = duration - 0.5 * scene.time_step; world.time() < end;) world.step(inputs);
  std::pair<double, double> heights{infinity, -infinity};
  for (const Vector3& x : world.cables()[0].state.positions) {
    heights.first = std::min(heights.first, x.z());
    heights.second = std::max(heights.second, x.z());
  }
  return heights;
}

TEST(Sheets, ARopeThatFallsOnOneComesToRestOnIt) {
  for (const double time_step : {0.001, 0.005})
    for (const double thickness : {0.0, 0.01}) {
      SceneDesc scene = rope_above(square_triangles(1), 0.3, time_step);
      scene.obstacles[0].thickness = thickness;
      const auto [low, high] = heights_after(scene, 2);
      EXPECT_NEAR(low, radius + thickness / 2, 1e-3) << time_step;
      EXPECT_NEAR(high, radius + thickness / 2, 1e-3) << time_step;
    }
}

TEST(Sheets, AreTouchedFromBelowToo) {
  for (const double time_step : {0.001, 0.005}) {
    SceneDesc scene = rope_above(square_triangles(1), -0.3, time_step);
    scene.gravity.acceleration = {0, 0, 9.81};
    const auto [low, high] = heights_after(scene, 2);
    EXPECT_NEAR(low, -radius, 1e-3) << time_step;
    EXPECT_NEAR(high, -radius, 1e-3) << time_step;
  }
}

TEST(Sheets, AnOpenBoxHoldsARope) {
  Triangles box = box_triangles({1, 1, 0.2});
  box.triangles.erase(box.triangles.begin(), box.triangles.begin() + 2);
  for (std::size_t i = 0; i < 4; ++i) std::swap(box.triangles[i][0], box.triangles[i][1]);
  for (const Sheet sheet : {Sheet::automatic, Sheet::no, Sheet::yes}) {
    SceneDesc scene = rope_above(box, 0.15, 0.001);
    scene.obstacles[0].sheet = sheet;
    const auto [low, high] = heights_after(scene, 2);
    EXPECT_NEAR(low, 0.1 + radius, 1e-3);
    EXPECT_NEAR(high, 0.1 + radius, 1e-3);
  }
}

}  // namespace
}  // namespace verlet_cable
