#include "edit_requests/named_edits.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "../support/nets.h"
#include "edit_requests/error_text.h"
#include "edit_requests/location.h"
#include "edit_requests/tunable_numbers.h"
#include "straight_cables.h"

namespace verlet_cable {
namespace {

/// `upper` begins behind the end of `lower`; `late` waits for a frame. A net of three nodes.
World cables_and_net() {
  SceneDesc scene = straight_cables({{"lower", {0, 0, 0}}, {"upper", {1.01, 0, 0}}, {"late", {0, 0, 1}}});
  CableDesc& late = scene.cables.back();
  late.initial = {};
  AttachmentDesc& attachment = late.attachments.emplace_back();
  attachment.name = "late_start";
  attachment.frame = "unseen";
  scene.nets = {scenes::chain({{0, 5, 0}, {1, 5, 0}, {2, 5, 0}}, LinkType::spring)};
  return World(scene, initial_frames(scene));
}

std::optional<Pose> only_the_fixed_frame(const std::string& frame) {
  return frame == "world" ? std::optional<Pose>(Pose{}) : std::nullopt;
}

Location cut_place(const World& world, const std::string& cable, int node) {
  return locate_cut(at_node(cable, node), world, only_the_fixed_frame);
}

TEST(RequestedPlace, NumbersThatNoMessageCanHoldAreRefusedLikeOthers) {
  const World world = cables_and_net();
  const auto errors = [&](const RequestedPlace& place) { return join(locate_node(place, world, only_the_fixed_frame).errors); };
  EXPECT_EQ(errors(at_node("lower", -1)), "location.node: -1; allowed: 0 to 10");
  EXPECT_EQ(errors(at_node("lower", std::int64_t{1} << 32)), "location.node: 4294967296; allowed: 0 to 10");
  EXPECT_EQ(errors(at_node("chain", -1)), "location.node: -1; allowed: 0 to 2");
  EXPECT_EQ(errors(at_node("chain", std::int64_t{1} << 32)), "location.node: 4294967296; allowed: 0 to 2");
  EXPECT_EQ(join(cut_place(world, "chain", 3).errors), "location.node: 3; allowed: 0 to 2");
  RequestedPlace place = at_node("lower", 3);
  place.mode = -1;
  EXPECT_EQ(errors(place), "location.mode: -1; allowed: 0 (NODE), 1 (ARC_LENGTH), 2 (NEAREST)");
}

TEST(NamedEdits, APinAddsItsFrameAndIsReleased) {
  World world = cables_and_net();
  RequestedPin request;
  request.place = at_node("lower", 10);
  request.keep_offset = true;
  request.frame_id = "hand";
  const CheckedPin pin = check_pin(request, world, [](const std::string&) {
    return Pose{Vector3(2, 0, 0), Quaternion::Identity()};
  });
  ASSERT_EQ(join(pin.errors), "");
  EXPECT_LT((pin.offset.position + Vector3::UnitX()).norm(), 1e-12);
  const EditResult pinned = apply_pin(world, "", pin, AttachmentType::hinge);
  ASSERT_TRUE(pinned.ok) << pinned.message;
  EXPECT_EQ(pinned.name, "pin1");
  EXPECT_EQ(pinned.message, "node 10 of cable \"lower\" is pinned to frame \"hand\" as \"pin1\"");
  EXPECT_EQ(world.frames().back(), "hand");
  const EditResult released = apply_unpin(world, "pin1");
  EXPECT_TRUE(released.ok);
  EXPECT_EQ(released.message, "attachment \"pin1\" is released");
  EXPECT_EQ(apply_unpin(world, "pin1").message,
            "name: \"pin1\" is no attachment; allowed: lower_start; what still waits for its frames has none yet");
}

TEST(NamedEdits, APinThatTheWorldRefusesAddsNoFrame) {
  World world = cables_and_net();
  CheckedPin pin;
  pin.body = cable_id(0);
  pin.frame = "hand";
  const std::uint64_t before = world.hash();
  const std::size_t frames = world.frames().size();
  EXPECT_FALSE(apply_pin(world, "second", pin, AttachmentType::hinge).ok) << "node 0 is held";
  EXPECT_EQ(world.frames().size(), frames);
  EXPECT_EQ(world.hash(), before);
}

TEST(NamedEdits, AnAttachmentIsMovedInItsFrame) {
  World world = cables_and_net();
  const std::uint64_t before = world.hash();
  EXPECT_EQ(apply_move(world, "pin1", {}).message,
            "name: \"pin1\" is no attachment; allowed: lower_start; what still waits for its frames has none yet");
  const Pose turned{Vector3::Zero(), Quaternion(2, 0, 0, 0)};
  EXPECT_EQ(apply_move(world, "lower_start", turned).message,
            "offset.orientation: (0, 0, 0, 2); allowed: quaternions of length 1, or all zero for no rotation");
  EXPECT_EQ(world.hash(), before);
  const EditResult moved = apply_move(world, "lower_start", {Vector3(0, 0, 0.1), Quaternion(0, 0, 0, 0)});
  ASSERT_TRUE(moved.ok) << moved.message;
  EXPECT_EQ(world.attachments()[0].pose.position, Vector3(0, 0, 0.1));
}

TEST(Tuning, EveryErrorIsToldAtOnce) {
  SceneDesc scene;
  scene.materials.resize(1);
  scene.materials[0].name = "rope";
  const std::vector<TunableNumber> numbers = tunable_numbers(scene);
  try {
    tuned_scene(scene, numbers, {{"wind_x", NAN}, {"rope_mass", 1}, {"rope_friction", -1}}, {"an earlier one"});
    FAIL();
  } catch (const SceneError& error) {
    ASSERT_EQ(error.errors().size(), 4u);
    EXPECT_EQ(error.errors()[0], "an earlier one");
    EXPECT_EQ(error.errors()[1].find("tuning.wind_x: nan; allowed: "), 0u);
    EXPECT_EQ(error.errors()[2].find("tuning: unknown parameter \"rope_mass\"; allowed: gravity_x, gravity_y, "), 0u);
    EXPECT_EQ(error.errors()[3].find("tuning.rope_friction: -1; allowed: "), 0u);
  }
}

std::vector<std::string> tuning_errors(const SceneDesc& scene, const std::vector<NumberChange>& changes) {
  try {
    tuned_scene(scene, tunable_numbers(scene), changes, {});
  } catch (const SceneError& error) {
    return error.errors();
  }
  return {};
}

TEST(Tuning, WhatIsInfiniteStaysSo) {
  SceneDesc scene;
  scene.materials.resize(1);
  scene.materials[0].name = "rope";
  const std::vector<std::string> errors = tuning_errors(scene, {{"rope_yield_curvature", 5}});
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].find("tuning.rope_yield_curvature: 5; allowed: .inf, which it is in the scene"), 0u) << errors[0];
}

