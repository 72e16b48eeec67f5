#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

#include "../support/scenes.h"
#include "contact/segment_grid.h"

// Cables that many bodies, junctions and guides hold: what a step takes stays in proportion, or is refused.

namespace verlet_cable {
namespace {

constexpr double spacing = 0.1;  // [m] two segments

PlaceDesc place_at(double arc_length) {
  PlaceDesc place;
  place.at = PlaceDesc::At::arc_length;
  place.arc_length = arc_length;
  return place;
}

/// Straight along x, with room for so many places at equal distances.
SceneDesc trunk(int places, double bending_stiffness) {
  const double length = spacing * (places + 1);
  SceneDesc scene = scenes::one_cable(2 * (places + 1), length);
  scene.materials[0].material.bending_stiffness = bending_stiffness;
  scene.materials[0].material.torsional_stiffness = bending_stiffness;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = {length, 0, 0};
  scene.cables[0].attachments = {scenes::attachment("base", PlaceDesc::At::start, Vector3::Zero())};
  return scene;
}

SceneDesc with_bodies(int bodies, double bending_stiffness) {
  SceneDesc scene = trunk(bodies, bending_stiffness);
  for (int i = 1; i <= bodies; ++i) {
    BodyDesc& body = scene.bodies.emplace_back();
    body.name = "body" + std::to_string(i);
    body.mass = 0.01;
    body.inertia = 1e-6 * Vector3::Ones();
    body.pose = InitialPose{spacing * i, 0, 0, 0, 0, 0};
    AttachmentDesc hinge = scenes::attachment("on_" + body.name, PlaceDesc::At::arc_length, Vector3::Zero());
    hinge.place = place_at(spacing * i);
    hinge.body = body.name;
    scene.cables[0].attachments.push_back(hinge);
  }
  return scene;
}

SceneDesc with_branches(int branches, JunctionDesc::Type type) {
  SceneDesc scene = trunk(branches, 0.01);
  for (int i = 1; i <= branches; ++i) {
    CableDesc& branch = scene.cables.emplace_back();
    branch.name = "branch" + std::to_string(i);
    branch.length = 0.2;
    branch.segments = 3;
    branch.material = "rope";
    BranchDesc end;
    end.cable = branch.name;
    end.rotation = {0, 0, 1};
    JunctionDesc& junction = scene.junctions.emplace_back();
    junction.name = "fork" + std::to_string(i);
    junction.cable = "cable";
    junction.place = place_at(spacing * i);
    junction.type = type;
    junction.branches = {end};
  }
  return scene;
}

SceneDesc with_guides(int guides) {
  SceneDesc scene = trunk(2 * guides, 0);
  for (int i = 1; i <= guides; ++i) {
    GuideDesc& eyelet = scene.guides.emplace_back();
    eyelet.name = "eyelet" + std::to_string(i);
    eyelet.cable = "cable";
    eyelet.place = place_at(2 * spacing * i);
    eyelet.offset = {2 * spacing * i, 0, 0};
  }
  return scene;
}

void expect_refused(const SceneDesc& scene, const std::string& count) {
  try {
    const World world(scene, initial_frames(scene));
    FAIL() << "not refused";
  } catch (const SceneError& error) {
    ASSERT_EQ(error.errors().size(), 1u);
    EXPECT_EQ(error.errors()[0].rfind("cables[0]: " + count + " guides, bodies and junctions on \"cable\"", 0), 0u)
        << error.errors()[0];
  }
}

void expect_accepted(const SceneDesc& scene) {
  EXPECT_NO_THROW(World(scene, initial_frames(scene)));
}

TEST(CoupledPlaces, BodiesOnACableThatBendsAreLimited) {
  expect_accepted(with_bodies(100, 0.01));
  expect_refused(with_bodies(101, 0.01), "101");
  expect_accepted(with_bodies(300, 0));
}

TEST(CoupledPlaces, ClampsDivideACable) {
  SceneDesc scene = with_bodies(150, 0.01);
  AttachmentDesc clamp = scenes::attachment("middle", PlaceDesc::At::arc_length, {7.55, 0, 0}, "", AttachmentType::clamp);
  clamp.place = place_at(7.55);
  scene.cables[0].attachments.push_back(clamp);
  expect_accepted(scene);
  scene.cables[0].attachments.back().type = AttachmentType::hinge;
  expect_refused(scene, "150");
}

TEST(CoupledPlaces, HingedJunctionsAreLimitedAndRigidOnesAreNot) {
  expect_refused(with_branches(101, JunctionDesc::Type::hinge), "101");
  expect_accepted(with_branches(101, JunctionDesc::Type::rigid));
}

TEST(CoupledPlaces, GuidesAreLimited) {
  expect_accepted(with_guides(100));
  expect_refused(with_guides(101), "101");
  SceneDesc scene = with_guides(99);
  for (const double at : {0.1, 0.3}) {
    CableDesc& branch = scene.cables.emplace_back();
    branch.name = "branch_at_" + std::to_string(static_cast<int>(10 * at));
    branch.length = 0.2;
    branch.segments = 3;
    branch.material = "rope";
    BranchDesc end;
    end.cable = branch.name;
    JunctionDesc& junction = scene.junctions.emplace_back();
    junction.name = "fork_at_" + std::to_string(static_cast<int>(10 * at));
    junction.cable = "cable";
    junction.place = place_at(at);
    junction.branches = {end};
  }
  expect_refused(scene, "101");
}

/// [s] of processor time that an iteration takes, the fastest of some steps.
double iteration_time(const SceneDesc& scene) {
  World world(scene, initial_frames(scene));
  double least = infinity;
  for (int i = 0; i < 5; ++i) {
    const std::clock_t start = std::clock();
    const StepResult result = world.step(initial_frames(scene));
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC * 1000 / result.iterations);
  }
  return least;
}

/// Of all cables: in a harness that is four times as large, four times as many have a part in an iteration.
TEST(CoupledPlaces, TimeOfAStepGrowsInProportionToRigidJunctions) {
  const double few = iteration_time(with_branches(150, JunctionDesc::Type::rigid));
  const double many = iteration_time(with_branches(600, JunctionDesc::Type::rigid));
  EXPECT_LT(many, 3 * few) << "an iteration of a cable, which should take as long in both";
}

/// Without a limit 600 cables in one place would have 180,000 pairs, and ten times as many a hundred times that.
TEST(HeapedUpSegments, AreWatchedForTheNearestOthersOnly) {
  constexpr int count = 600, most = 256;
  SceneDesc scene = scenes::one_cable(1, 0.1);
  const CableDesc first = scene.cables[0];
  scene.cables.clear();
  for (int i = 0; i < count; ++i) {
    CableDesc cable = first;
    cable.name += std::to_string(i);
    cable.initial.type = InitialShapeDesc::Type::straight;
    cable.initial.from = {0, 1e-6 * i, 0};
    cable.initial.to = {0.1, 1e-6 * i, 0};
    scene.cables.push_back(cable);
  }
  const World world(scene, initial_frames(scene));
  std::vector<int> all;
  for (int i = 0; i < count; ++i) all.push_back(i);
  SegmentGrid grid;
  SegmentPairs found;
  grid.update(world.cables(), all, {false, true}, 1e-3, 1e-3, found);
  std::size_t expected = 0;
  for (int i = 0; i < count; ++i) expected += std::min(most, count - 1 - i);
  ASSERT_EQ(found.pairs.size(), expected);
  for (std::size_t k = 0; k < found.pairs.size(); ++k) {
    const SegmentPairs::Pair& pair = found.pairs[k];
    ASSERT_LE(pair.second.cable - pair.first.cable, most) << "one further away";
    if (k == 0) continue;
    const SegmentPairs::Pair& before = found.pairs[k - 1];
    ASSERT_LT(std::make_pair(before.first.cable, before.second.cable), std::make_pair(pair.first.cable, pair.second.cable));
  }
}

}  // namespace
}  // namespace verlet_cable
