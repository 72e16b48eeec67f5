#include <gtest/gtest.h>

#include <cmath>

#include "../support/scenes.h"

// What holds bodies: settling, frames that jump, pins, things that their cables touch, and what cannot be.

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

/// A load of 1 kg, 0.2 m beside its hook, on a rope of 0.5 m from the frame "hand".
SceneDesc load_on_a_rope() {
  SceneDesc scene = scenes::one_cable(20, 0.5);
  scene.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 0}, "hand"),
                                 scenes::attachment("hook", PlaceDesc::At::end, {0.2, 0, 0})};
  scene.cables[0].attachments[0].initial_pose = InitialPose{};
  scene.cables[0].attachments[1].body = "load";
  BodyDesc& load = scene.bodies.emplace_back();
  load.name = "load";
  load.mass = 1;
  load.inertia = Vector3(0.01, 0.02, 0.015);
  load.pose = InitialPose{0.1, 0, -0.3, 0, 0, 0};
  return scene;
}

/// The load without a rope: a frame holds it 0.1 m above its center.
SceneDesc held_load(AttachmentType type) {
  SceneDesc scene = load_on_a_rope();
  scene.cables.clear();
  scene.bodies[0].pose = InitialPose{0, 0, -0.1, 0, 0, 0};
  BodyAttachmentDesc& grip = scene.bodies[0].attachments.emplace_back();
  grip.name = "grip";
  grip.frame = "hand";
  grip.type = type;
  grip.at = {0, 0, 0.1, 0, 0, 0};
  grip.initial_pose = InitialPose{};
  return scene;
}

double speed(const World& world) {
  return world.bodies()[0].velocity.norm() + world.bodies()[0].angular_velocity.norm();
}

TEST(HeldBodies, SettleWithWhatTheyHangOn) {
  SceneDesc scene = load_on_a_rope();
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, scenes::hand_at({0, 0, 0}));
  EXPECT_TRUE(world.findings().unsettled.empty());
  // The hook is straight above the center of mass.
  EXPECT_NEAR((world.bodies()[0].pose.position - Vector3(0, 0, -0.7)).norm(), 0, 1e-9);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(world.step(scenes::hand_at({0, 0, 0})).status, Status::ok);
  EXPECT_LT(speed(world), 1e-9);
  const double weight = 9.81 * (1 + 0.1 * 0.5);
  EXPECT_NEAR(world.attachments()[0].force.z(), -weight, 1e-6 * weight);
}

TEST(HeldBodies, WaitForTheCablesThatTheyHangOn) {
  SceneDesc scene = load_on_a_rope();
  scene.cables[0].attachments[0].initial_pose.reset();
  BoundaryInputs inputs = scenes::hand_at({0, 0, 0});
  inputs[1].known = false;
  World world(scene, inputs);
  for (int i = 0; i < 100; ++i) world.step(inputs);
  EXPECT_TRUE(world.cables().empty());
  EXPECT_EQ(world.bodies()[0].velocity.norm(), 0);
  EXPECT_EQ((world.bodies()[0].pose.position - Vector3(0.1, 0, -0.3)).norm(), 0);
  inputs[1].known = true;
  EXPECT_EQ(world.start_waiting(inputs), 1);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(world.step(inputs).status, Status::ok);
  EXPECT_GT(speed(world), 0.1);
}

TEST(HeldBodies, ARopeTooShortForItsBodyIsAnError) {
  SceneDesc scene = load_on_a_rope();
  EXPECT_TRUE(validate(scene).empty());
  scene.bodies[0].pose = InitialPose{0.4, 0, -0.3, 0, 0, 0};
  const std::vector<std::string> errors = validate(scene);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].rfind("cables[0].length: ", 0), 0u) << errors[0];
}

/// What does not bend has its clamps hold the segments beside them: those leave less of it for the way between.
TEST(HeldBodies, ARopeTooShortForItsClampIsAnError) {
  SceneDesc scene = load_on_a_rope();
  AttachmentDesc& hook = scene.cables[0].attachments[1];
  hook.type = AttachmentType::clamp;
  hook.offset.setZero();
  scene.bodies[0].pose = InitialPose{0, 0, -0.5, 0, 0, 0};
  hook.rotation = {0, M_PI / 2, 0};  // downwards, as the rope comes
  EXPECT_TRUE(validate(scene).empty());
  hook.rotation = {0, M_PI / 2 + 0.7, 0};
  const std::vector<std::string> errors = validate(scene);
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].rfind("cables[0].length: 0.5 m of cable between \"top\" and \"hook\"; allowed: at least 0.506", 0), 0u)
      << errors[0];
  scene.bodies[0].pose = InitialPose{0, 0, -0.49, 0, 0, 0};
  EXPECT_TRUE(validate(scene).empty());
}

TEST(HeldBodies, FollowHandsThatJump) {
  for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp, AttachmentType::axle}) {
    const SceneDesc scene = held_load(type);
    World world(scene, scenes::hand_at({0, 0, 0}));
    for (int i = 0; i < 100; ++i) world.step(scenes::hand_at({0, 0, 0}));
    int jumps = 0;
    for (int i = 0; i < 100; ++i) {
      world.step(scenes::hand_at({0.1, 0, 0}));
      jumps += static_cast<int>(world.findings().jumps.size());
    }
    EXPECT_EQ(jumps, 1);
    EXPECT_LT(speed(world), 1e-9);
    EXPECT_NEAR((world.bodies()[0].pose.position - Vector3(0.1, 0, -0.1)).norm(), 0, 1e-9);
  }
}

