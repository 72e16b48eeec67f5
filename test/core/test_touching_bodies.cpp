#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../support/meshes.h"
#include "../support/scenes.h"
#include "verlet_cable/core/world_stepper.h"

// Bodies whose shapes touch obstacles and cables.

namespace verlet_cable {
namespace {

constexpr double gravity = 9.81;

ShapeDesc box(const Vector3& size) {
  ShapeDesc desc;
  desc.type = ShapeType::box;
  desc.size = size;
  return desc;
}

ShapeDesc round_shape(ShapeType type, double radius, double length = 0) {
  ShapeDesc desc;
  desc.type = type;
  desc.radius = radius;
  desc.length = length;
  return desc;
}

ObstacleDesc obstacle(const std::string& name, const ShapeDesc& shape, const InitialPose& pose = {}) {
  ObstacleDesc desc;
  static_cast<ShapeDesc&>(desc) = shape;
  desc.name = name;
  desc.pose = pose;
  return desc;
}

BodyDesc& add_body(SceneDesc& scene, const std::string& name, double mass, const ShapeDesc& shape, const InitialPose& pose) {
  BodyDesc& body = scene.bodies.emplace_back();
  body.name = name;
  body.mass = mass;
  body.shapes = {shape};
  body.pose = pose;
  return body;
}

SceneDesc on_floor() {
  SceneDesc scene = scenes::one_cable(20);
  scene.cables.clear();
  scene.obstacles = {obstacle("floor", ShapeDesc{})};
  return scene;
}

/// Falls straight down along x.
CableDesc& add_cable(SceneDesc& scene, const std::string& name, const Vector3& middle) {
  CableDesc& cable = scene.cables.emplace_back();
  cable.name = name;
  cable.length = 1;
  cable.segments = 30;
  cable.material = "rope";
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {middle - Vector3(0.5, 0, 0), middle + Vector3(0.5, 0, 0)};
  return cable;
}

/// A cable falls over a box that stands on the floor.
SceneDesc draped_box() {
  SceneDesc scene = on_floor();
  add_body(scene, "box", 2, box({0.2, 0.2, 0.2}), {0, 0, 0.101, 0, 0, 0.2});
  add_cable(scene, "cable", {0.02, 0.01, 0.23});
  return scene;
}

void run(World& world, const BoundaryInputs& inputs, double duration) {
  for (long i = std::lround(duration / world.time_step()); i > 0; --i)
    ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << world.time();
}

double largest_speed(const SimulatedBody& body) {
  return std::max(body.velocity.norm(), 0.1 * body.angular_velocity.norm());
}

double weight_on(const World& world, int body) {
  double weight = 0;
  for (const SimulatedContact& contact : world.findings().contacts)
    if (contact.body == body) weight += contact.force.z();
  return weight;
}

/// Walls around a hole of 18 mm by 14 mm along x, from x = 0 to 0.05 m.
std::vector<ObstacleDesc> hole() {
  const Vector3 level(0.05, 0.038, 0.009), upright(0.05, 0.01, 0.014);
  return {obstacle("sill", box(level), {0.025, 0, -0.0115, 0, 0, 0}), obstacle("lintel", box(level), {0.025, 0, 0.0115, 0, 0, 0}),
          obstacle("left", box(upright), {0.025, 0.014, 0, 0, 0, 0}),
          obstacle("right", box(upright), {0.025, -0.014, 0, 0, 0, 0})};
}

/// What passes without touching is not felt, however far it goes in a step, be it the plug that moves or the hole.
TEST(TouchingBodies, FlyThroughAHoleUntouched) {
  ShapeDesc pin = round_shape(ShapeType::capsule, 0.0055, 0.03);
  pin.pose = InitialPose{0, 0, 0, 0, M_PI / 2, 0};
  for (const ShapeDesc& shape : {box({0.05, 0.014, 0.01}), round_shape(ShapeType::sphere, 0.0055), pin})
    for (const double step : {0.001, 0.003, 0.01})
      for (const double speed : {0.05, 0.6, 3.0})
        for (const bool hole_moves : {false, true}) {
          SCOPED_TRACE(testing::Message() << static_cast<int>(shape.type) << " " << step << " s, " << speed << " m/s "
                                          << hole_moves);
          SceneDesc scene = on_floor();
          scene.gravity.acceleration = Vector3::Zero();
          scene.time_step = step;
          scene.obstacles = hole();
          for (ObstacleDesc& wall : scene.obstacles) wall.frame = "walls";
          BodyDesc& plug = add_body(scene, "plug", 0.02, shape, {-0.05, 0, 0, 0, 0, 0});
          const Vector3 velocity = hole_moves ? Vector3::Zero() : Vector3(speed, 0, 0);
          plug.velocity = velocity;
          const auto walls_at = [&](double time) {
            BoundaryInputs inputs(2);
            inputs[1].pose.position.x() = hole_moves ? -speed * time : 0;
            return inputs;
          };
          World world(scene, walls_at(0));
          for (int i = 1; i * step < 0.15 / speed; ++i) world.step(walls_at(i * step));
          EXPECT_NEAR((world.bodies()[0].velocity - velocity).norm(), 0, 1e-12);
          EXPECT_NEAR(world.bodies()[0].angular_velocity.norm(), 0, 1e-9);
        }
}

/// Every shape comes to rest on every other one that can carry it, in place.
TEST(TouchingBodies, RestOnObstaclesOfAllShapes) {
  ShapeDesc mesh;
  mesh.type = ShapeType::mesh;
  mesh.mesh = box_triangles({0.3, 0.3, 0.1}).mesh();
  const ShapeDesc small_box = box({0.1, 0.1, 0.06});
  struct Case {
    std::string name;
    ObstacleDesc below;
    ShapeDesc shape;
    InitialPose pose;
    double height;  ///< [m] at rest
  };
  const ObstacleDesc table = obstacle("table", box({0.3, 0.3, 0.1}));
  for (const Case& c : {
           Case{"box on a box", table, small_box, {0.02, 0, 0.081, 0, 0, 0.3}, 0.08},
           Case{"box that overhangs", table, small_box, {0.13, 0, 0.081, 0, 0, 0}, 0.08},
           Case{
               "large box on a small one", obstacle("block", small_box), box({0.3, 0.3, 0.1}), {0.02, 0, 0.081, 0, 0, 0.3}, 0.08},
           Case{"box on a mesh", obstacle("mesh", mesh), small_box, {0, 0, 0.081, 0, 0, 0}, 0.08},
           Case{"mesh on a box", obstacle("table", box({0.5, 0.5, 0.1})), mesh, {0, 0, 0.101, 0, 0, 0}, 0.1},
           Case{"cylinder that stands", table, round_shape(ShapeType::cylinder, 0.05, 0.06), {0, 0, 0.081, 0, 0, 0}, 0.08},
           Case{"box on a cylinder",
                obstacle("post", round_shape(ShapeType::cylinder, 0.05, 0.06)),
                small_box,
                {0, 0, 0.061, 0, 0, 0},
                0.06},
           Case{"box on a sphere",
                obstacle("ball", round_shape(ShapeType::sphere, 0.1)),
                box({0.2, 0.2, 0.02}),
                {0, 0, 0.111, 0, 0, 0},
                0.11},
           Case{"box on a lying cylinder",
                obstacle("log", round_shape(ShapeType::cylinder, 0.1, 0.3), {0, 0, 0, 0, M_PI / 2, 0}),
                box({0.2, 0.2, 0.02}),
                {0, 0, 0.111, 0, 0, 0},
                0.11},
           Case{"box on a lying capsule",
                obstacle("log", round_shape(ShapeType::capsule, 0.1, 0.3), {0, 0, 0, 0, M_PI / 2, 0}),
                box({0.2, 0.2, 0.02}),
                {0, 0, 0.111, 0, 0, 0},
                0.11},
           Case{"capsule across a box",
                obstacle("beam", box({0.1, 1, 0.1})),
                round_shape(ShapeType::capsule, 0.04, 0.3),
                {0, 0, 0.091, 0, M_PI / 2, 0},
                0.09},
       }) {
    SCOPED_TRACE(c.name);
    SceneDesc scene = on_floor();
    scene.obstacles = {c.below};
    add_body(scene, "body", 1, c.shape, c.pose);
    const BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    run(world, inputs, 1);
    const SimulatedBody& body = world.bodies()[0];
    const double size = c.height;
    EXPECT_NEAR(body.pose.position.z(), c.height, 2e-3 * size);
    EXPECT_LT(largest_speed(body), 1e-3);
    EXPECT_LT(std::hypot(body.pose.position.x() - c.pose[0], body.pose.position.y() - c.pose[1]), 2e-3 * size);
  }
}

TEST(TouchingBodies, CarryACableThatIsDrapedOverThem) {
  const SceneDesc scene = draped_box();
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  run(world, inputs, 3);
  EXPECT_LT(largest_speed(world.bodies()[0]), 1e-3);
  double on_box = weight_on(world, 0), on_floor = 0;
  for (const SimulatedContact& contact : world.findings().contacts)
    if (contact.obstacle == 0) on_floor += contact.force.z();
  EXPECT_GT(on_box, 0.2 * 0.1 * gravity);
  EXPECT_NEAR(on_box + on_floor, 0.1 * gravity, 0.05 * 0.1 * gravity);
}

/// What it holds inside of its shape does not press on that.
TEST(TouchingBodies, LetOutTheCableThatTheyHoldInside) {
  SceneDesc scene = on_floor();
  add_body(scene, "box", 1, box({0.3, 0.3, 0.3}), {0, 0, 1, 0, 0, 0});
  CableDesc& cable = add_cable(scene, "cable", {0, 0, 0});
  cable.initial.points = {{0, 0, 2}, {0, 0, 1}};
  cable.attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 2}),
                       scenes::attachment("hook", PlaceDesc::At::end, Vector3::Zero())};
  cable.attachments[1].body = "box";
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  run(world, inputs, 1);
  EXPECT_TRUE(world.findings().contacts.empty());
  EXPECT_LT(largest_speed(world.bodies()[0]), 1e-6);
}

