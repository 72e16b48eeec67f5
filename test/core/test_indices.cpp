#include <gtest/gtest.h>

#include <algorithm>

#include "../support/scenes.h"

// Whatever a world names is there, in the world as it is after the step or the edit.

namespace verlet_cable {
namespace {

void expect_valid(const World& world, const StepResult& result) {
  const int cables = static_cast<int>(world.cables().size());
  const auto segments = [&](int cable) { return world.cables()[cable].state.segments(); };
  if (result.body.is_cable()) {
    ASSERT_LT(result.body.index, cables);
    EXPECT_LE(result.node, segments(result.body.index));
  }
  for (const Break& broken : world.findings().breaks) {
    ASSERT_LT(broken.cable, cables);
    ASSERT_LT(broken.new_cable, cables);
    EXPECT_NE(broken.cable, -1);
  }
  for (const Intrusion& intrusion : world.findings().intrusions) {
    ASSERT_GE(intrusion.cable, 0);
    ASSERT_LT(intrusion.cable, cables);
    EXPECT_GE(intrusion.segment, 0);
    EXPECT_LT(intrusion.segment, segments(intrusion.cable));
    EXPECT_LT(intrusion.obstacle, static_cast<int>(world.obstacles().size()));
  }
  for (const SimulatedContact& contact : world.findings().contacts) {
    ASSERT_LT(contact.cable, cables);
    EXPECT_LT(contact.segment, segments(contact.cable));
    EXPECT_LT(contact.obstacle, static_cast<int>(world.obstacles().size()));
    if (contact.other_cable < 0) continue;
    ASSERT_LT(contact.other_cable, cables);
    EXPECT_LT(contact.other_segment, segments(contact.other_cable));
  }
  for (const Attachment& attachment : world.attachments()) {
    ASSERT_TRUE(attachment.body.is_cable());
    ASSERT_LT(attachment.body.index, cables);
    EXPECT_LE(attachment.node, segments(attachment.body.index));
    EXPECT_LT(attachment.frame, static_cast<int>(world.frames().size()));
  }
}

ObstacleDesc block(const std::string& name, const InitialPose& pose, const Vector3& size) {
  ObstacleDesc desc;
  desc.name = name;
  desc.type = ShapeType::box;
  desc.pose = pose;
  desc.size = size;
  return desc;
}

/// Held at both ends, lying with its last third inside a block.
SceneDesc rope_in_a_block() {
  SceneDesc scene = scenes::held_by_a_hand(30);
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.materials[0].material.breaking_tension = 5;
  scene.obstacles = {block("wall", {5, 0, 0, 0, 0, 0}, {1, 1, 1}), block("block", {0.85, 0, 0, 0, 0, 0}, {0.2, 0.1, 0.1})};
  return scene;
}

TEST(Indices, BreakAndIntrusionInOneStep) {
  const SceneDesc scene = rope_in_a_block();
  World world(scene, scenes::hand_at({1, 0, 0}));
  ASSERT_EQ(find(world.cables(), "cable"), 0);
  const StepResult result = world.step(scenes::hand_at({1.03, 0, 0}));
  ASSERT_EQ(world.findings().breaks.size(), 1u);
  ASSERT_FALSE(world.findings().intrusions.empty());
  expect_valid(world, result);
  // The block is around the second piece: that is where it is found.
  EXPECT_EQ(world.findings().intrusions[0].obstacle, 1);
  const Intrusion& intrusion = world.findings().intrusions[0];
  const Vector3 place = world.cables()[intrusion.cable].state.positions[intrusion.segment];
  EXPECT_GT(place.x(), 0.7);
}

TEST(Indices, OverstretchedNodeOfTheSecondPiece) {
  SceneDesc scene = scenes::held_by_a_hand(30);
  scene.cables[0].attachments.push_back(scenes::attachment("middle", PlaceDesc::At::arc_length, {0.9, 0, 0}));
  scene.cables[0].attachments.back().place.arc_length = 0.9;
  scene.materials[0].material.breaking_tension = 50;
  World world(scene, scenes::hand_at({1, 0, 0}));
  StepResult result;
  for (int i = 0; i < 20 && world.findings().breaks.empty(); ++i) result = world.step(scenes::hand_at({1 + 0.002 * i, 0, 0}));
  ASSERT_EQ(world.findings().breaks.size(), 1u);
  expect_valid(world, result);
}

TEST(Indices, EditsBetweenSteps) {
  for (const bool reversed : {false, true}) {
    SceneDesc scene = rope_in_a_block();
    scene.materials[0].material.breaking_tension = infinity;
    scene.cables.insert(scene.cables.begin(), scenes::one_cable(10).cables[0]);
    scene.cables[0].name = "before";
    scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
    scene.cables[0].initial.from = {0, 1, 0};
    scene.cables[0].initial.to = {1, 1, 0};
    scene.cables.push_back(scene.cables[0]);
    scene.cables.back().name = "after";
    scene.cables.back().initial.from = {0.7, 0.04, 0};
    scene.cables.back().initial.to = {2, 0.04, 0};
    World world(scene, scenes::hand_at({1, 0, 0}));
    const BoundaryInputs inputs = scenes::hand_at({1, 0, 0});
    const StepResult none;
    StepResult result = world.step(inputs);
    ASSERT_GE(world.findings().intrusions.size(), 2u);
    expect_valid(world, result);
    ASSERT_TRUE(world.apply(edit::Cut{cable_id(1), 27}).ok);
    expect_valid(world, none);
    ASSERT_TRUE(world.apply(edit::Cut{cable_id(1), 20}).ok);
    expect_valid(world, none);
    ASSERT_TRUE(world.apply(edit::Join{2, reversed, 0, false}).ok);
    expect_valid(world, none);
    for (const Intrusion& intrusion : world.findings().intrusions) EXPECT_EQ(world.obstacles()[intrusion.obstacle].name, "block");
    ASSERT_TRUE(world.apply(edit::RemoveObstacle{"wall"}).ok);
    expect_valid(world, none);
    for (const Intrusion& intrusion : world.findings().intrusions) EXPECT_EQ(world.obstacles()[intrusion.obstacle].name, "block");
    ASSERT_TRUE(world.apply(edit::RemoveObstacle{"block"}).ok);
    EXPECT_TRUE(world.findings().intrusions.empty());
    for (int i = 0; i < 200; ++i) expect_valid(world, world.step(inputs));
  }
}

TEST(Indices, WinchThatReelsInDuringSteps) {
  SceneDesc scene = rope_in_a_block();
  scene.materials[0].material.breaking_tension = 3;
  scene.contact = ContactDesc{};
  World world(scene, scenes::hand_at({0.8, 0, 0}));
  ASSERT_TRUE(world.apply(edit::SetLength{0, true, 0.85, 0.5}).ok);
  for (int i = 0; i < 600; ++i) {
    expect_valid(world, world.step(scenes::hand_at({0.8 + 2e-4 * i, 0, 0.05 * std::sin(0.1 * i)})));
    if (i % 100 == 50) world.apply(edit::Cut{cable_id(0), world.cables()[0].state.segments() / 2});
  }
}

}  // namespace
}  // namespace verlet_cable