/// What was asked for is named, and not only what it contradicts.
TEST(Tuning, ConflictsNameWhatWasTuned) {
  SceneDesc scene = straight_cables({{"cable", {0, 0, 0}}});
  scene.materials[0].material.bending_stiffness = {0.1, 0.1};
  scene.materials[0].material.yield_curvature = 3;
  EXPECT_TRUE(tuning_errors(scene, {{"rope_bending_stiffness", 0.2}}).empty());
  const std::vector<std::string> errors = tuning_errors(scene, {{"rope_bending_stiffness", 0}});
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_EQ(errors[0].find("tuning.rope_bending_stiffness: 0; does not go with materials.rope.yield_curvature: 3; allowed: .inf"),
            0u)
      << errors[0];
}

TEST(Tuning, OfMillionsOfUnknownParametersAHundredAreNamed) {
  SceneDesc scene;
  try {
    tuned_scene(scene, tunable_numbers(scene), std::vector<NumberChange>(1000, {"x", 1}), {});
    FAIL();
  } catch (const SceneError& error) {
    ASSERT_EQ(error.errors().size(), 101u);
    EXPECT_EQ(error.errors().back(), "tuning: 900 more unknown parameters");
  }
}

TEST(Tuning, GravityIsTunedWhereItIsUniform) {
  SceneDesc scene;
  EXPECT_EQ(tunable_numbers(scene).front().name, "gravity_x");
  scene.gravity.type = GravityDesc::Type::central;
  EXPECT_EQ(tunable_numbers(scene).front().name, "wind_x");
}

TEST(NamedEdits, ACutNextToANetIsAtAnEndOfTheNearestLink) {
  World world = cables_and_net();
  RequestedPlace place;
  place.cable = "chain";
  place.mode = RequestedPlace::nearest;
  for (const auto& [x, node] : {std::pair(1.4, 1), std::pair(1.6, 2)}) {
    place.point = {x, 5, 0.1};
    const Location found = locate_cut(place, world, only_the_fixed_frame);
    EXPECT_EQ(found.elements, std::vector<int>{1});
    EXPECT_EQ(found.node, node);
  }
}

TEST(NamedEdits, ACutSaysWhatIsGone) {
  World world = cables_and_net();
  const Location place = cut_place(world, "lower", 4);
  const PlacedEdit cut = apply_cut(world, place);
  EXPECT_TRUE(cut.result.ok);
  EXPECT_EQ(cut.node, 4);
  EXPECT_EQ(cut.result.name, "lower_2");
  EXPECT_EQ(cut.result.message,
            "segment 4 of cable \"lower\" is cut out: the part from there to its end is now cable \"lower_2\"");
}

