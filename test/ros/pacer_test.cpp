#include "verlet_cable/ros/pacer.h"

#include <gtest/gtest.h>

namespace verlet_cable {
namespace {

TEST(Pacer, DoesWholeStepsAndNotBeyondTheTarget) {
  Pacer pacer(10, 1000);
  EXPECT_EQ(pacer.due(100, 129).steps, 2);
  EXPECT_EQ(pacer.due(100, 130).steps, 3);
  EXPECT_EQ(pacer.due(100, 100).steps, 0);
  EXPECT_EQ(pacer.due(100, 50).steps, 0) << "the target may lie behind, after a jump of the clock";
  EXPECT_EQ(pacer.dropped(), 0);
}

TEST(Pacer, CatchesUpTheLongestBacklogAndCountsTheRestAsDropped) {
  Pacer pacer(10, 105);
  const Pacer::Due due = pacer.due(0, 1005);
  EXPECT_EQ(due.steps, 10);
  EXPECT_EQ(due.dropped, 900);
  EXPECT_EQ(due.dropped + due.steps * 10, 1000) << "it ends where it would have without dropping";
  EXPECT_EQ(pacer.dropped(), 900);
  pacer.due(1000, 1105);
  EXPECT_EQ(pacer.dropped(), 900);
  pacer.drop(50);
  EXPECT_EQ(pacer.dropped(), 950);
  pacer.drop(-50);
  EXPECT_EQ(pacer.dropped(), 950);
}

TEST(Pacer, DoesAStepEvenWhereTheBacklogAllowsLess) {
  EXPECT_EQ(Pacer(10, 3).due(0, 25).steps, 1);
}

}  // namespace
}  // namespace verlet_cable
