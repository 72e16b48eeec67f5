#include "publish/wrench_means.h"

#include <gtest/gtest.h>

#include "../support/scenes.h"

namespace verlet_cable {
namespace {

TEST(WrenchMeans, AreOverTheStepsSinceTheLastTick) {
  const SceneDesc scene = scenes::released(10, 1.0);
  World world(scene, initial_frames(scene));
  WrenchMeans means;
  for (int tick = 0; tick < 3; ++tick) {
    Vector3 sum = Vector3::Zero();
    for (int i = 0; i < 7; ++i) {
      world.step(initial_frames(scene));
      means.add(world);
      sum += world.attachments()[0].force;
    }
    // Shown twice: paused, it is the last one again.
    for (int again = 0; again < 2; ++again) {
      EXPECT_LT((means.mean(world.attachments()[0]).force - sum / 7).norm(), 1e-12);
      EXPECT_GT((world.attachments()[0].force - sum / 7).norm(), 1e-6);
      means.end_tick();
    }
  }
  means.forget();
  EXPECT_EQ(means.mean(world.attachments()[0]).force, world.attachments()[0].force);
}

TEST(WrenchMeans, FollowAttachmentsThatComeAndGo) {
  const SceneDesc scene = scenes::between_two_points(10, 0.6);
  World world(scene, initial_frames(scene));
  WrenchMeans means;
  world.step(initial_frames(scene));
  means.add(world);
  const Vector3 right = world.attachments()[1].force;
  ASSERT_TRUE(world.apply(edit::Unpin{"left"}).ok);
  world.step(initial_frames(scene));
  means.add(world);
  ASSERT_EQ(world.attachments()[0].name, "right");
  EXPECT_LT((means.mean(world.attachments()[0]).force - 0.5 * (right + world.attachments()[0].force)).norm(), 1e-12);
}

}  // namespace
}  // namespace verlet_cable
