#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "../support/scenes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

/// Short cables whose ends follow frames, and that touch each other.
SceneDesc tangle(int cables, int segments) {
  SceneDesc scene = scenes::one_cable(segments, 0.3);
  scene.time_step = 0.005;
  scene.materials[0].material.bending_stiffness = 1e-3;
  scene.contact = ContactDesc{};
  const CableDesc first = scene.cables[0];
  scene.cables.clear();
  for (int k = 0; k < cables; ++k) {
    CableDesc cable = first;
    cable.name += std::to_string(k);
    cable.attachments = {scenes::attachment(cable.name + "_start", PlaceDesc::At::start, {0, 0, 0}, cable.name + "_from"),
                         scenes::attachment(cable.name + "_end", PlaceDesc::At::end, {0, 0, 0}, cable.name + "_to")};
    scene.cables.push_back(cable);
  }
  return scene;
}

/// Frames that are somewhere else at every step.
class Shaking {
 public:
  explicit Shaking(int frames) : inputs_(1 + frames) {}
  const BoundaryInputs& next() {
    std::uniform_real_distribution<double> place(-0.05, 0.05);
    for (std::size_t f = 1; f < inputs_.size(); ++f)
      for (int axis = 0; axis < 3; ++axis) inputs_[f].pose.position[axis] = place(random_);
    return inputs_;
  }

 private:
  std::mt19937 random_{7};
  BoundaryInputs inputs_;
};

TEST(StepBudget, StepThatTakesTooMuchWorkGoesOnFromRestInOnePiece) {
  const SceneDesc scene = tangle(4, 12);
  Shaking shaking(8);
  World world(scene, shaking.next());
  int exhausted = 0;
  for (int i = 0; i < 100; ++i) {
    const StepResult result = world.step(shaking.next());
    exhausted += result.exhausted;
    if (result.exhausted) {
      EXPECT_EQ(result.status, Status::degraded);
      // On its way there, it may not have converged, which is told first.
      EXPECT_TRUE(result.cause == DegradedCause::too_much_work || result.cause == DegradedCause::no_solution);
    }
    // With contacts each iteration visits its 12 segments at a cost of 6; it may end one attempt late.
    EXPECT_LT(result.iterations * 6 * 12, 8e5) << "step " << i;
    for (const SimulatedCable& cable : world.cables())
      for (const Vector3& position : cable.state.positions) ASSERT_TRUE(position.allFinite()) << "step " << i;
  }
  EXPECT_GT(exhausted, 20);
  // The hands stop; so does what is told.
  BoundaryInputs still = shaking.next();
  StepResult last;
  for (int i = 0; i < 400; ++i) last = world.step(still);
  EXPECT_FALSE(last.exhausted);
}

TEST(StepBudget, IsTheSameForCopiesAndOnEveryNumberOfCores) {
  const SceneDesc scene = tangle(10, 12);
  Shaking shaking(20);
  World world(scene, shaking.next());
  world.step(shaking.next());
  World copy = world;
  copy.step_one_by_one(true);
  int exhausted = 0;
  for (int i = 0; i < 10; ++i) {
    const BoundaryInputs inputs = shaking.next();
    exhausted += world.step(inputs).exhausted;
    copy.step(inputs);
    ASSERT_EQ(world.hash(), copy.hash()) << "step " << i;
  }
  EXPECT_GT(exhausted, 0);
}

/// A cable that needs more than its first share, but not all that there is for such.
TEST(StepBudget, CablesThatAreCalmLeaveAllOfItToTheOneThatIsNot) {
  SceneDesc alone = scenes::held_by_a_hand(40);
  alone.materials[0].material.bending_stiffness = 1e-2;
  alone.time_step = 0.04;
  SceneDesc accompanied = alone;
  for (int k = 0; k < 50; ++k) {
    CableDesc calm = alone.cables[0];
    calm.name = "calm" + std::to_string(k);
    calm.attachments = {scenes::attachment(calm.name + "_top", PlaceDesc::At::start, {10.0 + k, 0, 0})};
    accompanied.cables.push_back(calm);
  }
  const auto hand = [](int i) { return scenes::hand_at({0.5 + 0.25 * std::sin(0.9 * i), 0, 0.25 * std::sin(0.7 * i)}); };
  World world(alone, hand(0)), other(accompanied, hand(0));
  int most_iterations = 0;
  for (int i = 1; i < 200; ++i) {
    const StepResult result = world.step(hand(i));
    ASSERT_FALSE(result.exhausted) << "step " << i;
    most_iterations = std::max(most_iterations, result.iterations);
    ASSERT_FALSE(other.step(hand(i)).exhausted) << "step " << i;
    ASSERT_EQ(world.cables()[0].state.positions, other.cables()[0].state.positions) << "step " << i;
    ASSERT_EQ(world.cables()[0].state.velocities, other.cables()[0].state.velocities) << "step " << i;
  }
  EXPECT_GT(most_iterations, 40 * 6) << "it was never resumed";
}

