#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "../support/scenes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

constexpr double g = 9.81, friction = 0.5;

using Motion = std::function<Pose(double)>;

/// A rope that lies along x on a table, which follows the frame "table".
SceneDesc rope_on_a_table(ShapeType type, double time_step) {
  SceneDesc scene = scenes::one_cable(30, 0.3);
  scene.time_step = time_step;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.from = {0.1, 0, 0.005};
  scene.cables[0].initial.to = {0.4, 0, 0.005};
  ObstacleDesc table;
  table.name = table.frame = "table";
  table.type = type;
  table.size = {2, 2, 0.1};
  if (type == ShapeType::box) table.pose = {0, 0, -0.05, 0, 0, 0};
  table.friction = friction;
  scene.obstacles.push_back(table);
  return scene;
}

Pose about(const Vector3& axis, double angle) {
  return {Vector3::Zero(), Quaternion(Eigen::AngleAxisd(angle, axis.normalized()))};
}

/// [rad] Of a table that is turned ever faster for half a second, then at `speed` [rad/s].
double spun_up(double speed, double time) {
  return speed * (time < 0.5 ? time * time : time - 0.25);
}

/// How fast nodes move over the table, between two times [m/s].
double creep(const SceneDesc& scene, const Motion& motion, double from, double to) {
  BoundaryInputs frames = initial_frames(scene);
  frames[1].known = true;
  frames[1].pose = motion(0);
  World world(scene, frames);
  std::vector<Vector3> before;
  double furthest = 0;
  for (int i = 1; i * scene.time_step < to + 1e-9; ++i) {
    frames[1].pose = motion(i * scene.time_step);
    EXPECT_EQ(world.step(frames).status, StepResult::Status::ok);
    const Pose to_table = frames[1].pose.inverse();
    std::vector<Vector3> now;
    for (const Vector3& x : world.cables()[0].state.positions)
      now.push_back(to_table.position + to_table.orientation * x);
    if (world.time() < from) continue;
    if (before.empty()) before = now;
    for (std::size_t k = 0; k < now.size(); ++k) furthest = std::max(furthest, (now[k] - before[k]).norm());
  }
  return furthest / (to - from);
}

TEST(MovingObstacle, NothingCreepsOnATurntable) {
  for (const double time_step : {1e-3, 5e-3})
    for (const ShapeType type : {ShapeType::plane, ShapeType::box})
      for (const double speed : {0.5, 2.0, 3.0}) {  // the last one holds by 0.73 of friction
        const auto turned = [&](double t) { return about(Vector3::UnitZ(), spun_up(speed, t)); };
        EXPECT_LT(creep(rope_on_a_table(type, time_step), turned, 1.5, 6), 1e-8) << speed << " rad/s, step " << time_step;
      }
}

TEST(MovingObstacle, NothingCreepsOnATurntableAsideOfItsFrame) {
  for (const double time_step : {1e-3, 5e-3}) {
    const auto turned = [&](double t) {
      const double angle = spun_up(2, t);
      return Pose{{0.2 - 0.2 * std::cos(angle), -0.2 * std::sin(angle), 0}, about(Vector3::UnitZ(), angle).orientation};
    };
    EXPECT_LT(creep(rope_on_a_table(ShapeType::plane, time_step), turned, 1.5, 6), 1e-8) << "step " << time_step;
  }
}

TEST(MovingObstacle, FrictionThatTurnsAgainstTheTableOnlyBendsIt) {
  // Gravity pulls the rope to another side of the table at every time: what is left is that contacts give way to it, which are
  // stiff enough to stop a segment within a step.
  for (const double time_step : {1e-3, 5e-3}) {
    const auto tilted = [&](double t) {
      return Pose{Vector3::Zero(), about(Vector3::UnitX(), 0.2).orientation * about(Vector3::UnitZ(), spun_up(2, t)).orientation};
    };
    EXPECT_LT(4.5 * creep(rope_on_a_table(ShapeType::plane, time_step), tilted, 1.5, 6), g * time_step * time_step);
    const auto rocking = [&](double t) { return about(Vector3::UnitY(), 0.3 * std::sin(2 * t)); };
    EXPECT_LT(5 * creep(rope_on_a_table(ShapeType::plane, time_step), rocking, 1, 6), g * time_step * time_step);
  }
}

TEST(MovingObstacle, ConveyorPullsWithItsFrictionUntilTheRopeSticks) {
  const double speed = 1, time_step = 1e-3, time = speed / (friction * g);
  const SceneDesc scene = rope_on_a_table(ShapeType::plane, time_step);
  const auto conveyor = [&](double t) { return Pose{{speed * t, 0, 0}, Quaternion::Identity()}; };
  BoundaryInputs frames = initial_frames(scene);
  frames[1].known = true;
  World world(scene, frames);
  const int first = static_cast<int>(0.25 * time / time_step), last = static_cast<int>(0.9 * time / time_step);
  double before = 0;
  for (int i = 1; i <= last; ++i) {
    frames[1].pose = conveyor(i * time_step);
    world.step(frames);
    if (i == first) before = world.cables()[0].state.velocities[15].x();
  }
  const double acceleration = (world.cables()[0].state.velocities[15].x() - before) / ((last - first) * time_step);
  EXPECT_NEAR(acceleration, friction * g, 1e-4 * friction * g);
  EXPECT_LT(creep(scene, conveyor, 2 * time, 5), 1e-9);
}

TEST(MovingObstacle, ConveyorThatIsAcceleratedTakesTheRopeAlongUpToItsFriction) {
  for (const double time_step : {1e-3, 5e-3})
    for (const double part : {0.3, 0.9, 0.98}) {
      const auto conveyor = [&](double t) { return Pose{{0.5 * part * friction * g * t * t, 0, 0}, Quaternion::Identity()}; };
      EXPECT_LT(creep(rope_on_a_table(ShapeType::plane, time_step), conveyor, 0.5, 2), 1e-6) << part << ", step " << time_step;
    }
}

}  // namespace
}  // namespace verlet_cable
