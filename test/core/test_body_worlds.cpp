#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../support/scenes.h"

// Worlds with rigid bodies: copied, edited, driven by frames, elsewhere.

namespace verlet_cable {
namespace {

BodyDesc& add_body(SceneDesc& scene, const std::string& name, double mass, const InitialPose& pose) {
  BodyDesc& body = scene.bodies.emplace_back();
  body.name = name;
  body.mass = mass;
  body.inertia = mass * Vector3(0.001, 0.002, 0.0025);
  body.pose = pose;
  return body;
}

CableDesc& add_cable(SceneDesc& scene, const std::string& name, const Vector3& from, const Vector3& to) {
  CableDesc& cable = scene.cables.emplace_back();
  cable.name = name;
  cable.length = (to - from).norm();
  cable.segments = 10;
  cable.material = "rope";
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {from, to};
  return cable;
}

AttachmentDesc on_body(const std::string& name, PlaceDesc::At at, const std::string& body, const Vector3& offset,
                       AttachmentType type = AttachmentType::hinge) {
  AttachmentDesc desc = scenes::attachment(name, at, offset, "", type);
  desc.body = body;
  return desc;
}

/// A load on a rope from the frame "hand", hooked beside its center.
SceneDesc hanging_load(AttachmentType type = AttachmentType::hinge) {
  SceneDesc scene = scenes::one_cable(1);
  scene.cables.clear();
  BodyDesc& load = add_body(scene, "load", 1, {0, 0, -0.6, 0, 0, 0});
  load.center_of_mass = Vector3(0, 0.01, 0);
  CableDesc& rope = add_cable(scene, "rope", {0, 0, 0}, {0, 0, -0.5});
  rope.attachments = {scenes::attachment("top", PlaceDesc::At::start, Vector3::Zero(), "hand"),
                      on_body("hook", PlaceDesc::At::end, "load", {0, 0, 0.1}, type)};
  rope.attachments[1].rotation = {0, M_PI / 2, 0};  // downwards
  rope.attachments[0].initial_pose = InitialPose{};
  if (type == AttachmentType::clamp) rope.attachments[1].rotation = {0, M_PI / 2, 0};  // downwards, as the rope comes
  return scene;
}

/// Besides that load, which swings: a link under it, a plug on a hose that is clamped on both sides, and a door on an axle.
SceneDesc many_bodies() {
  SceneDesc scene = hanging_load();
  scene.bodies[0].angular_velocity = {3, 0, 1};
  BodyDesc& link = add_body(scene, "link", 0.2, {0, 0, -0.8, 0, 0, 0});
  BodyAttachmentDesc& below = link.attachments.emplace_back();
  below.name = "below";
  below.body = "load";
  below.at = {0, 0, 0.1, 0, 0, 0};
  below.offset = {0, 0, -0.1};
  scene.materials.push_back({"hose", scene.materials[0].material});
  MaterialDesc& hose = scene.materials.back().material;
  hose.bending_stiffness = {0.02, 0.01};
  hose.torsional_stiffness = 0.015;
  add_body(scene, "plug", 0.05, {2.5, 0, 0, 0, 0, 0}).center_of_mass = Vector3(0.02, 0.01, 0);
  CableDesc& cable = add_cable(scene, "hose", {2, 0, 0}, {2.5, 0, 0});
  cable.material = "hose";
  cable.attachments = {scenes::attachment("wall", PlaceDesc::At::start, {2, 0, 0}, "", AttachmentType::clamp),
                       on_body("plugged", PlaceDesc::At::end, "plug", Vector3::Zero(), AttachmentType::clamp)};
  BodyDesc& door = add_body(scene, "door", 3, {4, 0, 0, 0, 0, 0});
  BodyAttachmentDesc& axle = door.attachments.emplace_back();
  axle.name = "axle";
  axle.type = AttachmentType::axle;
  axle.at = {-0.3, 0, 0, 0, 0, 0};
  axle.offset = {3.7, 0, 0};
  axle.rotation = {0.3, 0, 0};
  door.angular_velocity = {0, 0, 1};
  return scene;
}

void move_hand(const World& world, BoundaryInputs& inputs) {
  const double t = world.time() + world.time_step();
  inputs[1].pose.position = {0.1 * std::sin(4 * t), 0.05 * std::sin(7 * t), 0};
}

void run(World& world, BoundaryInputs& inputs, int steps) {
  for (int i = 0; i < steps; ++i) {
    move_hand(world, inputs);
    ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << world.time();
  }
}

TEST(BodyWorlds, CopiesGoOnWithTheSameBytes) {
  const SceneDesc scene = many_bodies();
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  run(world, inputs, 300);
  World copy = world;
  World assigned(scene, inputs);
  assigned = world;
  const World snapshot = world;
  BoundaryInputs of_copy = inputs, of_assigned = inputs;
  for (int i = 0; i < 10; ++i) {
    run(world, inputs, 50);
    run(copy, of_copy, 50);
    run(assigned, of_assigned, 50);
    ASSERT_EQ(world.hash(), copy.hash()) << i;
    ASSERT_EQ(world.hash(), assigned.hash()) << i;
    copy = World(copy);
  }
  World again = snapshot;
  run(again, of_copy, 500);
  EXPECT_EQ(again.hash(), world.hash());
}

TEST(BodyWorlds, ThreadsChangeNoByte) {
  SceneDesc scene = many_bodies();
  for (int i = 0; i < 30; ++i) {
    const std::string number = std::to_string(i);
    const double x = 10 + i;
    add_body(scene, "weight" + number, 0.1 + 0.01 * i, {x + 0.5, 0, 0, 0, 0, 0}).angular_velocity = {0, 0, 1};
    CableDesc& rope = add_cable(scene, "rope" + number, {x, 0, 0}, {x + 0.4, 0, 0});
    rope.attachments = {scenes::attachment("top" + number, PlaceDesc::At::start, {x, 0, 0}),
                        on_body("hook" + number, PlaceDesc::At::end, "weight" + number, {-0.1, 0, 0})};
  }
  BoundaryInputs inputs = initial_frames(scene);
  World parallel(scene, inputs), one_by_one(scene, inputs);
  one_by_one.step_one_by_one(true);
  BoundaryInputs others = inputs;
  run(parallel, inputs, 200);
  run(one_by_one, others, 200);
  EXPECT_EQ(parallel.hash(), one_by_one.hash());
}

TEST(BodyWorlds, GoOnFarFromTheOrigin) {
  std::vector<Vector3> places;
  for (const double far : {0.0, 1e4}) {
    SceneDesc scene = hanging_load();
    scene.bodies[0].angular_velocity = {3, 0, 1};
    (*scene.bodies[0].pose)[0] += far;
    (*scene.cables[0].attachments[0].initial_pose)[0] += far;
    for (Vector3& point : scene.cables[0].initial.points) point.x() += far;
    BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << far << ", " << world.time();
    places.push_back(world.bodies()[0].pose.position - Vector3(far, 0, 0));
  }
  EXPECT_LT((places[1] - places[0]).norm(), 1e-5);
}

TEST(BodyWorlds, ACutRopeLetsItsLoadFall) {
  for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp}) {
    SceneDesc scene = hanging_load(type);
    scene.bodies[0].center_of_mass = Vector3::Zero();
    BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    for (int i = 0; i < 100; ++i) world.step(inputs);
    const double height = world.bodies()[0].pose.position.z(), speed = world.bodies()[0].velocity.z();
    edit::Cut cut;
    cut.body = cable_id(0);
    cut.element = 4;
    ASSERT_TRUE(world.apply(cut).ok);
    ASSERT_EQ(world.cables().size(), 2u);
    for (int i = 0; i < 500; ++i) ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok);
    // The piece on it falls as fast.
    EXPECT_NEAR(world.bodies()[0].pose.position.z(), height + 0.5 * speed - 0.5 * 9.81 * 0.25, 1e-6);
    EXPECT_NEAR(world.bodies()[0].velocity.z(), speed - 9.81 * 0.5, 1e-6);
    EXPECT_LT(world.attachments()[find(world.attachments(), "hook")].force.norm(), 1e-4);
  }
}