TEST(HeldBodies, AreCarriedByCablesWhoseHandJumps) {
  SceneDesc scene = load_on_a_rope();
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, scenes::hand_at({0, 0, 0}));
  for (int i = 0; i < 200; ++i) world.step(scenes::hand_at({i < 100 ? 0 : 0.1, 0, 0}));
  EXPECT_LT(speed(world), 1e-9);
  EXPECT_NEAR((world.bodies()[0].pose.position - Vector3(0.1, 0, -0.7)).norm(), 0, 1e-9);
}

TEST(HeldBodies, MoveWithTheHandThatClampsThem) {
  const SceneDesc scene = held_load(AttachmentType::clamp);
  World world(scene, scenes::hand_at({0, 0, 0}));
  const auto hand = [](double t) -> Vector3 { return {0.2 * (1 - std::cos(6 * t)), 0, 0}; };
  for (int i = 1; i <= 700; ++i) {
    world.step(scenes::hand_at(hand(0.001 * i)));
    const SimulatedBody& body = world.bodies()[0];
    ASSERT_LT((body.pose.position - Vector3(0, 0, -0.1) - hand(0.001 * i)).norm(), 1e-8) << i;
    // Second order in the time step, without ringing.
    ASSERT_NEAR(body.velocity.x(), 1.2 * std::sin(6 * 0.001 * i), i < 5 ? 0.01 : 2e-4) << i;
  }
}

TEST(HeldBodies, CanBePinnedAndLetGo) {
  World world(load_on_a_rope(), scenes::hand_at({0, 0, 0}));
  edit::Pin pin;
  pin.name = "pin";
  pin.body = rigid_body_id(0);
  pin.pose.position = {0.3, 0, -0.2};
  ASSERT_TRUE(world.apply(pin).ok);
  EXPECT_FALSE(world.apply(pin).ok);
  for (int i = 0; i < 1500; ++i) ASSERT_EQ(world.step(scenes::hand_at({0, 0, 0})).status, Status::ok);
  EXPECT_NEAR((world.bodies()[0].pose.position - pin.pose.position).norm(), 0, 1e-8);
  ASSERT_TRUE(world.apply(edit::Unpin{"pin"}).ok);
  for (int i = 0; i < 100; ++i) ASSERT_EQ(world.step(scenes::hand_at({0, 0, 0})).status, Status::ok);
  EXPECT_GT((world.bodies()[0].pose.position - pin.pose.position).norm(), 0.01);
  pin.node = 1;
  EXPECT_FALSE(world.apply(pin).ok);
  pin.body = rigid_body_id(1);
  EXPECT_FALSE(world.apply(pin).ok);
}

TEST(HeldBodies, TakeNodesThatArePinnedToThem) {
  World world(load_on_a_rope(), scenes::hand_at({0, 0, 0}));
  edit::Pin pin;
  pin.name = "pin";
  pin.body = cable_id(0);
  pin.node = 12;
  pin.frame = world.bodies()[0].frame;
  pin.pose.position = {0.1, 0.1, 0};
  ASSERT_TRUE(world.apply(pin).ok);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(world.step(scenes::hand_at({0, 0, 0})).status, Status::ok) << i;
  const Vector3 there = (world.bodies()[0].pose * pin.pose).position;
  EXPECT_NEAR((world.cables()[0].state.positions[12] - there).norm(), 0, 1e-9);
  EXPECT_TRUE(world.apply(edit::Unpin{"pin"}).ok);
  pin.type = AttachmentType::clamp;
  EXPECT_FALSE(world.apply(pin).ok);
}

TEST(HeldBodies, TheirCablesTouchTheFloor) {
  SceneDesc scene = load_on_a_rope();
  scene.cables[0].length = 1.2;
  scene.cables[0].segments = 40;
  scene.bodies[0].pose = InitialPose{0.5, 0, 0.3, 0, 0, 0};
  scene.bodies[0].attachments = held_load(AttachmentType::hinge).bodies[0].attachments;
  ObstacleDesc floor;
  floor.name = "floor";
  scene.obstacles.push_back(floor);
  BoundaryInputs inputs = scenes::hand_at({0, 0, 0.4});
  World world(scene, inputs);
  // It starts below the floor, is pushed out, and then no longer inside.
  for (int i = 0; i < 1000; ++i) ASSERT_LE(world.step(inputs).status, Status::inside_obstacle) << i;
  for (int i = 0; i < 1000; ++i) ASSERT_LE(world.step(inputs).status, Status::overstretched) << i;
  EXPECT_FALSE(world.findings().contacts.empty());
  for (const Vector3& position : world.cables()[0].state.positions) EXPECT_GT(position.z(), 0.004);
}

TEST(HeldBodies, JunctionsAndGuidesAreRefused) {
  SceneDesc scene = load_on_a_rope();
  JunctionDesc& junction = scene.junctions.emplace_back();
  junction.name = "y";
  junction.cable = "cable";
  junction.place = {PlaceDesc::At::arc_length, 0.2};
  EXPECT_THROW(World{scene}, SceneError);
}

}  // namespace
}  // namespace verlet_cable