/// Frames that turn and leap at random leave a cable folded and many times as long, in a shape from which no step leads.
TEST(StepBudget, CableThatIsStuckHangsAnewWhenItsFramesComeToRest) {
  SceneDesc scene = scenes::held_by_a_hand(40, AttachmentType::clamp);
  scene.gravity.acceleration = Vector3::Zero();
  scene.materials[0].material.axial_stiffness = 1e4;
  scene.materials[0].material.bending_stiffness = 0.01;
  scene.cables[0].attachments[0].frame = "base";
  std::mt19937 random{2};
  std::normal_distribution<double> normal;
  const auto leap = [&](double x) {
    FrameInput input;
    for (int axis = 0; axis < 3; ++axis) input.pose.position[axis] = (axis == 0 ? x : 0) + 0.3 * normal(random);
    input.pose.orientation = Quaternion(normal(random), normal(random), normal(random), normal(random)).normalized();
    return input;
  };
  BoundaryInputs inputs(3);
  inputs[2].pose.position.x() = 0.8;
  const BoundaryInputs rest = inputs;
  World world(scene, rest);
  int degraded = 0;
  for (int i = 0; i < 200 && degraded < 16; ++i) {
    inputs = {rest[0], leap(0), leap(0.8)};
    degraded += world.step(inputs).status == Status::degraded;
  }
  StepResult last;
  for (int i = 0; i < 1000; ++i) last = world.step(rest);
  EXPECT_EQ(last.status, Status::ok);
  EXPECT_LT(last.max_strain, 0.01);
}

/// A free cable in which a box appears, so that its steps are given up one after the other.
TEST(StepBudget, LongFreeCableStaysWhereItIs) {
  constexpr double length = 40;
  SceneDesc scene = scenes::one_cable(4000, length);
  scene.time_step = 0.002;
  scene.materials[0].material.radius = 0.01;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {3, 2, 0.01};
  scene.cables[0].initial.to = {3, 2 + length, 0.01};
  ObstacleDesc floor;
  floor.name = "floor";
  floor.type = ShapeType::plane;
  scene.obstacles.push_back(floor);
  World world(scene, BoundaryInputs(1));
  Obstacle ball;
  ball.name = "ball";
  ball.shape = SphereShape{0.01};
  ball.pose.position = {3, 22, 0.03};
  ASSERT_TRUE(world.apply(edit::SetObstacle{ball}).ok);
  for (int i = 0; i < 5; ++i) world.step(BoundaryInputs(1));
  ball.shape = BoxShape{Vector3::Constant(0.01)};
  ball.pose.position.z() = 0.005;
  ASSERT_TRUE(world.apply(edit::SetObstacle{ball}).ok);
  int exhausted = 0;
  for (int i = 0; i < 12; ++i) {
    exhausted += world.step(BoundaryInputs(1)).exhausted;
    const std::vector<Vector3>& positions = world.cables()[0].state.positions;
    ASSERT_LT((positions.front() - Vector3(3, 2, 0.01)).norm(), 0.1) << "step " << i;
    ASSERT_LT((positions.back() - Vector3(3, 2 + length, 0.01)).norm(), 0.1) << "step " << i;
  }
  EXPECT_GT(exhausted, 0);
}

/// More than there is room for around a segment are in each other: the nearest are enough to get them apart.
TEST(StepBudget, CablesInOnePlaceTouchNoMoreThanTheNearest) {
  constexpr int cables = 60, segments = 20;
  SceneDesc scene = scenes::one_cable(segments);
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = Vector3::UnitX();
  scene.cables.resize(cables, scene.cables[0]);
  for (int k = 0; k < cables; ++k) scene.cables[k].name = "cable" + std::to_string(k);
  scene.contact = ContactDesc{};
  scene.contact->between_cables = true;
  World world(scene, BoundaryInputs(1));
  world.step(BoundaryInputs(1));
  const std::size_t touched = world.findings().contacts.size();
  EXPECT_GT(touched, static_cast<std::size_t>(cables * segments)) << "each touches others";
  EXPECT_LT(touched, static_cast<std::size_t>(30 * cables * segments));
  for (int i = 0; i < 20; ++i) EXPECT_NE(world.step(BoundaryInputs(1)).status, Status::fault);
}

/// Obstacles in one place, many times as many as a cable can touch.
TEST(StepBudget, CableInManyObstaclesTouchesNoMoreThanTheNearest) {
  constexpr int segments = 50, obstacles = 500;
  SceneDesc scene = scenes::one_cable(segments);
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = Vector3::UnitX();
  ObstacleDesc floor;
  floor.type = ShapeType::plane;
  for (int k = 0; k < obstacles; ++k) {
    floor.name = "floor" + std::to_string(k);
    // The last ones are the highest.
    floor.pose = {0, 0, -0.0051 + 1e-7 * k, 0, 0, 0};
    scene.obstacles.push_back(floor);
  }
  World world(scene, BoundaryInputs(1));
  for (int i = 0; i < 100; ++i) ASSERT_EQ(world.step(BoundaryInputs(1)).status, Status::ok);
  EXPECT_LT(world.findings().contacts.size(), static_cast<std::size_t>(16 * (2 * segments + 1)));
  // On all of them, or on the highest: 0.005 m above it.
  for (const Vector3& x : world.cables()[0].state.positions) EXPECT_NEAR(x.z(), -0.0051 + 1e-7 * obstacles + 0.005, 2e-4);
}

}  // namespace
}  // namespace verlet_cable
