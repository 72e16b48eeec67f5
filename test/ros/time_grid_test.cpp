#include "time/time_grid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace verlet_cable {
namespace {

constexpr Nanoseconds millisecond = 1000000;
constexpr Nanoseconds today = 1700000000123456789;  // about what ROS time is outside of tests [ns]

TEST(TimeGrid, StepsAreMultiplesOfTheTimeStepWhateverTheTime) {
  const TimeGrid grid(0.001, 50);
  EXPECT_EQ(grid.step(), millisecond);
  EXPECT_EQ(grid.period(), 20 * millisecond);
  EXPECT_EQ(grid.step_at_or_before(today), 1700000000123 * millisecond);
  EXPECT_EQ(grid.step_at_or_after(today), 1700000000124 * millisecond);
  EXPECT_EQ(grid.step_at_or_after(5 * millisecond), 5 * millisecond);
  EXPECT_EQ(grid.step_at_or_before(-1), -millisecond);
  EXPECT_EQ(grid.step_at_or_after(-1), 0);
}

TEST(TimeGrid, TicksAreTheFirstStepsAtOrAfterMultiplesOfThePeriod) {
  const TimeGrid grid(0.003, 50);  // multiples of 20 ms: 20, 40, 60; steps at or after: 21, 42, 60
  for (const Nanoseconds tick : {21, 42, 60, 81}) EXPECT_TRUE(grid.is_tick(tick * millisecond)) << tick;
  for (const Nanoseconds step : {18, 24, 39, 45, 57, 63}) EXPECT_FALSE(grid.is_tick(step * millisecond)) << step;
  EXPECT_EQ(grid.tick_at_or_after(20 * millisecond), 21 * millisecond);
  EXPECT_EQ(grid.tick_at_or_after(20 * millisecond + 1), 21 * millisecond);
  EXPECT_EQ(grid.tick_at_or_after(21 * millisecond), 21 * millisecond);
  EXPECT_EQ(grid.tick_at_or_after(21 * millisecond + 1), 42 * millisecond);
}

TEST(TimeGrid, EveryStepIsATickWhereMessagesAreFasterThanSteps) {
  const TimeGrid grid(0.01, 1000);
  for (Nanoseconds step = 0; step < 100 * millisecond; step += grid.step()) EXPECT_TRUE(grid.is_tick(step));
}

TEST(TimeGrid, TicksComeAtThePublishRate) {
  const TimeGrid grid(0.001, 60);
  int ticks = 0;
  const Nanoseconds begin = grid.step_at_or_after(today);
  for (Nanoseconds step = begin; step < begin + 10000 * millisecond; step += grid.step()) ticks += grid.is_tick(step);
  EXPECT_NEAR(ticks, 600, 1);  // one at either border
}

TEST(TimeGrid, SecondsBecomeWholeNanoseconds) {
  EXPECT_EQ(nanoseconds(0.3), 300000000);
  EXPECT_EQ(nanoseconds(-0.001), -1000000);
  EXPECT_DOUBLE_EQ(seconds(1500 * millisecond), 1.5);
  EXPECT_GT(nanoseconds(INFINITY), today);
  EXPECT_GT(nanoseconds(INFINITY) + nanoseconds(INFINITY), nanoseconds(INFINITY)) << "sums do not overflow";
}

}  // namespace
}  // namespace verlet_cable
