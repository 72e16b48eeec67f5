#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <string>

#include "../support/scenes.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

/// [s] of processor time, the least of some.
template <class Call>
double least_time(const Call& call) {
  double least = 1e9;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();
    for (int k = 0; k < 20; ++k) call(20 * i + k);
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

/// Beside a robot, whose links are looked through for what an obstacle belongs to.
TEST(ManyObstacles, OneMoreDoesNotLookAtAllTheOthers) {
  SceneDesc scene = scenes::one_cable(4, 0.3);
  scene.robot = RobotDesc{};
  scene.robot->tree.resize(200);
  for (std::size_t link = 0; link < scene.robot->tree.size(); ++link) {
    scene.robot->tree[link].name = "link" + std::to_string(link);
    scene.robot->tree[link].parent = static_cast<int>(link) - 1;
  }
  World world(scene);
  Obstacle ball;
  ball.shape = SphereShape{0.1};
  ball.frame = world.add_frame("hand", Pose{});
  const auto set = [&](int i) {
    ball.name = "ball" + std::to_string(i);
    ASSERT_TRUE(world.apply(edit::SetObstacle{ball}).ok);
  };
  for (int i = 0; i < 5000; ++i) set(i);
  // Which looks through all names, as it must.
  const double refused = least_time([&](int) { ASSERT_FALSE(world.apply(edit::RemoveObstacle{"none"}).ok); });
  const double added = least_time([&](int i) { set(5000 + i); });
  EXPECT_LT(added, 15 * refused);
}

}  // namespace
}  // namespace verlet_cable
