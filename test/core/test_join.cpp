#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "../support/scenes.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

/// Two ropes of half a metre that hang beside each other, `apart` [m].
SceneDesc two_ropes(double apart, double bending_stiffness = 0) {
  SceneDesc scene = scenes::one_cable(25, 0.5);
  scene.materials[0].material.bending_stiffness = bending_stiffness;
  scene.materials[0].material.drag = 0.05;
  scene.cables.push_back(scene.cables[0]);
  scene.cables[0].name = "left";
  scene.cables[0].attachments = {scenes::attachment("a", PlaceDesc::At::start, {0, 0, 0})};
  scene.cables[1].name = "right";
  scene.cables[1].attachments = {scenes::attachment("b", PlaceDesc::At::start, {apart, 0, 0})};
  return scene;
}

double total_mass(const World& world) {
  double mass = 0;
  for (const SimulatedCable& cable : world.cables())
    mass += std::accumulate(cable.state.masses.begin(), cable.state.masses.end(), 0.0);
  return mass;
}

TEST(Join, EndsThatAreApartAreDrawnTogetherAndWelded) {
  for (const double bending : {0.0, 0.005}) {
    const SceneDesc scene = two_ropes(0.3, bending);
    World world(scene, initial_frames(scene));
    const double mass = total_mass(world);
    const EditResult joined = world.apply(edit::Join{0, true, 1, true});
    ASSERT_TRUE(joined.ok) << joined.message;
    EXPECT_EQ(joined.name, "left");
    ASSERT_EQ(world.cables().size(), 1u);
    for (int i = 0; i < 2000; ++i) ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
    const SimulatedCable& cable = world.cables()[0];
    EXPECT_EQ(cable.state.segments(), 50);
    EXPECT_NEAR(cable.state.length(), 1, 1e-12);
    EXPECT_NEAR(total_mass(world), mass, 1e-12);
    EXPECT_EQ(cable.state.positions.front(), Vector3(0, 0, 0));
    EXPECT_EQ(cable.state.positions.back(), Vector3(0.3, 0, 0));
    EXPECT_EQ(world.attachments()[1].node, 50);
    for (const double l : cable.state.rest_lengths) EXPECT_NEAR(l, 0.02, 1e-12);
  }
}

TEST(Join, UndoesACut) {
  const SceneDesc scene = scenes::between_two_points(50, 0.6);
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 20}).ok);
  for (int i = 0; i < 200; ++i) world.step({FrameInput{}});
  const EditResult joined = world.apply(edit::Join{1, false, 0, true});
  ASSERT_TRUE(joined.ok) << joined.message;
  EXPECT_EQ(joined.name, "cable_2");
  for (int i = 0; i < 3000; ++i) ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
  const SimulatedCable& cable = world.cables()[0];
  EXPECT_EQ(cable.state.segments(), 49);
  EXPECT_EQ(cable.state.positions.front(), Vector3(0, 0, 0)) << "the start is where the joined cable's start was";
  EXPECT_EQ(cable.state.positions.back(), Vector3(0.6, 0, 0));
}

TEST(Join, KeepsMomentumOfFreeCables) {
  SceneDesc scene = two_ropes(0.05, 0.005);
  scene.gravity.acceleration.setZero();
  scene.materials[0].material.drag = 0;
  for (CableDesc& cable : scene.cables) {
    cable.attachments.clear();
    cable.initial.type = InitialShapeDesc::Type::points;
  }
  scene.cables[0].initial.points = {{0, 0, 0}, {0.5, 0, 0}};
  scene.cables[0].initial.velocities = {{0, 0, 0.1}, {0.2, 0, 0}};
  scene.cables[1].initial.points = {{0.55, 0, 0.02}, {0.55, 0.5, 0.02}};
  scene.cables[1].initial.velocities = {{0, 0.1, 0}, {0, 0, 0}};
  World world(scene, initial_frames(scene));
  const auto momentum = [&world] {
    Vector3 sum = Vector3::Zero();
    for (const SimulatedCable& cable : world.cables())
      for (int i = 0; i < cable.state.nodes(); ++i) sum += cable.state.masses[i] * cable.state.velocities[i];
    return sum;
  };
  const Vector3 before = momentum();
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, false}).ok);
  EXPECT_LT((momentum() - before).norm(), 1e-12);
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(world.step({}).status, Status::ok) << i;
  EXPECT_EQ(world.cables()[0].state.segments(), 50);
  EXPECT_LT((momentum() - before).norm(), 1e-8);
}

TEST(Join, KeepsStretchedCablesAtTheirTension) {
  SceneDesc scene = two_ropes(0.99);
  scene.materials[0].material.axial_stiffness = 100;
  scene.gravity.acceleration.setZero();
  for (CableDesc& cable : scene.cables) cable.initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = {1, 0, 0};
  scene.cables[1].initial.from = {0.99, 0, 0};
  scene.cables[1].initial.to = {0, 0, 0};
  World world(scene, {FrameInput{}});
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, true}).ok);
  double highest = 0;
  for (int i = 0; i < 1000; ++i) {
    ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
    for (const double t : world.cables()[0].state.tension) highest = std::max(highest, t);
  }
  EXPECT_LT(highest, 5);  // 1 % of slack is all there is to pull on
}

