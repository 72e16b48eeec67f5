#include <gtest/gtest.h>

#include <vector>

#include "../support/scenes.h"
#include "rod/length_projection.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

/// A cable of three segments, its nodes at these places.
CableState cable_at(const std::vector<Vector3>& places) {
  SceneDesc scene = scenes::one_cable(3, 0.3);
  CableState state = World(scene, BoundaryInputs(frame_names(scene).size())).cables()[0].state;
  state.positions = places;
  return state;
}

TEST(LengthProjection, FindsLengths) {
  CableState state = cable_at({{0, 0, 0}, {0.09, 0.01, 0}, {0.2, 0, 0.02}, {0.31, 0, 0}});
  ASSERT_TRUE(project_lengths({}, {0.1, 0.1, 0.1}, state));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR((state.positions[i + 1] - state.positions[i]).norm(), 0.1, 1e-12) << i;
}

/// Segments without a direction: Newton's system is singular, and its solution not a number.
TEST(LengthProjection, LeavesAloneWhatItFindsNoShapeFor) {
  for (const std::vector<Vector3>& places : {std::vector<Vector3>(4, Vector3(1, 2, 3)),
                                             {{0, 0, 0}, {0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}},
                                             {{0, 0, 0}, {0.1, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}},
                                             {{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}, {0.2, 0, 0}}}) {
    CableState state = cable_at(places);
    EXPECT_FALSE(project_lengths({}, {0.1, 0.1, 0.1}, state));
    EXPECT_EQ(state.positions, places);
  }
}

}  // namespace
}  // namespace verlet_cable
