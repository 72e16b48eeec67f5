#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

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

/// A box of 0.1 kg that a rope of 0.6 m lets down from the frame "hand", exactly plumb, to a floor.
SceneDesc body_above_a_floor(double time_step, double bending_stiffness, double aside) {
  constexpr double rope = 0.6, half = 0.025;
  SceneDesc scene = scenes::one_cable(24, rope);
  scene.time_step = time_step;
  scene.materials[0].material.linear_density = 0.05;
  scene.materials[0].material.bending_stiffness = bending_stiffness;
  scene.cables[0].attachments = {scenes::attachment("grip", PlaceDesc::At::start, Vector3::Zero(), "hand"),
                                 scenes::attachment("hook", PlaceDesc::At::end, {aside, 0, half})};
  scene.cables[0].attachments[1].body = "load";
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {0, 0, rope + 2 * half + 0.05};
  scene.cables[0].initial.to = {0, 0, 2 * half + 0.05};
  BodyDesc& body = scene.bodies.emplace_back();
  body.name = "load";
  body.mass = 0.1;
  body.pose = InitialPose{-aside, 0, half + 0.05, 0, 0, 0};
  ShapeDesc& box = body.shapes.emplace_back();
  box.type = ShapeType::box;
  box.size = 2 * half * Vector3::Ones();
  ObstacleDesc& floor = scene.obstacles.emplace_back();
  floor.name = "floor";
  floor.type = ShapeType::plane;
  return scene;
}

/// The hand goes on by 0.3 m at 0.5 m/s when the box stands.
TEST(PressedColumns, RopeGivesWayWhenTheBodyItLowersStands) {
  for (const double time_step : {1e-3, 2e-3, 5e-3})
    for (const double bending_stiffness : {0.0, 1e-3})
      for (const double aside : {0.0, 1e-9, 1e-6, 1e-4}) {
        SCOPED_TRACE(std::to_string(time_step) + " " + std::to_string(bending_stiffness) + " " + std::to_string(aside));
        const SceneDesc scene = body_above_a_floor(time_step, bending_stiffness, aside);
        const double start = scene.cables[0].initial.from.z();
        BoundaryInputs inputs = scenes::hand_at({0, 0, start});
        inputs.resize(frame_names(scene).size());
        World world(scene, inputs);
        double work = 0, force = 0, fastest = 0;
        for (int i = 1; i * time_step < 2; ++i) {
          inputs[1].pose.position.z() = start - std::min(0.35, 0.5 * time_step * i);
          ASSERT_EQ(world.step(inputs).status, Status::ok) << "step " << i;
          // It pushes down only until the rope has left its line; to stop all that moves, 0.13 kg, takes 0.065 N s.
          if (i * time_step > 0.05) force = std::max(force, world.attachments()[0].force.z() * time_step);
          fastest = std::max(fastest, world.bodies()[0].velocity.norm());
          work = world.ledger().balance.work.attachments;
        }
        EXPECT_LT(force, 0.3) << "[N s] in a step";
        EXPECT_LT(fastest, 1) << "[m/s]";
        // Weight does 0.1 J until the box stands. What is left aside by the bow that the step needs is drawn in again.
        EXPECT_LT(std::abs(world.ledger().unaccounted()), 0.05) << "[J]; it was 2.1 kJ";
        EXPECT_LT(std::abs(work), 1) << "[J]";
        EXPECT_NEAR(world.bodies()[0].pose.position.z(), 0.025, 1e-3);
        EXPECT_LT(std::abs(world.cables()[0].state.tension.front()), 1) << "[N] the hand carries what hangs from it";
      }
}

}  // namespace
}  // namespace verlet_cable