TEST(Join, StiffEndsStayWithTheirMaterial) {
  SceneDesc scene = two_ropes(0.3, 0.005);
  scene.cables[0].stiff_ends = {0.05, 0.03};  // 25 segments of 0.02 m
  World world(scene, initial_frames(scene));
  const auto shares = [&](int cable) -> const std::vector<double>& { return world.cables()[cable].state.flexible_fraction; };
  const auto run = [&](int steps) {
    for (int i = 0; i < steps; ++i) ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
    for (const SimulatedCable& cable : world.cables()) {
      if (!cable.state.flexible_fraction.empty()) {
        EXPECT_EQ(cable.state.flexible_fraction.size(), cable.state.masses.size());
      }
      for (const Vector3& x : cable.state.positions) ASSERT_TRUE(x.allFinite());
    }
  };
  const auto softest_before = [&](int cable, int node) {
    return *std::max_element(shares(cable).begin(), shares(cable).begin() + node);
  };
  EXPECT_LT(softest_before(0, 2), 0.01);
  EXPECT_NEAR(shares(0)[2], 0.01 / 0.02, 0.51);
  EXPECT_EQ(shares(0)[10], 1);
  EXPECT_LT(shares(0)[25], 0.01);
  EXPECT_TRUE(shares(1).empty());
  run(100);

  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 12}).ok);  // the second piece is the last cable
  EXPECT_LT(softest_before(0, 2), 0.01);
  EXPECT_EQ(shares(0).back(), 1);
  EXPECT_EQ(shares(2).front(), 1);
  EXPECT_LT(shares(2).back(), 0.01);
  run(100);

  ASSERT_TRUE(world.apply(edit::Join{1, true, 0, true}).ok);  // turned round: its stiff end comes last
  run(1000);
  const int joined = find(world.cables(), "right");
  EXPECT_EQ(shares(joined)[5], 1);
  EXPECT_LT(shares(joined).back(), 0.01);
  EXPECT_LT(*(shares(joined).end() - 2), 0.01);

  // What is paid out at the stiff end bends.
  ASSERT_TRUE(world.apply(edit::SetLength{joined, true, 1, 0.5}).ok);
  run(1000);
  const int nodes = world.cables()[joined].state.nodes();
  EXPECT_EQ(shares(joined)[nodes - 2], 1);
}

TEST(Join, KeepsTheModelOfTheFirstAtEitherEnd) {
  SceneDesc scene = two_ropes(0.3);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].name = "other";
  scene.cables[1].material = "other";
  scene.cables[0].color = {1, 0, 0, 1};
  for (const bool at_end : {false, true}) {
    World world(scene, initial_frames(scene));
    ASSERT_TRUE(world.apply(edit::Unpin{"a"}).ok);
    const CableModel first = *world.cables()[0].model;
    ASSERT_TRUE(world.apply(edit::Join{0, at_end, 1, true}).ok);
    EXPECT_EQ(world.cables()[0].model->name, first.name);
    EXPECT_EQ(world.cables()[0].model->material_name, first.material_name);
    EXPECT_EQ(world.cables()[0].model->color, first.color);
  }
}

TEST(Join, CutsLeaveMoreThanTheGapThatCloses) {
  const SceneDesc scene = two_ropes(0.3);
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, true}).ok);
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 26}).ok);
  const std::uint64_t before = world.hash();
  const EditResult second = world.apply(edit::Cut{cable_id(0), 24});
  EXPECT_FALSE(second.ok);
  EXPECT_NE(second.message.find("still being drawn in"), std::string::npos) << second.message;
  EXPECT_EQ(world.hash(), before);
  // Ends that are drawn together at up to 2 m/s meet within 0.5 s.
  for (int i = 0; i < 500; ++i) ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
  EXPECT_EQ(world.cables()[0].state.segments(), 25);
}

TEST(Join, EndsThatAreBeingJoinedAreNotBothHeld) {
  const SceneDesc scene = two_ropes(0.3, 0.005);
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, true}).ok);
  ASSERT_TRUE(world
                  .apply(edit::Pin{"first",
                                   cable_id(0),
                                   25,
                                   0,
                                   {world.cables()[0].state.positions[25], Quaternion::Identity()},
                                   AttachmentType::clamp})
                  .ok);
  const std::uint64_t before = world.hash();
  const EditResult second = world.apply(edit::Pin{
      "second", cable_id(0), 26, 0, {world.cables()[0].state.positions[26], Quaternion::Identity()}, AttachmentType::clamp});
  EXPECT_FALSE(second.ok);
  EXPECT_NE(second.message.find("being joined to node 25"), std::string::npos) << second.message;
  EXPECT_EQ(world.hash(), before);
}