/// The holder wins, at forces that a step can take back.
TEST(TouchingBodies, AreHeldInsideObstaclesByClampsAtBoundedForces) {
  SceneDesc scene = on_floor();
  BodyDesc& plug = add_body(scene, "plug", 0.05, box({0.02, 0.02, 0.04}), {0, 0, 0.05, 0, 0, 0});
  BodyAttachmentDesc& grip = plug.attachments.emplace_back();
  grip.name = "grip";
  grip.frame = "hand";
  grip.type = AttachmentType::clamp;
  grip.initial_pose = InitialPose{0, 0, 0.05, 0, 0, 0};
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  double largest = 0;
  for (int i = 0; i < 1200; ++i) {
    const double t = 0.001 * (i + 1);
    inputs[1].pose.position.z() = 0.05 - 0.06 * std::sin(M_PI / 1.2 * t);
    ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << t;
    EXPECT_NEAR(world.bodies()[0].pose.position.z(), inputs[1].pose.position.z(), 1e-6);
    largest = std::max(largest, world.attachments()[0].force.norm());
  }
  EXPECT_GT(largest, 10);
  EXPECT_LT(largest, 1e5);
  EXPECT_LT(std::abs(world.attachments()[0].force.z() + 0.05 * gravity), 1);
}

/// Whatever corners and edges are on the other side of a board, they come out on that of the middle, and rest: the board does no
/// work on what stays. While they are inside they say so.
TEST(TouchingBodies, ComeOutOfThinBoardsOnTheSideOfTheirMiddle) {
  for (const double thickness : {0.004, 0.006, 0.01})
    for (const double height : {-0.001, 0.001, 0.003})
      for (const double tilt : {0.0, 0.25}) {
        SCOPED_TRACE(testing::Message() << thickness << " m, " << height << " m, " << tilt);
        SceneDesc scene = on_floor();
        scene.time_step = 0.002;
        const Vector3 up(std::sin(tilt), 0, std::cos(tilt)), middle = -0.5 * thickness * up, start = height * up;
        ObstacleDesc board = obstacle("board", box({0.4, 0.4, thickness}), {middle.x(), 0, middle.z(), 0, tilt, 0});
        board.friction = 0.6;
        scene.obstacles = {board};
        add_body(scene, "plug", 0.009, box({0.03, 0.016, 0.01}), {start.x(), 0, start.z(), 0, tilt + 0.3, 0});
        const BoundaryInputs inputs = initial_frames(scene);
        World world(scene, inputs);
        EXPECT_EQ(world.step(inputs).status, StepResult::Status::inside_obstacle);
        ASSERT_EQ(world.findings().body_intrusions.size(), 1u);
        EXPECT_EQ(world.findings().body_intrusions[0].body, 0);
        EXPECT_EQ(world.obstacles()[world.findings().body_intrusions[0].obstacle].name, "board");
        EXPECT_GT(world.findings().body_intrusions[0].depth, 0);
        for (int i = 0; i < 500; ++i) EXPECT_LE(world.step(inputs).status, StepResult::Status::inside_obstacle);
        const double lost = world.ledger().balance.dissipated.contact;
        for (int i = 0; i < 250; ++i) ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok) << i;
        EXPECT_TRUE(world.findings().body_intrusions.empty());
        EXPECT_NEAR(world.bodies()[0].pose.position.dot(up), 0.005, 2e-5);
        EXPECT_LT(largest_speed(world.bodies()[0]), 1e-6);
        EXPECT_NEAR(world.ledger().balance.dissipated.contact, lost, 1e-9);
      }
}

