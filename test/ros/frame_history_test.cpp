#include "frames/frame_history.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace verlet_cable {
namespace {

using Coverage = FrameHistory::Coverage;
constexpr Nanoseconds longest_gap = 100;

FrameHistory history_of(std::initializer_list<Nanoseconds> stamps) {
  FrameHistory history(longest_gap);
  for (const Nanoseconds stamp : stamps) history.extend(stamp);
  return history;
}

TEST(FrameHistory, KnowsNothingBeforeTheFirstStampAndAfterTheLast) {
  const FrameHistory history = history_of({1000, 1050, 1100});
  EXPECT_EQ(history.at(999), Coverage::unseen);
  EXPECT_EQ(history.at(1000), Coverage::covered);
  EXPECT_EQ(history.at(1073), Coverage::covered);
  EXPECT_EQ(history.at(1100), Coverage::covered);
  EXPECT_EQ(history.at(1101), Coverage::ahead);
  EXPECT_EQ(history.first(), 1000);
  EXPECT_EQ(history.newest(), 1100);
}

TEST(FrameHistory, StampsFurtherApartThanTheLongestGapLeaveAGap) {
  const FrameHistory history = history_of({1000, 1100, 1201, 1250});
  EXPECT_EQ(history.at(1050), Coverage::covered);
  EXPECT_EQ(history.at(1101), Coverage::gap);
  EXPECT_EQ(history.at(1200), Coverage::gap);
  EXPECT_EQ(history.at(1201), Coverage::covered);
  EXPECT_EQ(history.last_before(1150), 1100);
  EXPECT_EQ(history.first_after(1150), 1201);
  EXPECT_EQ(history.last_before(1000), 0);
  EXPECT_EQ(history.first_after(1250), 0);
}

TEST(FrameHistory, WhatItSaysDoesNotDependOnWhenStampsArrived) {
  FrameHistory asked_early = history_of({1000});
  EXPECT_EQ(asked_early.at(1050), Coverage::ahead);
  asked_early.extend(1100);
  const FrameHistory asked_late = history_of({1000, 1100});
  for (Nanoseconds time = 950; time < 1150; ++time) EXPECT_EQ(asked_early.at(time), asked_late.at(time)) << time;
}

TEST(FrameHistory, WhatItSaysDoesNotDependOnTheOrderOfStamps) {
  std::vector<Nanoseconds> stamps{1000, 1050, 1100, 1201, 1250, 1400};
  const FrameHistory ascending = history_of({1000, 1050, 1100, 1201, 1250, 1400});
  do {
    FrameHistory history(longest_gap);
    for (const Nanoseconds stamp : stamps) history.extend(stamp);
    EXPECT_EQ(history.newest(), 1400);
    for (Nanoseconds time = 950; time < 1450; ++time) {
      ASSERT_EQ(history.at(time), ascending.at(time)) << time;
      ASSERT_EQ(history.last_before(time), ascending.last_before(time)) << time;
      ASSERT_EQ(history.first_after(time), ascending.first_after(time)) << time;
    }
  } while (std::next_permutation(stamps.begin(), stamps.end()));
}

TEST(FrameHistory, ForgettingKeepsThatTheFrameWasSeenAndUntilWhen) {
  FrameHistory history = history_of({1000, 1300, 1600});
  history.forget_before(1400);
  EXPECT_EQ(history.at(1400), Coverage::gap);
  EXPECT_EQ(history.last_before(1400), 1300);
  history.forget_before(5000);
  EXPECT_EQ(history.at(5000), Coverage::ahead);
  EXPECT_TRUE(history.seen());
}

TEST(FrameHistory, StaticFramesAreKnownAtAllTimes) {
  FrameHistory history(longest_gap);
  EXPECT_FALSE(history.seen());
  EXPECT_EQ(history.at(7), Coverage::unseen);
  history.set_static();
  EXPECT_TRUE(history.seen());
  EXPECT_EQ(history.at(7), Coverage::covered);
  EXPECT_EQ(history.first(), 0);
  history.clear();
  EXPECT_FALSE(history.seen());
}

}  // namespace
}  // namespace verlet_cable