TEST(BodyWorlds, AWinchLiftsALoad) {
  for (const bool at_end : {false, true}) {
    SceneDesc scene = hanging_load();
    scene.bodies[0].center_of_mass = Vector3::Zero();
    BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    edit::SetLength winch;
    winch.at_end = at_end;
    for (const double length : {0.2, 0.7}) {
      winch.length = length;
      winch.speed = 0.3;
      ASSERT_TRUE(world.apply(winch).ok);
      for (int i = 0; i < 3000; ++i) ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << world.time();
      EXPECT_NEAR(world.bodies()[0].pose.position.z(), -length - 0.1, 1e-4) << at_end;
    }
  }
}

/// Two links in line in the middle of a rope that is as long as its hinges are far apart.
SceneDesc links_in_line(double mass) {
  SceneDesc scene = scenes::one_cable(12, 0.6);
  CableDesc& rope = scene.cables[0];
  rope.initial.type = InitialShapeDesc::Type::points;
  rope.initial.points = {{0, 0, 0}, {0.6, 0, 0}};
  rope.attachments = {scenes::attachment("left", PlaceDesc::At::start, Vector3::Zero()),
                      scenes::attachment("right", PlaceDesc::At::end, Vector3::Zero(), "hand")};
  rope.attachments[1].initial_pose = InitialPose{0.6, 0, 0, 0, 0, 0};
  for (const int number : {1, 2}) {
    const std::string name = "link" + std::to_string(number);
    const double along = 0.2 * number;
    add_body(scene, name, mass, {along, 0, 0, 0, 0, 0});
    AttachmentDesc through = on_body("through" + std::to_string(number), PlaceDesc::At::arc_length, name, Vector3::Zero());
    through.place.arc_length = along;
    rope.attachments.push_back(through);
  }
  return scene;
}

