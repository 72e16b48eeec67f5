#include <gtest/gtest.h>

#include <cmath>

#include "../support/scenes.h"
#include "rod/span_shapes.h"

// Shapes between holders that go on with other ends, lengths and nodes.

namespace verlet_cable {
namespace {

/// A sagging cable of 1 m between two points, 0.8 m apart, held in its middle as well.
World held_in_the_middle() {
  SceneDesc scene = scenes::between_two_points(40, 0.8);
  scene.cables[0].attachments.push_back(scenes::attachment("middle", PlaceDesc::At::arc_length, {0.35, 0, -0.1}));
  scene.cables[0].attachments.back().place.arc_length = 0.5;
  return World(scene, initial_frames(scene));
}

std::vector<HeldNode> holders(const CableState& cable, const std::vector<int>& nodes) {
  std::vector<HeldNode> held;
  for (const int node : nodes) {
    held.emplace_back().node = node;
    held.back().position = cable.positions[node];
  }
  return held;
}

double worst_length(const CableState& cable) {
  double worst = 0;
  for (int i = 0; i < cable.segments(); ++i)
    worst = std::max(worst, std::abs((cable.positions[i + 1] - cable.positions[i]).norm() / cable.rest_lengths[i] - 1));
  return worst;
}

/// [rad]
double largest_turn(const CableState& cable, int first, int last) {
  double largest = 0;
  for (int i = first + 1; i < last; ++i) {
    const Vector3 before = cable.positions[i] - cable.positions[i - 1], after = cable.positions[i + 1] - cable.positions[i];
    largest = std::max(largest, std::atan2(before.cross(after).norm(), before.dot(after)));
  }
  return largest;
}

TEST(SpanShapes, StayAsTheyWereWhereNothingHasChanged) {
  const World world = held_in_the_middle();
  CableState cable = world.cables()[0].state;
  const std::vector<Vector3> before = cable.positions;
  std::vector<HeldNode> held = holders(cable, {0, 20, 40});
  const SpanShapes shapes(held, cable);
  for (Vector3& position : cable.positions) position += Vector3(0.1, 0.2, 0.3);
  shapes.apply(*world.cables()[0].model, held, {0, 0, -9.81}, cable);
  EXPECT_EQ(cable.positions, before);
  // The other span only.
  held[2].position.x() += 0.01;
  shapes.apply(*world.cables()[0].model, held, {0, 0, -9.81}, cable);
  for (int i = 0; i <= 20; ++i) EXPECT_EQ(cable.positions[i], before[i]);
  EXPECT_EQ(cable.positions[40], held[2].position);
  EXPECT_LT(worst_length(cable), 2e-7);
}

/// As material goes from one span to the other: both are smooth bows of their new lengths.
TEST(SpanShapes, HaveTheLengthsThatTheirMaterialHasNow) {
  const World world = held_in_the_middle();
  const CableState& cable = world.cables()[0].state;
  const SpanShapes shapes(holders(cable, {0, 20, 40}), cable);
  for (const double shift : {0.03, 0.01, -0.01, -0.08, -0.12}) {
    CableState changed = cable;
    for (int i = 0; i < 40; ++i) changed.rest_lengths[i] *= i < 20 ? 1 + 2 * shift : 1 - 2 * shift;
    shapes.apply(*world.cables()[0].model, holders(cable, {0, 20, 40}), {0, 0, -9.81}, changed);
    EXPECT_LT(worst_length(changed), 2e-7) << shift;
    for (const int node : {0, 20, 40}) EXPECT_EQ(changed.positions[node], cable.positions[node]);
    EXPECT_LT(largest_turn(changed, 0, 20), 0.7) << shift;
    EXPECT_LT(largest_turn(changed, 20, 40), 0.7) << shift;
  }
}

TEST(SpanShapes, HangWhereTheyWereStraightAndHaveSlackNow) {
  SceneDesc scene = scenes::between_two_points(20, 1.0);
  const World world(scene, initial_frames(scene));
  CableState cable = world.cables()[0].state;
  std::vector<HeldNode> held = holders(cable, {0, 20});
  const SpanShapes shapes(held, cable);
  held[1].position.x() = 0.9;
  shapes.apply(*world.cables()[0].model, held, {0, 0, -9.81}, cable);
  EXPECT_LT(cable.positions[10].z(), -0.15);
  EXPECT_LT(worst_length(cable), 1e-6);
  // Further than it is long it is straight.
  held[1].position = {1.2, 0, 0.1};
  shapes.apply(*world.cables()[0].model, held, {0, 0, -9.81}, cable);
  EXPECT_NEAR((cable.positions[10] - Vector3(0.6, 0, 0.05)).norm(), 0, 1e-12);
}

TEST(SpanShapes, FreeEndsGoAlongWithWhatHoldsThem) {
  const SceneDesc scene = scenes::released(20, 0.4);
  const World world(scene, initial_frames(scene));
  CableState cable = world.cables()[0].state;
  const std::vector<Vector3> before = cable.positions;
  std::vector<HeldNode> held = holders(cable, {10});
  const SpanShapes shapes(held, cable);
  held[0].position += Vector3(0.1, 0, 0);
  for (int i = 0; i < 20; ++i) cable.rest_lengths[i] *= i < 10 ? 0.9 : 1.1;
  shapes.apply(*world.cables()[0].model, held, {0, 0, -9.81}, cable);
  EXPECT_LT(worst_length(cable), 1e-12);
  const Vector3 along = (before[20] - before[0]).normalized();
  EXPECT_LT((cable.positions[20] - held[0].position - 0.55 * along).norm(), 1e-12);
  EXPECT_LT((cable.positions[0] - held[0].position + 0.45 * along).norm(), 1e-12);
}

TEST(SpanShapes, LieStraightBetweenWhatHoldsThem) {
  const World world = held_in_the_middle();
  CableState cable = world.cables()[0].state;
  lay_straight(holders(cable, {10, 30}), cable);
  for (int i = 0; i < 10; ++i) EXPECT_NEAR((cable.positions[i + 1] - cable.positions[i]).norm(), 0.025, 1e-12);
  for (const auto& [first, last] : {std::pair{0, 10}, {10, 30}, {30, 40}}) EXPECT_LT(largest_turn(cable, first, last), 1e-6);
}

}  // namespace
}  // namespace verlet_cable
