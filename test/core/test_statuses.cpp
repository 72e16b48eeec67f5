// What steps say that their forces are worth, of each cable and body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "../support/scenes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

bool has(const World& world, const BodyId& body, Status status) {
  const std::vector<StatusFinding>& all = world.findings().statuses;
  return std::any_of(all.begin(), all.end(), [&](const StatusFinding& f) { return f.body == body && f.status == status; });
}

/// A rope that is clamped at a height, as if it stood out of a wall there, straight down through what is below.
SceneDesc hanging_rope(double height, double length = 1.0) {
  SceneDesc scene = scenes::one_cable(40, length);
  scene.time_step = 0.005;
  scene.materials[0].material.linear_density = 0.05;
  scene.cables[0].attachments = {scenes::attachment("hand", PlaceDesc::At::start, {0, 0, height})};
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {0, 0, height};
  scene.cables[0].initial.to = {0, 0, height - length};
  return scene;
}

void add_obstacle(ShapeType type, const InitialPose& pose, SceneDesc& scene) {
  ObstacleDesc& obstacle = scene.obstacles.emplace_back();
  obstacle.name = "table";
  obstacle.type = type;
  obstacle.pose = pose;
  obstacle.radius = 0.3;
  obstacle.length = 0.6;
  obstacle.size = {0.8, 0.6, 0.5};
  obstacle.friction = 0.2;
}

/// Whether any node is deeper below the surface of the scene's obstacle than half the rope's radius.
bool is_inside(const World& world) {
  const Obstacle& obstacle = world.obstacles().front();
  const Pose pose = world.frame_pose(obstacle.frame) * obstacle.pose;
  const std::vector<Vector3>& nodes = world.cables()[0].state.positions;
  return std::any_of(nodes.begin(), nodes.end(), [&](const Vector3& node) {
    return closest_point(obstacle.shape, pose.orientation.conjugate() * (node - pose.position)).distance < 0;
  });
}

/// In every step in which the rope begins inside, until it is out, it is said.
void expect_said_while_inside(const SceneDesc& scene) {
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  ASSERT_TRUE(is_inside(world));
  for (int i = 0; i < 100; ++i) {
    const bool inside = is_inside(world);
    const StepResult result = world.step(inputs);
    if (!inside) continue;
    ASSERT_TRUE(has(world, cable_id(0), Status::inside_obstacle)) << i;
    ASSERT_GE(result.status, Status::inside_obstacle) << i;
  }
}

TEST(Statuses, aRopeThroughAPlaneIsSaidInEveryStep) {
  for (const double height : {0.2, 0.6, 0.9})
    for (const double friction : {0.0, 0.5}) {
      SceneDesc scene = hanging_rope(height);
      add_obstacle(ShapeType::plane, {}, scene);
      scene.obstacles[0].friction = friction;
      expect_said_while_inside(scene);
    }
}

TEST(Statuses, aRopeThroughASolidIsSaidInEveryStep) {
  for (const ShapeType type : {ShapeType::box, ShapeType::sphere, ShapeType::cylinder, ShapeType::capsule}) {
    SceneDesc scene = hanging_rope(0.6);
    add_obstacle(type, {0.05, 0.02, -0.1, 0.1, 0.2, 0}, scene);
    expect_said_while_inside(scene);
  }
}

TEST(Statuses, anElasticRopeIsSaidToo) {
  SceneDesc scene = hanging_rope(0.5);
  scene.materials[0].material.axial_stiffness = 100;
  add_obstacle(ShapeType::box, {0, 0, -0.1, 0, 0, 0}, scene);
  expect_said_while_inside(scene);
}

TEST(Statuses, ofSeveralCablesOnlyTheOneInsideIsSaid) {
  SceneDesc scene = hanging_rope(0.6);
  scene.cables.push_back(scene.cables[0]);
  scene.cables[1].name = "free";
  scene.cables[1].attachments[0].name = "other_hand";
  for (Vector3* point : {&scene.cables[1].attachments[0].offset, &scene.cables[1].initial.from, &scene.cables[1].initial.to})
    *point += Vector3(2, 0, 2);
  add_obstacle(ShapeType::plane, {}, scene);
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  world.step(inputs);
  EXPECT_TRUE(has(world, cable_id(0), Status::inside_obstacle));
  EXPECT_FALSE(has(world, cable_id(1), Status::inside_obstacle));
}

TEST(Statuses, whatLiesOnATableIsOk) {
  SceneDesc scene = scenes::one_cable(20, 0.5);
  scene.time_step = 0.005;
  const double radius = scene.materials[0].material.radius;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {0, 0, radius + 0.05};
  scene.cables[0].initial.to = {0.5, 0, radius + 0.05};
  add_obstacle(ShapeType::plane, {}, scene);
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(world.step(inputs).status, Status::ok) << i;
    ASSERT_TRUE(world.findings().statuses.empty()) << i;
  }
}

TEST(Statuses, anObstacleThatAppearsInARopeIsSaid) {
  const SceneDesc scene = hanging_rope(0.6);
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  ASSERT_EQ(world.step(inputs).status, Status::ok);
  edit::SetObstacle set;
  set.obstacle.name = "table";
  set.obstacle.shape = PlaneShape{};
  ASSERT_TRUE(world.apply(set).ok);
  for (int i = 0; i < 20; ++i) ASSERT_GE(world.step(inputs).status, Status::inside_obstacle) << i;
  ASSERT_TRUE(world.apply(edit::RemoveObstacle{"table"}).ok);
  EXPECT_EQ(world.step(inputs).status, Status::ok);
}

