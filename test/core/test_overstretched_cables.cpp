#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "../support/scenes.h"

// Inextensible cables between frames that go further apart than they are long: springs of 1e4 times their weight per unit of
// strain, for as long as that lasts.

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

/// [N] Of the rope of 0.1 kg, per unit of strain.
constexpr double stiffness = 1e4 * 0.1 * 9.81;

/// A rope of 1 m from the origin to the hand, 0.7 m away, in air as thick as oil if nothing else is said, so that it does not
/// swing for long.
class DrawnRope {
 public:
  DrawnRope(double step, AttachmentType type, double drag = 0.5)
      : world_(scene(step, type, drag), scenes::hand_at({distance_, 0, 0})) {}

  /// At so many m/s; then it waits for a second.
  void draw_to(double distance, double speed) {
    const double start = distance_, way = distance - start, step = world_.time_step();
    const int steps = static_cast<int>(std::lround(std::abs(way) / speed / step));
    for (int i = 1; i <= steps + static_cast<int>(1 / step); ++i) {
      distance_ = start + way * std::min(1.0, static_cast<double>(i) / steps);
      last = world_.step(scenes::hand_at({distance_, 0, 0})).status;
      EXPECT_LE(last, Status::overstretched) << i;
      greatest = std::max(greatest, force());
    }
  }
  double force() const { return world_.attachments()[1].force.norm(); }
  const World& world() const { return world_; }

  Status last = Status::ok;
  double greatest = 0;  ///< [N] force on the hand

 private:
  static SceneDesc scene(double step, AttachmentType type, double drag) {
    SceneDesc scene = scenes::held_by_a_hand(30, type);
    scene.time_step = step;
    scene.materials[0].material.drag = drag;
    return scene;
  }
  double distance_ = 0.7;
  World world_;
};

class OverstretchedCables : public testing::TestWithParam<std::tuple<double, double, double, AttachmentType>> {};

TEST_P(OverstretchedCables, PullLikeSpringsAndHangAgain) {
  const auto [strain, speed, step, type] = GetParam();
  DrawnRope rope(step, type);
  rope.draw_to(0.99, speed);
  EXPECT_EQ(rope.last, Status::ok);
  EXPECT_LT(rope.force(), 0.1 * 9.81 * 4);  // twice the weight, and clamps
  rope.greatest = 0;                        // a hand that stops at once stops all that swings, too
  const double unaccounted = rope.world().ledger().unaccounted();
  rope.draw_to(1 + strain, speed);
  EXPECT_EQ(rope.last, Status::overstretched);
  // Beside what the hand's jerk leaves, which starts at once.
  EXPECT_NEAR(rope.world().ledger().unaccounted(), unaccounted, 3e-3 + 2e-4 * 0.5 * stiffness * strain * strain);
  // A clamp without bending stiffness holds a segment of the 30 at its length.
  const double free = type == AttachmentType::clamp ? 28.0 / 30 : 1;
  EXPECT_NEAR(rope.force(), stiffness * strain / free, 0.01 * stiffness * strain);
  EXPECT_LT(rope.greatest, 2 * stiffness * strain / free + 20);
  rope.draw_to(0.7, speed);
  EXPECT_EQ(rope.last, Status::ok);
  EXPECT_LT(rope.force(), 0.1 * 9.81);
  const CableState& state = rope.world().cables()[0].state;
  for (int i = 0; i < state.segments(); ++i)
    EXPECT_NEAR((state.positions[i + 1] - state.positions[i]).norm(), state.rest_lengths[i], 1e-6) << i;
}

INSTANTIATE_TEST_SUITE_P(Frames, OverstretchedCables,
                         testing::Combine(testing::Values(0.01, 0.05, 0.2), testing::Values(0.1, 2.0),
                                          testing::Values(0.0005, 0.004),
                                          testing::Values(AttachmentType::hinge, AttachmentType::clamp)));

/// A parabola of a sag f has a tension of m g L / (8 f) (Irvine, Cable Structures, section 2.1), and is shorter than the rope by
/// 8/3 f^2 / L: 20 times its weight, where it is shorter by 1e-4.
TEST(OverstretchedCables, AreNotStrainedBeforeTheyAreStraight) {
  DrawnRope rope(0.001, AttachmentType::hinge);
  for (int i = 0; i < 4; ++i) rope.draw_to(1 - 1e-4, 0.1);  // and waits until it does not swing any more
  EXPECT_EQ(rope.last, Status::ok);
  EXPECT_NEAR(rope.force(), 0.1 * 9.81 / 8 / std::sqrt(3.0 / 8 * 1e-4), 0.02 * 0.1 * 9.81 * 20);
  const CableState& state = rope.world().cables()[0].state;
  for (int i = 0; i < state.segments(); ++i)
    EXPECT_NEAR((state.positions[i + 1] - state.positions[i]).norm(), state.rest_lengths[i], 1e-6) << i;
}

/// A hand that comes at half a metre a second and stops short of where the rope is straight: what the rope has taken in while it
/// was about to be drawn straight it gives back, and no more.
TEST(OverstretchedCables, GiveBackWhatTheyHaveTaken) {
  for (const double step : {0.001, 0.002}) {
    DrawnRope rope(step, AttachmentType::hinge, 0.0);
    rope.draw_to(0.999, 0.5);
    EXPECT_EQ(rope.last, Status::ok);
    const Ledger ledger = rope.world().ledger();
    EXPECT_GT(ledger.balance.dissipated.edits, -2e-3) << step;
    EXPECT_NEAR(ledger.unaccounted(), 0, 1e-6) << step;
  }
}

/// Between clamps that are turned by 45 degrees, and drawn apart by 1 % more than the cable is long: when they come back to its
/// length, it is still bent, and longer than they are apart. It comes back as slowly as they do.
TEST(OverstretchedCables, ThatAreBentComeBackWithTheirClamps) {
  for (const double speed : {0.01, 0.1}) {
    SceneDesc scene = scenes::held_by_a_hand(20, AttachmentType::clamp);
    scene.materials[0].material.bending_stiffness = BendingStiffness(0.02);
    scene.materials[0].material.bending_damping = 1e-3;
    scene.materials[0].material.drag = 0.05;
    const double length = scene.cables[0].length;
    for (AttachmentDesc& attachment : scene.cables[0].attachments) attachment.rotation = {0, -M_PI / 4, 0};
    World world(scene, scenes::hand_at({0.9 * length, 0, 0}));
    const int steps = static_cast<int>(std::lround(0.11 * length / speed / scene.time_step));
    double fastest = 0;
    bool was_overstretched = false;
    for (int i = 1; i <= 2 * steps; ++i) {
      const double way = 0.11 * length * (i <= steps ? i : 2 * steps - i) / steps;
      was_overstretched |= world.step(scenes::hand_at({0.9 * length + way, 0, 0})).status == Status::overstretched;
      if (i <= steps) continue;
      for (const Vector3& velocity : world.cables()[0].state.velocities) fastest = std::max(fastest, velocity.norm());
    }
    EXPECT_TRUE(was_overstretched);
    EXPECT_LT(fastest, 1) << speed;  // before: 4 m/s at 0.01 m/s, 18 m/s at 0.1 m/s
    const double weight = scene.materials[0].material.linear_density * length * 9.81;
    EXPECT_NEAR(world.ledger().unaccounted(), 0, 0.01 * weight * length)
        << speed;  // before: 40 to 140 times its weight times its length
  }
}

}  // namespace
}  // namespace verlet_cable
