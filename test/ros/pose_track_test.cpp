#include "frames/pose_track.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace verlet_cable {
namespace {

constexpr double jump_speed = 5;  // [m/s]
constexpr Nanoseconds ms = 1'000'000, longest_gap = 500 * ms;

Pose at(const Vector3& position, double yaw = 0) {
  return {position, Quaternion(Eigen::AngleAxisd(yaw, Vector3::UnitZ()))};
}

/// What is played of samples, and the straight lines between: what tf2 does with it.
class Played {
 public:
  explicit Played(double speed = jump_speed) : track_(speed, longest_gap) {}

  void add(Nanoseconds stamp, const Pose& pose, const std::vector<Vector3>& carried = {}) {
    for (const PoseSample& sample : track_.add({stamp, pose}, carried)) {
      const bool ascends = samples_.empty() || samples_.back().stamp < sample.stamp;
      EXPECT_TRUE(ascends);
      if (ascends) samples_.push_back(sample);
    }
  }
  Nanoseconds newest() const { return samples_.back().stamp; }

  Pose pose(Nanoseconds time) const {
    const auto next = std::find_if(samples_.begin(), samples_.end(), [&](const PoseSample& s) { return s.stamp >= time; });
    EXPECT_NE(next, samples_.end());
    if (next->stamp == time) return next->pose;
    const PoseSample& from = *(next - 1);
    const double part = static_cast<double>(time - from.stamp) / static_cast<double>(next->stamp - from.stamp);
    return {from.pose.position + part * (next->pose.position - from.pose.position),
            from.pose.orientation.slerp(part, next->pose.orientation)};
  }
  Vector3 place(Nanoseconds time) const { return pose(time).position; }

