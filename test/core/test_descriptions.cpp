#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "described_cables.h"

// A cable does the same however it is described: numbered from either end, of sections of one material, of two cables that are
// joined rigidly. No law may take one joint's, one section's or one cable's word for all.

namespace verlet_cable {
namespace {

using described::Case;
using described::Description;
using described::Run;
using described::Surroundings;
using Status = StepResult::Status;

constexpr int steps = 100;

/// [m] After 0.1 s, in which the cable moves some centimeters.
double largest_difference(const Case& parameters) {
  Run plain(parameters, Description::plain), other(parameters, parameters.description);
  for (int i = 0; i < steps; ++i) {
    EXPECT_EQ(plain.step().status, Status::ok) << i;
    EXPECT_EQ(other.step().status, Status::ok) << i;
  }
  const std::vector<Vector3> x = plain.positions(), y = other.positions();
  EXPECT_EQ(x.size(), y.size());
  double largest = 0;
  for (std::size_t i = 0; i < std::min(x.size(), y.size()); ++i) largest = std::max(largest, (x[i] - y[i]).norm());
  return largest;
}

/// [m]
double tolerance(const Case& parameters) {
  const bool is_on_floor = parameters.surroundings == Surroundings::floor;
  // A substep ends within 1e-5 segment lengths per second of its solution, 2.5e-7 m/s: over the 0.1 s 2.5e-8 m. Cables that are
  // pushed together, and what comes to lie, amplify it: 1.6e-6 and 3.8e-6 m at most.
  if (!described::is_split(parameters.description)) return is_on_floor ? 1e-5 : 4e-6;
  // A junction adds the inertia of the halves of its segments, which is of third order in their length: 5e-5 m at most.
  if (described::is_in_island(parameters) && !described::is_elastic(parameters) && !is_on_floor) return 1e-4;
  // And what is joined is stepped together: substeps are others than those of a cable alone, as are those in which stretches that
  // are not resolved die out, and those that meet the floor. Less than 5e-4 m, of second order in the time step.
  return 1e-3;
}

class Descriptions : public testing::TestWithParam<Case> {};

TEST_P(Descriptions, AreOfTheSameCable) {
  const double difference = largest_difference(GetParam());
  RecordProperty("difference_nm", static_cast<int>(std::min(1e9 * difference, 1e9)));
  EXPECT_LT(difference, tolerance(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(All, Descriptions, testing::ValuesIn(described::all_cases()),
                         [](const auto& info) { return described::name_of(info.param); });

/// A third order: an eighth with segments half as long.
TEST(SplitCables, DifferTheLessTheShorterTheirSegments) {
  int checked = 0;
  for (Case parameters : described::all_cases()) {
    const std::string name = described::name_of(parameters);
    if (name != "AtJunction_Same_Body" && name != "AtJunction_Coiled_Body" && name != "AtOtherEnd_Stiff_ClampHarness") continue;
    ++checked;
    const double coarse = largest_difference(parameters);
    parameters.segments *= 2;
    EXPECT_LT(largest_difference(parameters), coarse / 4) << name;
  }
  EXPECT_EQ(checked, 3);
}

}  // namespace
}  // namespace verlet_cable
