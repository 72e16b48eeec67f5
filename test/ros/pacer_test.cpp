#include "time/pacer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "time/overload_watch.h"

namespace verlet_cable {
namespace {

constexpr Nanoseconds ms = 1000000;
constexpr Nanoseconds second = 1000 * ms;
constexpr Nanoseconds backlog = second;

Pacer make_pacer() {
  return Pacer(TimeGrid(0.001, 50), backlog);
}

struct Outcome {
  std::vector<Nanoseconds> times;  ///< that were simulated
  Nanoseconds behind = 0;          ///< at the end
};
/// A machine that takes `cost` of ROS time for each step, given ROS time and the way of the step, from ROS time 0 to `end`.
template <class Cost>
Outcome run(Pacer& pacer, Nanoseconds end, Cost cost) {
  Outcome result;
  Nanoseconds simulated = 0;
  for (Nanoseconds clock = 0; clock < end;) {
    simulated = pacer.resume(simulated, clock);
    const auto time = pacer.next(simulated, clock);
    if (!time) {
      clock += ms / 4;
      continue;
    }
    clock += cost(clock, *time - simulated);
    pacer.done(simulated, *time, clock);
    simulated = *time;
    result.times.push_back(simulated);
    result.behind = clock - simulated;
  }
  return result;
}

TEST(Pacer, StepsOnTheGridAndNotBeyondTheTarget) {
  const Pacer pacer = make_pacer();
  EXPECT_EQ(pacer.next(100 * ms, 101 * ms), 101 * ms);
  EXPECT_EQ(pacer.next(100 * ms, 101 * ms - 1), std::nullopt);
  EXPECT_EQ(pacer.next(100 * ms, 50 * ms), std::nullopt) << "the target may lie behind, after a jump of the clock";
  EXPECT_EQ(pacer.next(100 * ms + 1, 110 * ms), 102 * ms) << "back to the grid";
}

TEST(Pacer, CatchesUpALateStartWithoutDropping) {
  Pacer pacer = make_pacer();
  const Outcome late = run(pacer, 3 * second, [](Nanoseconds clock, Nanoseconds) { return clock < ms ? backlog : ms / 2; });
  EXPECT_EQ(pacer.dropped(), 0);
  EXPECT_LE(late.behind, ms);
  for (std::size_t i = 0; i < late.times.size(); ++i) ASSERT_EQ(late.times[i], static_cast<Nanoseconds>(i + 1) * ms);
}

TEST(Pacer, LeavesOutALeapOfTheClockAtOnce) {
  Pacer pacer = make_pacer();
  EXPECT_EQ(pacer.resume(0, ms), 0);
  EXPECT_EQ(pacer.resume(0, backlog), 0) << "this can be caught up";
  EXPECT_EQ(pacer.resume(0, backlog + 10 * second), 10 * second);
  EXPECT_EQ(pacer.dropped(), 10 * second);
  EXPECT_EQ(pacer.resume(10 * second, 9 * second), 10 * second) << "back";
}

TEST(Pacer, IsNeverFarBehindWhateverTheClockDid) {
  Pacer pacer = make_pacer();
  EXPECT_EQ(pacer.resume(100 * second, 100 * second), 100 * second);
  // Back by 30 s and ahead by 100 s, unseen, with a start in between.
  const Nanoseconds time = pacer.resume(70 * second, 170 * second);
  EXPECT_EQ(time, 169 * second);
  EXPECT_EQ(pacer.next(time, 170 * second), time + ms);
  // A machine that does nothing for as long as it can.
  Pacer slow = make_pacer();
  Nanoseconds simulated = 0;
  for (Nanoseconds clock = ms; clock < 100 * second; clock += 190 * ms) {
    simulated = slow.resume(simulated, clock);
    const auto next = slow.next(simulated, clock);
    if (!next) continue;
    slow.done(simulated, *next, clock);
    EXPECT_GT(*next, simulated);
    simulated = *next;
    EXPECT_LT(clock - simulated, 7 * second);
  }
}

TEST(Pacer, LeavesOutTimeEvenlyWhereTheMachineIsTooSlow) {
  for (const Nanoseconds cost : {ms * 5 / 4, 2 * ms, 8 * ms, 40 * ms}) {
    Pacer pacer = make_pacer();
    // Every tenth step is followed by a hiccup of three.
    int steps = 0;
    const Outcome slow = run(pacer, 60 * second, [&](Nanoseconds, Nanoseconds) { return ++steps % 10 == 0 ? 4 * cost : cost; });
    const double pace = 1.3 * static_cast<double>(cost) / ms;
    for (std::size_t i = slow.times.size() / 2; i < slow.times.size(); ++i)
      ASSERT_NEAR(static_cast<double>(slow.times[i] - slow.times[i - 1]) / ms, pace, 0.1 * pace) << "cost " << cost;
    // A step takes up to four times as long as most.
    EXPECT_LT(seconds(slow.behind), 0.1 + 50 * seconds(cost)) << "cost " << cost;
    EXPECT_EQ(pacer.left_out(), pacer.dropped());
    EXPECT_EQ(pacer.dropped(), slow.times.back() - static_cast<Nanoseconds>(slow.times.size()) * ms);
  }
}

TEST(Pacer, DoesNotRunAwayWhereFasterFramesCostMore) {
  Pacer pacer = make_pacer();
  const Outcome whip = run(pacer, 60 * second, [](Nanoseconds, Nanoseconds way) {
    return static_cast<Nanoseconds>(ms * (0.7 + 0.5 * std::sqrt(static_cast<double>(way) / ms)));
  });
  // 0.7 + 0.5 sqrt(pace) = pace
  const double pace = 1.264;
  for (std::size_t i = whip.times.size() / 2; i < whip.times.size(); ++i)
    ASSERT_NEAR(static_cast<double>(whip.times[i] - whip.times[i - 1]) / ms, pace, 0.02);
}

TEST(Pacer, ReturnsToTheGridAfterAnOverload) {
  Pacer pacer = make_pacer();
  const Outcome both =
      run(pacer, 20 * second, [](Nanoseconds clock, Nanoseconds) { return clock < 10 * second ? 2 * ms : ms / 5; });
  EXPECT_LE(both.behind, ms);
  EXPECT_NEAR(seconds(pacer.dropped()), 4.95, 0.05) << "of 10 s half, without the little that is caught up";
  EXPECT_EQ(both.times.back() % ms, 0);
  EXPECT_EQ(both.times[both.times.size() - 1000], both.times.back() - 999 * ms);
}

TEST(Pacer, GivesUpWhatItCannotCatchUp) {
  for (const auto& [overload, latest] : {std::pair{ms * 5 / 4, 100 * ms}, {2 * ms, 200 * ms}, {10 * ms, 400 * ms}}) {
    Pacer pacer = make_pacer();
    Nanoseconds behind = 0, most = 0;
    for (Nanoseconds simulated = 0, clock = 0; clock < 30 * second;) {
      simulated = pacer.resume(simulated, clock);
      const auto time = pacer.next(simulated, clock);
      // The overload lasts for 20 s.
      clock += !time ? ms / 4 : clock < 20 * second ? overload : ms / 2;
      if (!time) continue;
      pacer.done(simulated, *time, clock);
      simulated = *time;
      behind = clock - simulated;
      if (clock > 8 * second) most = std::max(most, behind);
    }
    EXPECT_LT(most, latest) << "overload " << overload;
    EXPECT_LE(behind, 2 * ms) << "overload " << overload;
  }
}

TEST(Pacer, WaitsAsLongAsItTakesToCatchUpWhatAnotherWaitedFor) {
  Pacer pacer = make_pacer();
  Nanoseconds simulated = 0;
  // A frame that is late by 0.9 s, again and again.
  for (Nanoseconds clock = 0; clock < 30 * second; clock += ms / 4) {
    simulated = pacer.resume(simulated, clock);
    if (clock % (2 * second) < 900 * ms) {
      pacer.rest();
      continue;
    }
    const auto time = pacer.next(simulated, clock);
    if (!time) continue;
    pacer.done(simulated, *time, clock);
    simulated = *time;
  }
  EXPECT_EQ(pacer.dropped(), 0);
}

TEST(Pacer, IsNeverFurtherBehindThanTheLongestBacklog) {
  for (const Nanoseconds longest : {backlog / 10, backlog / 2, backlog})
    for (const Nanoseconds cost : {ms * 5 / 4, 2 * ms, 8 * ms, 40 * ms}) {
      Pacer pacer(TimeGrid(0.001, 50), longest);
      Nanoseconds simulated = 0;
      for (Nanoseconds clock = 0; clock < 20 * second;) {
        simulated = pacer.resume(simulated, clock);
        ASSERT_LE(clock - simulated, longest) << "cost " << cost;
        const auto time = pacer.next(simulated, clock);
        clock += time ? cost : ms / 4;
        if (!time) continue;
        pacer.done(simulated, *time, clock);
        simulated = *time;
      }
    }
}

TEST(OverloadWatch, ReportsSoonAndThenEveryTenSeconds) {
  OverloadWatch watch;
  std::vector<double> reported;
  for (double wall = 0; wall < 60; wall += 0.01) {
    const double overload = std::clamp(wall - 20, 0.0, 30.0);  // from 20 to 50 s
    const auto report = watch.look(nanoseconds(wall), nanoseconds(0.4 * overload), wall);
    if (!report) continue;
    reported.push_back(wall);
    if (reported.size() == 2) {
      EXPECT_NEAR(report->real_time_factor, 0.6, 1e-6);
      EXPECT_NEAR(report->left_out, 4, 0.01);
    }
  }
  ASSERT_EQ(reported.size(), 4U);
  EXPECT_NEAR(reported[0], 22, 0.1);
  for (std::size_t i = 1; i < reported.size(); ++i) EXPECT_NEAR(reported[i] - reported[i - 1], 10, 0.1);
}

TEST(Pacer, DoesNotWaitAfterAnOverloadThatAPauseEnds) {
  Pacer pacer = make_pacer();
  run(pacer, 20 * second, [](Nanoseconds, Nanoseconds) { return 60 * ms; });
  EXPECT_TRUE(pacer.next(30 * second, 30 * second + 2 * ms));
}

TEST(Pacer, CountsWhatIsDroppedElsewhere) {
  Pacer pacer = make_pacer();
  pacer.drop(50);
  pacer.drop(-50);
  EXPECT_EQ(pacer.dropped(), 50);
}

TEST(Pacer, WhatIsDroppedStaysANumber) {
  Pacer pacer = make_pacer();
  Nanoseconds before = 0;
  for (int leap = 0; leap < 5; ++leap) {
    pacer.drop(4'294'967'295'000'000'000);
    EXPECT_GE(pacer.dropped(), before);
    before = pacer.dropped();
  }
}

}  // namespace
}  // namespace verlet_cable
