#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable {
namespace {

TEST(NumberText, MeasuredNumbersAreRoundedForPeople) {
  EXPECT_EQ(rounded_text(0.4000000000000001), "0.4");
  EXPECT_EQ(rounded_text(1.0 / 3), "0.3333");
  EXPECT_EQ(rounded_text(12345.678), "12346");
  EXPECT_EQ(rounded_text(-0.0123456), "-0.01235");
  EXPECT_EQ(rounded_text(0.0), "0");
  EXPECT_EQ(rounded_text(12.3456789, 6), "12.3457");
  EXPECT_EQ(rounded_text(std::numeric_limits<double>::infinity()), "inf");
}

TEST(NumberText, GivenNumbersStayWhatTheyAre) {
  EXPECT_EQ(std::stod(number_text(0.4000000000000001)), 0.4000000000000001);
}

TEST(NumberText, WhatIsNoNumberHasNoSign) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double value : {nan, std::copysign(nan, -1.0), std::copysign(nan, 1.0)}) {
    EXPECT_EQ(number_text(value), "nan");
    EXPECT_EQ(rounded_text(value), "nan");
    EXPECT_EQ(rounded_bound_text(value, -1), "nan");
  }
}

TEST(NumberText, WhatABoundSaysIsAllowed) {
  for (const double bound : {0.4000000000000001, 0.4, 1.2345678, 999.96, 12345.678, 1e-7 / 3, 2e12 / 3, -2.34567}) {
    EXPECT_GE(std::stod(rounded_bound_text(bound, 1)), bound);
    EXPECT_LE(std::stod(rounded_bound_text(bound, -1)), bound);
    EXPECT_LE(rounded_bound_text(bound, 1).size(), 9u);
    EXPECT_LE(rounded_bound_text(bound, -1).size(), 9u);
  }
  EXPECT_EQ(rounded_bound_text(0.4, 1), "0.4");
  EXPECT_EQ(rounded_bound_text(std::numeric_limits<double>::infinity(), -1), "inf");
}

}  // namespace
}  // namespace verlet_cable