 private:
  PoseTrack track_;
  std::vector<PoseSample> samples_;
};

/// The samples of a motion (of seconds) at a rate, from 0 on.
Played played(double rate, int count, const std::function<Vector3(double)>& motion) {
  Played result;
  for (int i = 0; i < count; ++i) {
    const auto stamp = static_cast<Nanoseconds>(std::llround(i / rate * 1e9)) + ms;
    result.add(stamp, at(motion(i / rate)));
  }
  return result;
}

TEST(PoseTrack, JumpsAreNotPlayedAtAnyRate) {
  for (const double rate : {10.0, 20.0, 50.0, 100.0, 500.0}) {
    const double way = std::max(0.3, 1.2 * jump_speed / rate);
    const Played track = played(rate, 12, [&](double t) { return Vector3(t < 5.5 / rate ? 0 : way, 0, 1); });
    const Nanoseconds jump = static_cast<Nanoseconds>(std::llround(6 / rate * 1e9)) + ms;
    for (Nanoseconds time = ms; time <= track.newest(); time += ms / 2)
      ASSERT_EQ(track.place(time), Vector3(time < jump - 1 ? 0
                                           : time >= jump  ? way
                                                           : track.place(time).x(),
                                           0, 1))
          << rate << " Hz";
  }
}

TEST(PoseTrack, AFrameThatMovesGoesOnAfterItsJump) {
  const Played track = played(50, 20, [](double t) { return Vector3(0.5 * t + (t > 0.19 ? 2 : 0), 0, 0); });
  EXPECT_NEAR(track.place(150 * ms).x(), 0.5 * 0.149, 2e-3);
  EXPECT_NEAR(track.place(300 * ms).x(), 2 + 0.5 * 0.299, 2e-3);
  EXPECT_LT((track.place(199 * ms) - track.place(182 * ms)).norm(), 1e-12) << "stays until it is there";
}

TEST(PoseTrack, FastMotionIsPlayed) {
  for (const double rate : {10.0, 20.0, 50.0, 100.0, 500.0}) {
    // A hand that is swung: 6 m/s for 0.4 s.
    const auto motion = [](double t) { return Vector3(6 * std::clamp(t - 0.2, 0.0, 0.4), 0, 0); };
    const Played track = played(rate, static_cast<int>(rate), motion);
    for (Nanoseconds time = ms; time + ms <= track.newest(); time += ms)
      ASSERT_LT((track.place(time + ms) - track.place(time)).norm(), 0.018) << rate << " Hz";
    EXPECT_NEAR(track.place(401 * ms).x(), 1.2, 0.01) << rate << " Hz";
  }
}

TEST(PoseTrack, WhatMayBeAJumpIsHeldBackUntilTheNextSample) {
  Played track;
  for (int i = 0; i <= 3; ++i) track.add((i + 1) * 50 * ms, at(Vector3(i == 3 ? 1 : 0, 0, 0)));
  EXPECT_EQ(track.newest(), 150 * ms);
  track.add(250 * ms, at(Vector3(1, 0, 0)));
  EXPECT_EQ(track.newest(), 250 * ms);
  EXPECT_EQ(track.place(199 * ms), Vector3(0, 0, 0));
  EXPECT_EQ(track.place(200 * ms), Vector3(1, 0, 0));
}

/// A base that turns on the spot by 20 degrees within 10 ms, or goes on turning: 0.35 m for a hand that is 1 m away.
Played turned(bool goes_on, const std::vector<Vector3>& carried) {
  Played track;
  for (int i = 0; i <= 10; ++i)
    track.add(ms + i * 10 * ms, at(Vector3::Zero(), 0.35 * std::clamp(i - 4, 0, goes_on ? 6 : 1)), carried);
  return track;
}

TEST(PoseTrack, ABaseThatTurnsAtOnceJumpsByTheWayOfTheHandItCarries) {
  const Vector3 hand(1, 0, 0);
  const auto way = [&](const Played& track, Nanoseconds from, Nanoseconds to) {
    return (track.pose(to).orientation * hand - track.pose(from).orientation * hand).norm();
  };
  const Nanoseconds before = ms + 41 * ms, after = ms + 49 * ms;
  EXPECT_EQ(way(turned(false, {hand}), before, after), 0) << "the way to the sample is not played";
  EXPECT_GT(way(turned(false, {}), before, after), 0.2) << "nothing is carried: a turn, and no jump";
  EXPECT_GT(way(turned(true, {hand}), before, after), 0.2) << "two fast intervals are motion";
}

TEST(PoseTrack, NoFrameJumpsWhereJumpSpeedIsInfinite) {
  Played track(infinity);
  for (int i = 0; i <= 3; ++i) track.add((i + 1) * 50 * ms, at(Vector3(i == 3 ? 100 : 0, 0, 0)));
  EXPECT_EQ(track.newest(), 200 * ms);
}

TEST(PoseTrack, VelocitiesDoNotKinkBetweenSlowSamples) {
  const auto motion = [](double t) { return Vector3(0.2 * std::sin(2 * t), 0, 0); };
  const Played track = played(10, 60, motion);
  double largest_change = 0, largest_error = 0;
  // The third interval is the first with a velocity on both sides.
  for (Nanoseconds time = 301 * ms; time + 10 * ms <= track.newest(); time += 5 * ms) {
    const Vector3 change = track.place(time + 10 * ms) - 2 * track.place(time + 5 * ms) + track.place(time);
    largest_change = std::max(largest_change, change.norm() / 5e-3);
    largest_error = std::max(largest_error, (track.place(time) - motion(1e-9 * static_cast<double>(time - ms))).norm());
  }
  // [m/s] Straight lines between the samples change by 0.08; half of that is left where the hand turns back, and must not be led
  // beyond its samples.
  EXPECT_LT(largest_change, 0.04);
  EXPECT_LT(largest_error, 1e-3);
}

TEST(PoseTrack, OrientationsDoNotKinkEither) {
  Played track;
  const auto yaw = [](double t) { return 0.5 * std::sin(2 * t); };
  for (int i = 0; i < 60; ++i) track.add(i * 100 * ms + ms, at(Vector3::Zero(), yaw(0.1 * i)));
  double largest_error = 0;
  for (Nanoseconds time = 301 * ms; time <= track.newest(); time += 5 * ms)
    largest_error =
        std::max(largest_error,
                 track.pose(time).orientation.angularDistance(at({}, yaw(1e-9 * static_cast<double>(time - ms))).orientation));
  EXPECT_LT(largest_error, 2.5e-3);
}

TEST(PoseTrack, WhatStandsStandsAndWhatStopsStops) {
  const Played track = played(10, 20, [](double t) { return Vector3(std::min(t, 1.0), 0, 0); });
  for (Nanoseconds time = 1001 * ms; time <= track.newest(); time += ms) ASSERT_EQ(track.place(time), Vector3(1, 0, 0));
  for (Nanoseconds time = ms; time + ms <= track.newest(); time += ms)
    ASSERT_LE(track.place(time).x(), track.place(time + ms).x()) << "never turns back";
}

TEST(PoseTrack, DroppedSamplesArePartsOfAMotion) {
  Played track;
  for (int i = 0; i < 40; ++i)
    if (i % 7 != 3) track.add(i * 20 * ms + ms, at(Vector3(0.02 * i, 0, 0)));
  for (Nanoseconds time = 41 * ms; time <= 760 * ms; time += ms)
    ASSERT_NEAR(track.place(time).x(), 1e-9 * static_cast<double>(time - ms), 2e-3);
}

TEST(PoseTrack, LateSamplesChangeNothingOfTheRest) {
  PoseTrack track(jump_speed, longest_gap);
  track.add({10 * ms, at(Vector3(0, 0, 0))});
  track.add({20 * ms, at(Vector3(0.01, 0, 0))});
  const std::vector<PoseSample> late = track.add({15 * ms, at(Vector3(0.004, 0, 0))});
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(late.front().stamp, 15 * ms);
}

TEST(PoseTrack, AfterALongGapTheFrameBeginsAnew) {
  Played track;
  track.add(10 * ms, at(Vector3(0, 0, 0)));
  track.add(20 * ms, at(Vector3(0.01, 0, 0)));
  track.add(20 * ms + 2 * longest_gap, at(Vector3(9, 0, 0)));
  EXPECT_EQ(track.newest(), 20 * ms + 2 * longest_gap) << "is not held back";
}

}  // namespace
}  // namespace verlet_cable