TEST(TouchingBodies, CopiesGoOnWithTheSameBytes) {
  SceneDesc scene = draped_box();
  scene.obstacles[0].pose = {0, 0, 0, 0, 0.1, 0};  // it sticks
  (*scene.bodies[0].pose)[2] = 0.112;
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  run(world, inputs, 0.3);
  World copy = world;
  run(world, inputs, 0.3);
  run(copy, inputs, 0.3);
  EXPECT_EQ(world.hash(), copy.hash());
}

/// Neither what stands on the same floor nor what falls elsewhere.
TEST(TouchingBodies, AreNotChangedByWhatIsFarAway) {
  const SceneDesc alone = draped_box();
  SceneDesc many = alone;
  add_body(many, "other", 0.3, round_shape(ShapeType::sphere, 0.05), {3, 0, 0.2, 0, 0, 0}).velocity = {1, 0, 0};
  add_cable(many, "other_cable", {3, 0, 0.4});
  const BoundaryInputs inputs = initial_frames(alone);
  World first(alone, inputs), second(many, inputs);
  for (int i = 0; i < 500; ++i) {
    ASSERT_EQ(first.step(inputs).status, StepResult::Status::ok);
    ASSERT_EQ(second.step(inputs).status, StepResult::Status::ok);
    ASSERT_EQ(first.bodies()[0].pose.position, second.bodies()[0].pose.position) << i;
    ASSERT_EQ(first.bodies()[0].pose.orientation.coeffs(), second.bodies()[0].pose.orientation.coeffs()) << i;
    ASSERT_EQ(first.cables()[0].state.positions, second.cables()[0].state.positions) << i;
  }
}