/// As the node has it: the frame of the second cable is seen later.
TEST(Statuses, aCableThatStartsLaterIsSaidFromItsFirstStepOn) {
  SceneDesc scene = hanging_rope(3.0);
  scene.cables.push_back(scene.cables[0]);
  scene.cables[1].name = "late";
  scene.cables[1].attachments[0] = scenes::attachment("late_hand", PlaceDesc::At::start, Vector3::Zero(), "hand");
  scene.cables[1].initial = {};
  scene.cables[1].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[1].initial.from = {1, 0, 0.4};
  scene.cables[1].initial.to = {1, 0, -0.6};
  add_obstacle(ShapeType::plane, {}, scene);
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  ASSERT_EQ(world.step(inputs).status, Status::ok);
  inputs[1] = {{Vector3(1, 0, 0.4), Quaternion::Identity()}, true};
  ASSERT_EQ(world.start_waiting(inputs), 1);
  world.step(inputs);
  EXPECT_FALSE(has(world, cable_id(0), Status::inside_obstacle));
  EXPECT_TRUE(has(world, cable_id(1), Status::inside_obstacle));
}

/// A cable that is inside keeps its status under the number that it has after a cut.
TEST(Statuses, editsKeepWhatTheyAreOf) {
  SceneDesc scene = hanging_rope(0.6);
  add_obstacle(ShapeType::plane, {}, scene);
  const BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  world.step(inputs);
  edit::Cut cut;
  cut.body = cable_id(0);
  cut.element = 10;
  ASSERT_TRUE(world.apply(cut).ok);
  EXPECT_FALSE(has(world, cable_id(0), Status::inside_obstacle));
  EXPECT_TRUE(has(world, cable_id(1), Status::inside_obstacle));
}

/// It finds no equilibrium to start from: around the ball it is further than the rope is long.
SceneDesc rope_through_a_ball() {
  SceneDesc scene = scenes::between_two_points(40, 0.98);
  ObstacleDesc& ball = scene.obstacles.emplace_back();
  ball.name = "ball";
  ball.type = ShapeType::sphere;
  ball.pose = {0.49, 0, 0, 0, 0, 0};
  ball.radius = 0.1;
  return scene;
}

TEST(Statuses, notSettledIsSaidFromTheStartUntilTheFirstStepIsDone) {
  const BoundaryInputs inputs(1);
  World world(rope_through_a_ball(), inputs);
  EXPECT_TRUE(has(world, cable_id(0), Status::not_settled));
  World copy = world;
  for (World* each : {&world, &copy}) {
    EXPECT_GE(each->step(inputs).status, Status::not_settled);
    EXPECT_TRUE(has(*each, cable_id(0), Status::not_settled));
    each->step(inputs);
    EXPECT_FALSE(has(*each, cable_id(0), Status::not_settled));
  }
}

TEST(Statuses, areRestoredWithAWorld) {
  const SceneDesc scene = rope_through_a_ball();
  const BoundaryInputs inputs(1);
  World world(scene, inputs);
  ASSERT_TRUE(has(world, cable_id(0), Status::not_settled));
  for (int i = 0; i < 3; ++i) {
    World restored(scene, inputs);
    restored.restore(world.save());
    EXPECT_EQ(restored.save(), world.save()) << i;
    const Findings &found = restored.findings(), &before = world.findings();
    EXPECT_EQ(found.unsettled, before.unsettled) << i;
    ASSERT_EQ(found.statuses.size(), before.statuses.size()) << i;
    for (std::size_t k = 0; k < found.statuses.size(); ++k) {
      EXPECT_EQ(found.statuses[k].status, before.statuses[k].status) << i;
      EXPECT_EQ(found.statuses[k].body, before.statuses[k].body) << i;
    }
    ASSERT_EQ(found.intrusions.size(), before.intrusions.size()) << i;
    World copy = world;
    EXPECT_EQ(restored.step(inputs).status, copy.step(inputs).status) << i;
    EXPECT_EQ(has(restored, cable_id(0), Status::not_settled), i == 0);
    world.step(inputs);
  }
}

TEST(Statuses, eachOfTwoOverstretchedCablesIsSaid) {
  SceneDesc scene = scenes::one_cable(10, 1.0);
  scene.cables[0].attachments = {scenes::attachment("a", PlaceDesc::At::start, {0, 0, 0}),
                                 scenes::attachment("b", PlaceDesc::At::end, {0, 0, 0}, "hand")};
  scene.cables.push_back(scene.cables[0]);
  scene.cables[1].name = "second";
  scene.cables[1].attachments[0].name = "c";
  scene.cables[1].attachments[1].name = "d";
  scene.cables[1].attachments[0].offset.y() = scene.cables[1].attachments[1].offset.y() = 1;
  BoundaryInputs inputs = scenes::hand_at({0.99, 0, 0});
  World world(scene, inputs);
  for (int i = 0; i < 200; ++i) {
    inputs[1].pose.position.x() += 2e-4;
    world.step(inputs);
  }
  for (const int cable : {0, 1}) EXPECT_TRUE(has(world, cable_id(cable), Status::overstretched)) << cable;
  for (const StatusFinding& found : world.findings().statuses) EXPECT_GT(found.max_strain, 0.01);
}

TEST(Statuses, areInTheOrderOfTheMessages) {
  EXPECT_LT(Status::ok, Status::jumped);
  EXPECT_EQ(static_cast<int>(Status::jumped), 1);
  EXPECT_EQ(static_cast<int>(Status::overstretched), 2);
  EXPECT_EQ(static_cast<int>(Status::inside_obstacle), 3);
  EXPECT_EQ(static_cast<int>(Status::not_settled), 4);
  EXPECT_EQ(static_cast<int>(Status::degraded), 5);
  EXPECT_EQ(static_cast<int>(Status::fault), 6);
}

}  // namespace
}  // namespace verlet_cable
