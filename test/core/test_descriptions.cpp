#include <gtest/gtest.h>

#include <algorithm>

#include "described_cables.h"

// A cable does the same however it is described: numbered from either end, of sections of one material, of two cables that are
// joined rigidly. No law may take one joint's, one section's or one cable's word for all.

namespace verlet_cable {
namespace {

using described::Case;
using described::Description;
using described::Run;
using Status = StepResult::Status;

constexpr int steps = 100;

class Descriptions : public testing::TestWithParam<Case> {};

TEST_P(Descriptions, AreOfTheSameCable) {
  Run plain(GetParam(), Description::plain), other(GetParam(), GetParam().description);
  for (int i = 0; i < steps; ++i) {
    ASSERT_EQ(plain.step().status, Status::ok) << i;
    ASSERT_EQ(other.step().status, Status::ok) << i;
  }
  const std::vector<Vector3> x = plain.positions(), y = other.positions();
  ASSERT_EQ(x.size(), y.size());
  double largest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) largest = std::max(largest, (x[i] - y[i]).norm());
  EXPECT_LT(largest, 1e-6);
}

INSTANTIATE_TEST_SUITE_P(All, Descriptions, testing::ValuesIn(described::all_cases()),
                         [](const auto& info) { return described::name_of(info.param); });

}  // namespace
}  // namespace verlet_cable