/// Whatever else the thread steps in between: a cable elsewhere on the floor, and another world, which has no bodies.
TEST(TouchingBodies, StickThoughOthersAreStepped) {
  SceneDesc alone = on_floor();
  alone.obstacles[0].pose = {0, 0, 0, 0, 0.1, 0};
  add_body(alone, "box", 2, box({0.2, 0.2, 0.2}), {0, 0, 0.101, 0, 0.1, 0});
  SceneDesc both = alone;
  add_cable(both, "cable", {0, 3, 0.1});
  SceneDesc cable_only = both;
  cable_only.bodies.clear();
  const BoundaryInputs inputs = initial_frames(alone);
  World first(alone, inputs), second(both, inputs), third(cable_only, inputs), expected(cable_only, inputs);
  std::vector<WorldStep> steps(2);
  steps[0].world = &second;
  steps[1].world = &third;
  for (WorldStep& step : steps) step.inputs = &inputs;
  WorldStepper stepper;
  for (int i = 0; i < 500; ++i) {
    first.step(inputs);
    expected.step(inputs);
    stepper.step(steps, false);
    ASSERT_EQ(first.bodies()[0].pose.position, second.bodies()[0].pose.position) << i;
    ASSERT_EQ(third.hash(), expected.hash()) << i;
  }
}

/// It is carried along by what moves: at mu g at most, then with it.
TEST(TouchingBodies, RideOnObstaclesThatMove) {
  SceneDesc scene = on_floor();
  scene.obstacles[0].frame = "belt";
  scene.obstacles[0].friction = 0.3;
  scene.obstacles[0].initial_pose = InitialPose{};
  add_body(scene, "box", 1, box({0.2, 0.2, 0.05}), {0, 0, 0.025, 0, 0, 0});
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  run(world, inputs, 0.1);
  for (int i = 0; i < 1000; ++i) {
    inputs[1].pose.position.x() += 1e-3;
    ASSERT_EQ(world.step(inputs).status, StepResult::Status::ok);
    if (i == 199) EXPECT_NEAR(world.bodies()[0].velocity.x(), 0.2 * 0.3 * gravity, 0.01);
  }
  EXPECT_NEAR(world.bodies()[0].velocity.x(), 1, 1e-4);
}

}  // namespace
}  // namespace verlet_cable
