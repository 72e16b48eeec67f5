#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/scenes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

/// Stands straight along z, or along another direction, its lower end in the hand.
SceneDesc column(double axial_stiffness, double bending_stiffness, const Vector3& direction = Vector3::UnitZ()) {
  SceneDesc scene = scenes::one_cable(20);
  scene.time_step = 0.005;
  scene.materials[0].material.axial_stiffness = axial_stiffness;
  scene.materials[0].material.bending_stiffness = bending_stiffness;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = direction;
  scene.cables[0].attachments = {scenes::attachment("hand", PlaceDesc::At::start, {0, 0, 0}, "hand"),
                                 scenes::attachment("top", PlaceDesc::At::end, direction)};
  return scene;
}

double aside(const World& world) {
  double most = 0;
  for (const Vector3& position : world.cables()[0].state.positions) most = std::max(most, position.head<2>().norm());
  return most;
}

TEST(StraightColumn, ThatCannotShortenGivesWayAtOnce) {
  for (const double bending_stiffness : {0.0, 1e-3}) {
    World world(column(infinity, bending_stiffness), scenes::hand_at({0, 0, 0}));
    for (int i = 1; i <= 200; ++i) {
      const StepResult result = world.step(scenes::hand_at({0, 0, 0.0005 * i}));
      ASSERT_EQ(result.status, StepResult::Status::ok) << "step " << i;
      // It was 0.05 and 1e6 N.
      ASSERT_LT(result.max_strain, 1e-4) << "step " << i;
      ASSERT_LT(world.attachments()[0].force.norm(), 1000) << "step " << i;
    }
    EXPECT_GT(aside(world), 0.04);
  }
}

TEST(StraightColumn, ThatCanShortenBucklesAtItsEulerLoad) {
  constexpr double bending_stiffness = 0.5, axial_stiffness = 1e4, euler_load = M_PI * M_PI * bending_stiffness;  // 4.93 N
  SceneDesc scene = column(axial_stiffness, bending_stiffness);
  scene.gravity.acceleration = Vector3::Zero();
  scene.materials[0].material.bending_damping = 1e-2;
  scene.materials[0].material.axial_damping = 10;
  World world(scene, scenes::hand_at({0, 0, 0}));
  // Slowly, to nine tenths of the load, where it stays straight, and to twice of it.
  const auto push = [&](double load) {
    const double from = world.frame_pose(1).position.z(), to = load / axial_stiffness;
    for (int i = 1; i <= 2000; ++i) world.step(scenes::hand_at({0, 0, from + (to - from) * std::min(1.0, i / 1000.0)}));
  };
  push(0.9 * euler_load);
  EXPECT_EQ(aside(world), 0);
  EXPECT_NEAR(world.attachments()[0].force.norm(), 0.9 * euler_load, 0.02 * euler_load);
  push(2 * euler_load);
  EXPECT_GT(aside(world), 0.005);
  EXPECT_NEAR(world.attachments()[0].force.norm(), euler_load, 0.02 * euler_load);
}

TEST(StraightColumn, ThatIsPulledOrMovedAlongStaysStraight) {
  for (const double speed : {-0.0005, 0.0}) {
    SceneDesc scene = column(1e4, 1e-3, Vector3::UnitX());
    scene.gravity.acceleration = Vector3::Zero();
    scene.cables[0].attachments[1].frame = "other";
    const auto inputs = [&](int i) {
      BoundaryInputs all(3);
      all[1].pose.position = {0.0005 * i + speed * i, 0, 0};
      all[2].pose.position = {0.0005 * i, 0, 0};
      return all;
    };
    World world(scene, inputs(0));
    for (int i = 1; i <= 200; ++i) world.step(inputs(i));
    for (const Vector3& position : world.cables()[0].state.positions) EXPECT_NEAR(position.tail<2>().norm(), 0, 1e-9);
  }
}

}  // namespace
}  // namespace verlet_cable