/// Which two clamps that turn a cable make a whole rod.
SceneDesc two_damped_ropes() {
  SceneDesc scene = two_ropes(0.3, 0.005);
  scene.materials[0].material.bending_damping = 1e-3;
  scene.materials[0].material.torsional_stiffness = 0.004;
  return scene;
}

/// Holds a node of the first cable where it is now.
edit::Pin pin_where_it_is(const World& world, int node, AttachmentType type) {
  edit::Pin pin;
  pin.body = cable_id(0);
  pin.node = node;
  pin.type = type;
  pin.pose.position = world.cables()[0].state.positions[node];
  return pin;
}

/// While its ends are drawn together, a damped cable may come to be twisted by clamps, and is a whole rod from then on.
TEST(Join, WhatBecomesAWholeRodOnTheWayIsWelded) {
  const SceneDesc scene = two_damped_ropes();
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, true}).ok);
  for (int i = 0; i < 5; ++i) world.step({FrameInput{}});
  for (const int node : {5, 10}) ASSERT_TRUE(world.apply(pin_where_it_is(world, node, AttachmentType::clamp)).ok);
  EXPECT_FALSE(world.cables()[0].state.directors.empty());
  for (int i = 0; i < 2000; ++i) ASSERT_NE(world.step({FrameInput{}}).status, Status::fault) << i;
  const CableState& cable = world.cables()[0].state;
  EXPECT_EQ(cable.segments(), 50);
  EXPECT_EQ(cable.rest_twist.size(), cable.positions.size());
}

/// A cut beside the gap that closes leaves an end without a joint.
TEST(Join, EndsOfWholeRodsThatAreCutOffBesideTheGapAreNotWelded) {
  for (const int cut : {24, 26}) {
    const SceneDesc scene = two_damped_ropes();
    World world(scene, initial_frames(scene));
    ASSERT_TRUE(world.apply(edit::Join{0, true, 1, true}).ok);
    for (const int node : cut < 25 ? std::array{35, 45} : std::array{5, 15})
      ASSERT_TRUE(world.apply(pin_where_it_is(world, node, AttachmentType::clamp)).ok);
    ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), cut}).ok);
    const int with_gap = cut < 25 ? 1 : 0;
    EXPECT_FALSE(world.cables()[with_gap].state.directors.empty());
    for (int i = 0; i < 2000; ++i) ASSERT_NE(world.step({FrameInput{}}).status, Status::fault) << i;
    EXPECT_EQ(world.cables()[with_gap].state.segments(), 25);
    EXPECT_TRUE(world.cables()[with_gap].state.rest_twist.empty());
  }
}

/// What was pulled beyond its limit in the segment that a cut takes is told of the next one, also when numbers turn round.
TEST(Join, PlacesOfExcursionsStayOnTheirCables) {
  SceneDesc scene = scenes::one_cable(10);
  scene.materials[0].material.maximum_tension = 1e-3;
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(pin_where_it_is(world, 5, AttachmentType::hinge)).ok);
  while (world.findings().excursions.empty() && world.time() < 1) world.step({FrameInput{}});
  ASSERT_FALSE(world.findings().excursions.empty());
  const int pulled = world.findings().excursions[0].node;
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), pulled}).ok);
  ASSERT_TRUE(world.apply(edit::Join{0, false, 1, true}).ok);
  for (const Excursion& excursion : world.findings().excursions) {
    EXPECT_GE(excursion.node, 0);
    EXPECT_LT(excursion.node, world.cables()[excursion.cable].state.segments());
  }
}

TEST(Join, BadRequestsChangeNothing) {
  SceneDesc scene = two_ropes(1.2);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].name = "other";
  scene.materials[1].material.bending_stiffness = 0.1;
  scene.cables.push_back(scene.cables[0]);
  scene.cables[2].name = "third";
  scene.cables[2].attachments[0].name = "c";
  scene.cables[2].material = "other";
  World world(scene, initial_frames(scene));
  const std::uint64_t before = world.hash();
  const auto refused = [&](int first, bool first_at_end, int second, bool second_at_end, const char* part) {
    const EditResult result = world.apply(edit::Join{first, first_at_end, second, second_at_end});
    EXPECT_FALSE(result.ok);
    EXPECT_NE(result.message.find(part), std::string::npos) << result.message;
  };
  refused(-1, true, 1, true, "cable: -1");
  refused(0, true, 3, true, "cable: 3");
  refused(0, true, 0, false, "another cable");
  refused(0, true, 2, true, "bending_stiffness 0 and 0.1");
  refused(0, false, 1, false, "a and b");
  refused(0, true, 1, true, "cannot meet");
  EXPECT_EQ(world.hash(), before);
}

}  // namespace
}  // namespace verlet_cable