TEST(NamedEdits, ACutAtANodeOfANetRemovesAllItsLinks) {
  World world = cables_and_net();
  const Location middle = cut_place(world, "chain", 1);
  EXPECT_EQ(middle.elements, (std::vector<int>{0, 1}));
  const PlacedEdit cut = apply_cut(world, middle);
  EXPECT_TRUE(cut.result.ok);
  EXPECT_EQ(cut.node, 1);
  EXPECT_EQ(cut.result.message, "2 links of net \"chain\" cut");
  EXPECT_TRUE(world.nets()[0].model.links.empty());
  EXPECT_EQ(join(cut_place(world, "chain", 1).errors),
            "location: net \"chain\" has no link there; allowed: nodes that links join");
}

/// One node of `lower` and one of `upper` are held where they are.
World held_at(const std::array<int, 2>& nodes) {
  World world = cables_and_net();
  for (const int cable : {0, 1}) {
    edit::Pin pin;
    pin.body = cable_id(cable);
    pin.node = nodes[cable];
    pin.pose.position = world.cables()[cable].state.positions[nodes[cable]];
    EXPECT_TRUE(world.apply(pin).ok);
  }
  return world;
}

TEST(NamedEdits, AWinchTellsHowLongItTakes) {
  World world = held_at({10, 10});
  EXPECT_EQ(apply_set_length(world, "lower", true, 1.5, 0.25).message,
            "cable \"lower\" is paid out from 1 m to 1.5 m, which takes at least 2 s");
  EXPECT_EQ(apply_set_length(world, "upper", true, 0.75, 0.25).message,
            "cable \"upper\" is taken in from 1 m to 0.75 m, which takes at least 1 s");
  EXPECT_EQ(apply_set_length(world, "upper", true, 0.75, 0.25, 12).message,
            "cable \"upper\" is taken in from 1 m to 0.75 m, which takes at least 1 s, with at most 12 N");
}

TEST(NamedEdits, AWinchTellsWhatItKeeps) {
  World world = held_at({10, 0});
  EXPECT_EQ(apply_set_tension(world, "lower", {0, true, 12.5, 0.5, 0.1, infinity}).message,
            "the winch at the end of cable \"lower\" keeps 12.5 N, at up to 0.5 m/s");
  EXPECT_EQ(apply_set_tension(world, "upper", {0, false, 0, 0.5, 0.1, 2}).message,
            "the winch at the start of cable \"upper\" turns freely, at up to 0.5 m/s");
}

TEST(NamedEdits, CablesAreJoinedByName) {
  for (const bool lower_first : {true, false}) {
    World world = cables_and_net();
    const PlacedEdit joined =
        lower_first ? apply_join(world, "lower", true, "upper", false) : apply_join(world, "upper", false, "lower", true);
    ASSERT_TRUE(joined.result.ok) << joined.result.message;
    EXPECT_EQ(joined.node, 10);
    EXPECT_EQ(joined.result.name, lower_first ? "lower" : "upper");
    EXPECT_EQ(joined.result.message,
              lower_first ? "cable \"upper\" is joined to \"lower\"" : "cable \"lower\" is joined to \"upper\"");
  }
}

TEST(NamedEdits, CablesThatAreNotThereAreRefused) {
  World world = cables_and_net();
  const std::uint64_t before = world.hash();
  EXPECT_EQ(apply_set_length(world, "hose", true, 1, 1).message, "cable: \"hose\"; allowed: lower, upper");
  EXPECT_EQ(apply_set_length(world, "late", true, 1, 1).message,
            "cable: \"late\" waits for its tf frames; allowed: cables that are simulated already");
  EXPECT_EQ(apply_set_tension(world, "hose", {0, true, 1, 1, 0.1, 2}).message, "cable: \"hose\"; allowed: lower, upper");
  EXPECT_EQ(apply_join(world, "hose", true, "late", true).result.message, "first: \"hose\"; allowed: lower, upper");
  EXPECT_EQ(apply_join(world, "lower", true, "late", true).result.message,
            "second: \"late\" waits for its tf frames; allowed: cables that are simulated already");
  EXPECT_FALSE(apply_join(world, "lower", true, "lower", false).result.ok);
  EXPECT_EQ(world.hash(), before);
  World empty{SceneDesc{}};
  EXPECT_EQ(apply_set_length(empty, "hose", true, 1, 1).message, "cable: \"hose\"; allowed: none, there are no cables");
  EXPECT_EQ(apply_unpin(empty, "pin1").message, "name: \"pin1\" is no attachment; allowed: none, nothing is attached");
}

}  // namespace
}  // namespace verlet_cable
