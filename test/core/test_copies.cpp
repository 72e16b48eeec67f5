#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "../support/nets.h"
#include "../support/scenes.h"
#include "target/kinematic_targets.h"

// Copies of worlds, and obstacles of nets, in every order.

namespace verlet_cable {
namespace {

ObstacleDesc obstacle(const std::string& name, ShapeType type, const InitialPose& pose) {
  ObstacleDesc desc;
  desc.name = name;
  desc.type = type;
  desc.pose = pose;
  desc.radius = 0.15;
  desc.length = 0.2;
  desc.size = {0.4, 0.4, 0.2};
  desc.friction = 0.4;
  return desc;
}

/// A free sheet above a floor, a block and a ball.
SceneDesc falling_sheet(LinkType type) {
  SceneDesc scene;
  NetDesc sheet = scenes::grid(6, 6, 0.08, type);
  sheet.grid->origin = {-0.2, -0.2, 0.12};
  sheet.grid->x_axis = {1, 0, 0};
  sheet.grid->y_axis = {0, 1, 0};
  scene.nets = {sheet};
  scene.obstacles = {obstacle("floor", ShapeType::plane, {0, 0, 0, 0, 0, 0}),
                     obstacle("slope", ShapeType::plane, {0.3, 0, 0, 0, -0.5, 0}),
                     obstacle("ball", ShapeType::sphere, {0, 0, -0.05, 0, 0, 0})};
  return scene;
}

double lowest(const World& world) {
  double z = infinity;
  for (const Vector3& x : world.nets()[0].state.positions) z = std::min(z, x.z());
  return z;
}

TEST(Copies, NetsKeepTheirContacts) {
  for (const LinkType type : {LinkType::spring, LinkType::limited, LinkType::rigid}) {
    const SceneDesc scene = falling_sheet(type);
    World world(scene, initial_frames(scene));
    scenes::run(world, 50);
    World copy = world;
    World assigned(scene, initial_frames(scene));
    assigned = world;
    for (int i = 0; i < 15; ++i) {
      scenes::run(world, 20);
      scenes::run(copy, 20);
      scenes::run(assigned, 20);
      ASSERT_EQ(world.hash(), copy.hash()) << i;
      ASSERT_EQ(world.hash(), assigned.hash()) << i;
      copy = World(copy);
    }
    EXPECT_GT(lowest(world), -1e-3);
  }
}

TEST(Copies, NetStaysOutOfEveryObstacleInAnyOrder) {
  for (const LinkType type : {LinkType::limited, LinkType::rigid}) {
    SceneDesc scene = falling_sheet(type);
    std::array<int, 3> order{0, 1, 2};
    do {
      SceneDesc ordered = scene;
      for (int i = 0; i < 3; ++i) ordered.obstacles[i] = scene.obstacles[order[i]];
      World world(ordered, initial_frames(ordered));
      scenes::run(world, 800);
      for (const Vector3& x : world.nets()[0].state.positions) {
        EXPECT_GT(x.z(), -1e-3);
        EXPECT_GT((x - Vector3(0, 0, -0.05)).norm(), 0.15 - 1e-3);
        EXPECT_GT((x - Vector3(0.3, 0, 0)).dot(quaternion_from_rpy({0, -0.5, 0}) * Vector3::UnitZ()), -1e-3);
      }
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(Copies, AreAssignedToWorldsThatHaveBeenMovedFrom) {
  const SceneDesc scene = scenes::between_two_points(10, 0.6);
  World world(scene, initial_frames(scene));
  World moved_from = world;
  const World other = std::move(moved_from);
  moved_from = world;
  EXPECT_EQ(moved_from.hash(), other.hash());
  EXPECT_EQ(moved_from.step({FrameInput{}}).status, StepResult::Status::ok);
}

TEST(Copies, GoOnAsTheirOriginalWhenRadiiAreTuned) {
  SceneDesc scene = scenes::one_cable(50);
  scene.contact = ContactDesc{};
  scene.gravity.acceleration.setZero();
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  World world(scene, initial_frames(scene));
  scenes::run(world, 5);
  scene.materials[0].material.radius = 0.025;
  world.tune(scene);
  World copy = world;
  for (int i = 0; i < 5; ++i) {
    scenes::run(world, 1);
    scenes::run(copy, 1);
    ASSERT_EQ(world.hash(), copy.hash()) << i;
    ASSERT_EQ(world.findings().contacts.size(), copy.findings().contacts.size()) << i;
  }
}

/// A cable slides through an eyelet, and bends sharply there: segments are long enough on one side of it to let those next to
/// them touch, and then too short.
TEST(Copies, GoOnAsTheirOriginalWhereGuidesChangeLengths) {
  SceneDesc scene = scenes::one_cable(40, 0.5);
  scene.contact = ContactDesc{};
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{0, 0, -0.25}, {0, 0, 0}, {0.004, 0, 0}, {0.004, 0, -0.246}};
  scene.cables[0].point_masses = {scenes::payload(0.02)};
  GuideDesc& eyelet = scene.guides.emplace_back();
  eyelet.name = "eyelet";
  eyelet.cable = "cable";
  eyelet.place = PlaceDesc{PlaceDesc::At::arc_length, 0.25};
  World world(scene, initial_frames(scene));
  std::size_t touching_steps = 0;
  for (int i = 0; i < 300; ++i) {
    World copy = world;
    scenes::run(world, 1);
    scenes::run(copy, 1);
    ASSERT_EQ(world.hash(), copy.hash()) << i;
    touching_steps += world.findings().contacts.empty() ? 0 : 1;
  }
  EXPECT_GT(touching_steps, 0u);
}

/// What a copy's workspace has not seen must not be in the loads of what finds no solution.
TEST(Copies, HoldersBeginEachSubstepWithoutLoads) {
  KinematicTargets targets;
  targets.nodes.resize(1);
  targets.directions.resize(1);
  Boundary used;
  used.nodes.resize(2);
  used.directions.resize(2);
  used.nodes[0].force = used.directions[0].torque = {1, 2, 3};
  hold_at(0, 1, targets, used);
  EXPECT_EQ(used.nodes[0].force, Vector3::Zero());
  EXPECT_EQ(used.directions[0].torque, Vector3::Zero());
}

/// A stiff cable from a clamp to a hinge.
SceneDesc clamped_cable() {
  SceneDesc scene = scenes::between_two_points(20, 0.5);
  scene.materials[0].material.bending_stiffness = 0.01;
  scene.cables[0].attachments[0].type = AttachmentType::clamp;
  return scene;
}

/// A body that a hinge holds beside its center, and a cable.
SceneDesc cable_to_a_held_body() {
  SceneDesc scene = clamped_cable();
  scene.cables[0].attachments[1].offset.setZero();
  scene.cables[0].attachments[1].body = "load";
  BodyDesc& load = scene.bodies.emplace_back();
  load.name = "load";
  load.mass = 1;
  load.inertia = Vector3(0.01, 0.02, 0.015);
  load.pose = InitialPose{0.5, 0, 0, 0, 0, 0};
  BodyAttachmentDesc& grip = load.attachments.emplace_back();
  grip.name = "grip";
  grip.offset = {0.5, 0, 0.1};
  grip.at = {0, 0, 0.1, 0, 0, 0};
  return scene;
}

TEST(Copies, SettleAsTheirOriginalWhereThereIsNoEquilibrium) {
  for (const SceneDesc& scene : {clamped_cable(), cable_to_a_held_body()}) {
    World world(scene, initial_frames(scene));
    world.settle();
    ASSERT_TRUE(world.apply(edit::MoveAttachment{"left", Pose{{-2, 0, 0}, Quaternion(0, 0, 0, 1)}}).ok);
    World copy = world;
    EXPECT_FALSE(world.settle());
    EXPECT_FALSE(copy.settle());
    EXPECT_EQ(world.hash(), copy.hash());
    // What is read of attachments is of this call, or nothing.
    for (const Attachment& attachment : world.attachments()) EXPECT_EQ(attachment.force.norm(), 0) << attachment.name;
  }
}

/// A cable that lies on a slope, and a block that friction holds there: they have nothing to do with each other.
SceneDesc block_beside_a_cable() {
  SceneDesc scene = scenes::one_cable(5, 0.5);
  scene.cables[0].attachments.clear();
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {0, 3, 0.01};
  scene.cables[0].initial.to = {0, 4, 0.01};
  BodyDesc block;
  block.name = "block";
  block.mass = 0.5;
  block.pose = InitialPose{0, 0, 0.05, 0, 0.2, 0};
  block.shapes.resize(1);
  block.shapes[0].type = ShapeType::box;
  block.shapes[0].size = {0.1, 0.1, 0.1};
  scene.bodies = {block};
  scene.obstacles = {obstacle("slope", ShapeType::plane, {0, 0, 0, 0, 0.2, 0})};
  return scene;
}

TEST(Copies, BodiesBesideCablesKeepTheirFriction) {
  const SceneDesc scene = block_beside_a_cable();
  World world(scene, initial_frames(scene));
  scenes::run(world, 100);
  const Vector3 before = world.bodies()[0].pose.position;
  for (int i = 0; i < 20; ++i) {
    World copy = world;
    scenes::run(world, 20);
    scenes::run(copy, 20);
    ASSERT_EQ(world.hash(), copy.hash()) << i;
  }
  EXPECT_LT((world.bodies()[0].pose.position - before).norm(), 1e-4);
}

TEST(Copies, PinOnACableLeavesANetOnItsFloor) {
  for (const LinkType type : {LinkType::limited, LinkType::rigid}) {
    SceneDesc scene = falling_sheet(type);
    const SceneDesc rope = scenes::between_two_points(20, 0.5);
    scene.cables = rope.cables;
    scene.materials = rope.materials;
    for (AttachmentDesc& attachment : scene.cables[0].attachments) attachment.offset.z() = 2;
    World live(scene, initial_frames(scene));
    scenes::run(live, 500);
    // As the node does: edits are tried on a copy, which then takes the world's place.
    World tried = live;
    ASSERT_TRUE(
        tried.apply(edit::Pin{"", cable_id(0), 10, 0, Pose{{0.2, 0, 1.8}, Quaternion::Identity()}, AttachmentType::hinge}).ok);
    live = std::move(tried);
    scenes::run(live, 1000);
    EXPECT_GT(lowest(live), -1e-3);
  }
}

TEST(Copies, NetOnAPlateThatMovesGoesUpWithIt) {
  for (const LinkType type : {LinkType::limited, LinkType::rigid}) {
    SceneDesc scene = falling_sheet(type);
    scene.obstacles[1] = obstacle("plate", ShapeType::box, {0, 0, -0.1, 0, 0, 0});
    scene.obstacles[1].size = {2, 2, 0.2};
    scene.obstacles[1].frame = "lift";
    BoundaryInputs inputs(2);
    World world(scene, inputs);
    for (int i = 0; i < 500; ++i) world.step(inputs);
    World copy = world;
    for (int i = 0; i < 500; ++i) {
      inputs[1].pose.position.z() = 6e-4 * i;
      world.step(inputs);
      copy.step(inputs);
    }
    EXPECT_EQ(world.hash(), copy.hash());
    EXPECT_GT(lowest(world), 0.29);
  }
}

}  // namespace
}  // namespace verlet_cable
