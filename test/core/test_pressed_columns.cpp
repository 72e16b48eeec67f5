#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/scenes.h"
#include "verlet_cable/core/world.h"

// Cables that come down straight on what they touch: they fold, and do not go through it.

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

constexpr double length = 1.5, low = 0.6;  // [m]

/// Hangs straight from the frame "hand", above a floor.
SceneDesc above_a_floor(double bending_stiffness, double axial_stiffness, AttachmentType type = AttachmentType::hinge) {
  SceneDesc scene = scenes::one_cable(40, length);
  scene.time_step = 2e-3;
  scene.materials[0].material.drag = 0.15;
  scene.materials[0].material.bending_stiffness = bending_stiffness;
  scene.materials[0].material.axial_stiffness = axial_stiffness;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {0, 0, 1.6};
  scene.cables[0].initial.to = {0, 0, 0};
  scene.cables[0].attachments = {scenes::attachment("grip", PlaceDesc::At::start, Vector3::Zero(), "hand", type)};
  if (type == AttachmentType::clamp) scene.cables[0].attachments[0].rotation = {0, M_PI / 2, 0};
  ObstacleDesc& desc = scene.obstacles.emplace_back();
  desc.name = "floor";
  desc.type = ShapeType::plane;
  return scene;
}

struct Extremes {
  double force = 0, depth = -infinity, energy = 0;
};

/// Lowers the hand at 0.5 m/s, with an offset aside, and waits.
Extremes lower(double aside, World& world) {
  Extremes most;
  for (int i = 1; i <= 2000; ++i) {
    const double height = std::max(low, 1.6 - 0.5 * world.time_step() * i);
    const StepResult result = world.step(scenes::hand_at({aside * std::sin(0.05 * i), 0, height}));
    EXPECT_EQ(result.status, Status::ok) << "step " << i;
    const CableState& state = world.cables()[0].state;
    // The first steps set the cable moving.
    if (i > 50) most.force = std::max(most.force, world.attachments()[0].force.norm());
    for (const Vector3& position : state.positions) most.depth = std::max(most.depth, -position.z());
    most.energy = std::max(most.energy, world.energy().kinetic);
  }
  return most;
}

void expect_a_pile(const SceneDesc& scene, double aside) {
  World world(scene, scenes::hand_at({0, 0, 1.6}));
  const Extremes most = lower(aside, world);
  // Its weight is 1.5 N; to stop it within a step would take 40 N.
  EXPECT_LT(most.force, 100);
  EXPECT_LT(most.depth, 0) << "a node was below the floor";
  // 0.15 kg of cable that fall by no more than 1.5 m.
  EXPECT_LT(most.energy, 2.2);
  EXPECT_LT(world.energy().kinetic, 1e-3) << "it comes to rest";
}

TEST(PressedColumns, RopeThatIsLoweredStraightPilesUpOnTheFloor) {
  for (const double aside : {0.0, 1e-12, 1e-9, 1e-6, 1e-4}) {
    SCOPED_TRACE(aside);
    expect_a_pile(above_a_floor(0, infinity), aside);
  }
}

TEST(PressedColumns, SoDoCablesThatBendOrStretch) {
  expect_a_pile(above_a_floor(0.001, infinity), 0);
  expect_a_pile(above_a_floor(0, 2000), 0);
}

/// Euler's load of a rod that is clamped above and free to move aside below, pi^2 EI / (4 L^2), is 5 N: it stands on what it
/// weighs and on what a touch adds, and is not folded.
TEST(PressedColumns, StiffRodStands) {
  const double stiffness = 4 * 5 * length * length / (M_PI * M_PI);
  World world(above_a_floor(stiffness, infinity, AttachmentType::clamp), scenes::hand_at({0, 0, 1.51}));
  for (int i = 1; i <= 400; ++i) {
    const double height = std::max(1.505 - 1e-8, 1.51 - 0.02 * world.time_step() * i);
    ASSERT_EQ(world.step(scenes::hand_at({0, 0, height})).status, Status::ok) << "step " << i;
  }
  double aside = 0;
  for (const Vector3& position : world.cables()[0].state.positions)
    aside = std::max(aside, std::hypot(position.x(), position.y()));
  EXPECT_LT(aside, 1e-6);
  EXPECT_FALSE(world.findings().contacts.empty());
}

/// Nothing holds it: it falls straight down.
TEST(PressedColumns, FreeRopeThatFallsStraightDownLiesOnTheFloor) {
  SceneDesc scene = above_a_floor(0, infinity);
  scene.cables[0].attachments.clear();
  World world(scene, initial_frames(scene));
  const BoundaryInputs inputs(1);
  double depth = -infinity;
  for (int i = 0; i < 2000; ++i) {
    world.step(inputs);
    for (const Vector3& position : world.cables()[0].state.positions) depth = std::max(depth, -position.z());
  }
  EXPECT_LT(depth, 0.005) << "its radius";
  double highest = 0;
  for (const Vector3& position : world.cables()[0].state.positions) highest = std::max(highest, position.z());
  EXPECT_LT(highest, 0.1);
}

}  // namespace
}  // namespace verlet_cable