TEST(BodyWorlds, LinksInLineBetweenTwoHingesStayThereUntilTheyCanGiveWay) {
  for (const double mass : {1e-3, 0.5}) {
    const SceneDesc scene = links_in_line(mass);
    BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    for (int i = 0; i < 300; ++i) ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << mass << " " << world.time();
    // The rope strains by a part in ten million.
    for (const SimulatedBody& body : world.bodies()) EXPECT_LT(std::abs(body.pose.position.z()), 1e-3) << mass;
    for (int i = 0; i < 500; ++i) {
      inputs[1].pose.position.x() = 0.6 - 1e-4 * i;
      ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << mass << " " << world.time();
    }
    for (const SimulatedBody& body : world.bodies()) EXPECT_LT(body.pose.position.z(), -0.02) << mass;
  }
}

/// About the origin [kg m^2/s].
Vector3 angular_momentum(const World& world) {
  Vector3 sum = Vector3::Zero();
  for (const SimulatedBody& body : world.bodies()) {
    const Eigen::Matrix3d axes = body.pose.orientation.toRotationMatrix();
    sum += body.mass * (body.pose * Pose{body.center_of_mass}).position.cross(body.velocity) +
           axes * body.inertia * axes.transpose() * body.angular_velocity;
  }
  // Nodes move with the bodies that hold them.
  for (const SimulatedCable& cable : world.cables())
    for (int i = 0; i < cable.state.nodes(); ++i)
      sum += cable.state.masses[i] * cable.state.positions[i].cross(cable.state.velocities[i]);
  return sum;
}

TEST(BodyWorlds, SubstepsThatDampKeepTheAngularMomentumOfWhatIsFree) {
  SceneDesc scene = scenes::one_cable(1);
  scene.gravity.acceleration.setZero();
  scene.time_step = 5e-3;
  scene.cables.clear();
  scene.materials[0].material.axial_stiffness = 1e5;
  add_body(scene, "left", 0.5, {0, 0, 0, 0, 0, 0}).velocity = Vector3(-0.5, 1, 0);
  add_body(scene, "right", 0.3, {0.6, 0, 0, 0, 0, 0}).velocity = Vector3(0.5, -1, 0.5);
  add_body(scene, "alone", 0.3, {5, 0, 0, 0, 0, 0}).angular_velocity = Vector3(1, 2, 3);
  CableDesc& rope = add_cable(scene, "rope", {0.05, 0, 0}, {0.55, 0, 0});
  rope.attachments = {on_body("start", PlaceDesc::At::start, "left", {0.05, 0, 0}),
                      on_body("end", PlaceDesc::At::end, "right", {-0.05, 0, 0})};
  World world(scene, {});
  world.step({});  // velocities become those that the rope allows
  const Vector3 before = angular_momentum(world);
  int damped = 0;
  for (int i = 0; i < 400; ++i) {
    ASSERT_EQ(world.step({}).status, StepResult::Status::ok) << world.time();
    damped += world.cables()[0].state.unresolved.damped > 0;
  }
  EXPECT_GT(damped, 0);
  EXPECT_LT((angular_momentum(world) - before).norm(), 1e-9 * before.norm());
}

TEST(BodyWorlds, WaitForTheFramesThatHoldThem) {
  SceneDesc scene = many_bodies();
  scene.cables[0].attachments[0].initial_pose.reset();
  scene.bodies[3].attachments[0].frame = "wall";
  scene.cables[0].initial.type = InitialShapeDesc::Type::automatic;
  scene.bodies[0].pose.reset();
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  EXPECT_EQ(world.findings().waiting, (std::vector<std::string>{"rope", "load", "link", "door"}));
  for (int i = 0; i < 100; ++i) world.step(inputs);
  const int hand = 1,
            wall = static_cast<int>(std::find(world.frames().begin(), world.frames().end(), "wall") - world.frames().begin());
  inputs.resize(world.frames().size());
  EXPECT_EQ(find(world.cables(), "rope"), -1);
  inputs[hand].known = inputs[wall].known = true;
  inputs[wall].pose.position = {0, 0, 1};
  world.start_waiting(inputs);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << world.time();
  EXPECT_GE(find(world.cables(), "rope"), 0);
  EXPECT_TRUE(world.findings().waiting.empty());
  for (const SimulatedBody& body : world.bodies()) EXPECT_TRUE(body.pose.position.allFinite());
}

}  // namespace
}  // namespace verlet_cable
