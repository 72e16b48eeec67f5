#include "frames/frame_gap.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace verlet_cable {
namespace {

constexpr double rounding = 1e-14;

Pose pose(const Vector3& position, const Vector3& rpy) {
  return {position, quaternion_from_rpy(rpy)};
}

TEST(FrameGap, isWhatLiesBetweenTwoPoses) {
  const Pose frame = pose({1, 2, 3}, {0.3, -0.2, 2}), followed = pose({1, 2.3, 3.4}, {-1, 0.5, 0.1});
  const FrameGap gap = FrameGap::between(frame, followed);
  EXPECT_NEAR(gap.distance(), 0.5, rounding);
  EXPECT_NEAR((gap.followed(frame).position - followed.position).norm(), 0, rounding);
  EXPECT_NEAR((gap.followed(frame).orientation * followed.orientation.conjugate()).vec().norm(), 0, rounding);
  EXPECT_NEAR((gap.frame(followed).position - frame.position).norm(), 0, rounding);
  EXPECT_NEAR((gap.frame(followed).orientation * frame.orientation.conjugate()).vec().norm(), 0, rounding);
}

TEST(FrameGap, closesAtASteadyRateOnTopOfTheFramesOwnMotion) {
  constexpr double step = 1e-3, turn = 2e-3, own = 5e-4;
  Pose frame = pose({0, 0, 0}, {0, 0, 0});
  Pose followed = pose({0.3, 0, 0.4}, {0, 0, 3});
  FrameGap gap = FrameGap::between(frame, followed);
  int steps = 0;
  for (; !gap.is_closed() && steps < 10000; ++steps) {
    frame.position.y() += own;
    gap.close_by(step, turn);
    const Pose next = gap.followed(frame);
    ASSERT_LE((next.position - followed.position).norm(), std::hypot(step, own) + rounding) << steps;
    ASSERT_LE(rotation_vector(next.orientation * followed.orientation.conjugate()).norm(), turn + 1e-12) << steps;
    followed = next;
  }
  EXPECT_NEAR(steps, 3 / turn, 1.5);  // the turn takes longer than the way
  EXPECT_EQ(followed.position, frame.position);
  EXPECT_EQ(followed.orientation.coeffs(), frame.orientation.coeffs());
}

TEST(FrameGap, onlyGetsShorterWhereTheFrameGoesBackTooFast) {
  constexpr double step = 5e-4, speed = 320;
  const Vector3 held(0.1, 0, 0);
  Pose frame = pose({5, 0, 0}, {0, 0, 0});
  FrameGap gap = FrameGap::between(frame, {held, frame.orientation});
  // Past what it holds, too, until it stops behind it.
  while (frame.position.x() > 0) {
    const Pose before = frame;
    frame.position.x() = std::max(frame.position.x() - step * speed, 0.0);
    gap.move(before, frame, step);
    ASSERT_NEAR((gap.followed(frame).position - held).norm(), 0, 1e-12);
  }
  EXPECT_TRUE(gap.recoils);
  gap.move(frame, frame, step);
  EXPECT_FALSE(gap.recoils);
  EXPECT_NEAR(gap.distance(), 0.1, 1e-12);
}

TEST(FrameGap, isLeftAloneByAFrameThatMovesAsItCan) {
  const Pose frame = pose({5, 0, 0}, {0, 0, 0});
  FrameGap gap = FrameGap::between(frame, pose({0, 0, 0}, {0, 0, 0}));
  gap.move(frame, pose({4.91, 0, 0}, {0, 0, 0}), 0.01);  // back, at 9 m/s
  gap.move(frame, pose({6, 0, 0}, {0, 0, 0}), 0.01);     // away, at 100 m/s
  EXPECT_EQ(gap.distance(), 5);
  EXPECT_FALSE(gap.recoils);
}

TEST(FrameGap, isNothingWhereTheFrameIsBackInItsPlace) {
  const Pose frame = pose({1, 2, 3}, {0.3, -0.2, 2});
  FrameGap gap = FrameGap::between(frame, frame);
  EXPECT_EQ(gap.distance(), 0);
  gap.close_by(1e-9, 1e-9);
  EXPECT_TRUE(gap.is_closed());
  EXPECT_EQ(gap.followed(frame).orientation.coeffs(), frame.orientation.coeffs());
}

}  // namespace
}  // namespace verlet_cable
