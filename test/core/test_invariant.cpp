#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <string>
#include <tuple>

#include "../support/scenes.h"
#include "../support/world_inspector.h"
#include "world/invariant.h"

// Whatever is done to cables, their arrays are as long as they are, and they have frames if they need them.

namespace verlet_cable {
namespace {

/// A rope, a spare one, and a trunk with a branch, all of one material; the trunk is clamped.
SceneDesc harness(JunctionDesc::Type type, double at, double torsional_stiffness = 0) {
  SceneDesc scene = scenes::one_cable(20);
  MaterialDesc& rope = scene.materials[0].material;
  rope.bending_stiffness = 0.002;
  rope.torsional_stiffness = torsional_stiffness;
  rope.drag = 0.1;
  const auto add = [&](const std::string& name, const AttachmentDesc& held) {
    CableDesc& cable = scene.cables.emplace_back(scene.cables[0]);
    cable.name = name;
    cable.attachments = {held};
  };
  add("spare", scenes::attachment("b", PlaceDesc::At::end, {0.3, 0, 1.2}));
  add("trunk", scenes::attachment("t", PlaceDesc::At::start, {0, 0.3, 2}, "", AttachmentType::clamp));
  add("leg", {});
  scene.cables[0].attachments = {scenes::attachment("a", PlaceDesc::At::start, {0, 0, 2})};
  scene.cables[3].attachments.clear();
  scene.cables[3].length = 0.4;
  scene.cables[3].segments = 8;
  JunctionDesc& fork = scene.junctions.emplace_back();
  fork.name = "fork";
  fork.type = type;
  fork.cable = "trunk";
  fork.place.at = PlaceDesc::At::arc_length;
  fork.place.arc_length = at;
  BranchDesc& branch = fork.branches.emplace_back();
  branch.cable = "leg";
  branch.rotation = {0, 1, 0};
  return scene;
}

/// What becomes of a harness's pieces: joined with ropes that never were parts of one, and again with others.
class Pieces : public testing::TestWithParam<std::tuple<JunctionDesc::Type, double, int, double>> {};

TEST_P(Pieces, AreJoinedAgainAndAgain) {
  const auto [type, at, cut, torsional_stiffness] = GetParam();
  const SceneDesc scene = harness(type, at, torsional_stiffness);
  World world(scene, initial_frames(scene));
  const State& state = WorldInspector::state(world);
  ASSERT_EQ(violation(state), "");
  const auto run = [&] {
    for (int i = 0; i < 3000; ++i) {
      ASSERT_NE(world.step(initial_frames(scene)).status, StepResult::Status::fault);
      ASSERT_EQ(violation(state), "");
    }
  };
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(find(world.cables(), "trunk")), cut}).ok);
  ASSERT_EQ(violation(state), "");
  for (const char* other : {"trunk_2", "spare"}) {
    const EditResult joined = world.apply(edit::Join{find(world.cables(), "cable"), true, find(world.cables(), other), false});
    ASSERT_TRUE(joined.ok) << joined.message;
    ASSERT_EQ(violation(state), "");
    run();
  }
  EXPECT_EQ(world.cables()[find(world.cables(), "cable")].state.segments(), 20 + 19 - cut + 20);
}

INSTANTIATE_TEST_SUITE_P(Places, Pieces,
                         testing::Combine(testing::Values(JunctionDesc::Type::rigid, JunctionDesc::Type::hinge),
                                          testing::Values(0.25, 0.5), testing::Values(3, 15), testing::Values(0.0, 0.001)));

/// A piece that nothing asks frames of has none; the one at the junction keeps its own.
TEST(Frames, AreThoseOfThePieceAtTheJunction) {
  const SceneDesc scene = harness(JunctionDesc::Type::rigid, 0.5);
  World world(scene, initial_frames(scene));
  const int trunk = find(world.cables(), "trunk");
  ASSERT_FALSE(world.cables()[trunk].state.directors.empty());
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(trunk), 15}).ok);
  EXPECT_FALSE(world.cables()[trunk].state.directors.empty());
  EXPECT_TRUE(world.cables().back().state.directors.empty());
  EXPECT_FALSE(world.cables().back().model->turns_bodies);
}

struct Feature {
  const char* name;
  std::function<void(SceneDesc&)> add;
};

void add_to_all(SceneDesc& scene, const std::function<void(CableDesc&)>& change) {
  for (CableDesc& cable : scene.cables) change(cable);
}

void add_body(SceneDesc& scene, AttachmentType type) {
  BodyDesc& plug = scene.bodies.emplace_back();
  plug.name = "plug";
  plug.mass = 0.05;
  plug.inertia = {1e-4, 1e-4, 1e-4};
  AttachmentDesc& plugged = scene.cables[0].attachments.emplace_back(scenes::attachment("p", PlaceDesc::At::end, {0, 0, 0}));
  plugged.body = "plug";
  plugged.type = type;
}

void add_section(SceneDesc& scene, const std::function<void(MaterialDesc&)>& change) {
  scene.materials.push_back({"other", scene.materials[0].material});
  change(scene.materials.back().material);
  for (CableDesc& cable : scene.cables) cable.sections = {{0.1, 0.25, "other"}};
}

const Feature features[] = {
    {"Plain", [](SceneDesc&) {}},
    {"Hinged", [](SceneDesc& scene) { scene.junctions[0].type = JunctionDesc::Type::hinge; }},
    {"Limp", [](SceneDesc& scene) { scene.materials[0].material.bending_stiffness = 0; }},
    {"ClampedBody", [](SceneDesc& scene) { add_body(scene, AttachmentType::clamp); }},
    {"HingedBody", [](SceneDesc& scene) { add_body(scene, AttachmentType::hinge); }},
    {"Ribbon",
     [](SceneDesc& scene) {
       scene.materials[0].material.bending_stiffness = {0.002, 0.01};
       scene.materials[0].material.torsional_stiffness = 0.001;
     }},
    {"RibbonSection",
     [](SceneDesc& scene) {
       scene.materials[0].material.torsional_stiffness = 0.001;
       add_section(scene, [](MaterialDesc& m) { m.bending_stiffness = {0.002, 0.01}; });
     }},
    {"LimitedSection", [](SceneDesc& scene) { add_section(scene, [](MaterialDesc& m) { m.maximum_tension = 0.1; }); }},
    {"Torsion", [](SceneDesc& scene) { scene.materials[0].material.torsional_stiffness = 0.001; }},
    {"RestTwist",
     [](SceneDesc& scene) {
       scene.materials[0].material.torsional_stiffness = 0.001;
       scene.cables[1].rest_twist = 3;
     }},
    {"RestCurvature",
     [](SceneDesc& scene) {
       scene.materials[0].material.torsional_stiffness = 0.001;
       scene.cables[1].rest_curvature.type = RestCurvatureDesc::Type::constant;
       scene.cables[1].rest_curvature.curvature = {1, 2};
     }},
    {"StiffEnds", [](SceneDesc& scene) { add_to_all(scene, [](CableDesc& cable) {
                                           cable.stiff_ends = {0.03, 0.04};
                                         }); }},
    {"Eyelet",
     [](SceneDesc& scene) {
       GuideDesc& eye = scene.guides.emplace_back();
       eye.name = "eye";
       eye.cable = "cable";
       eye.place = PlaceDesc{PlaceDesc::At::arc_length, 0.5};
       eye.offset = {0, 0, 1.5};
     }},
};

class AnyEdits : public testing::TestWithParam<Feature> {};

TEST_P(AnyEdits, KeepTheInvariant) {
  int done = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SceneDesc scene = harness(JunctionDesc::Type::rigid, 0.5);
    GetParam().add(scene);
    World world(scene, initial_frames(scene));
    const State& state = WorldInspector::state(world);
    std::minstd_rand random(seed);
    const auto any = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
    for (int round = 0; round < 25; ++round) {
      const int cables = static_cast<int>(world.cables().size()), cable = any(cables);
      const int segments = world.cables()[cable].state.segments();
      EditResult result;
      switch (any(7)) {
        case 0:
        case 1:
          result = world.apply(edit::Cut{cable_id(cable), any(segments)});
          break;
        case 2:
        case 3:
          result = world.apply(edit::Join{cable, any(2) == 0, any(cables), any(2) == 0});
          break;
        case 4:
          result =
              world.apply(edit::SetLength{cable, any(2) == 0, world.cables()[cable].state.length() * (0.6 + 0.1 * any(8)), 1});
          break;
        case 5: {  // where it is, be it at a junction
          edit::Pin pin;
          pin.body = cable_id(cable);
          pin.node = any(segments + 1);
          pin.pose.position = world.cables()[cable].state.positions[pin.node];
          result = world.apply(pin);
          break;
        }
        default:
          result = world.apply(edit::Unpin{world.attachments().empty()
                                               ? std::string("none")
                                               : world.attachments()[any(static_cast<int>(world.attachments().size()))].name});
      }
      done += result.ok ? 1 : 0;
      ASSERT_EQ(violation(state), "") << "seed " << seed << ", round " << round;
      for (int i = 0; i < 30; ++i) {
        ASSERT_NE(world.step(initial_frames(scene)).status, StepResult::Status::fault) << "seed " << seed;
        ASSERT_EQ(violation(state), "") << "seed " << seed << ", round " << round;
      }
    }
  }
  EXPECT_GT(done, 30);
}

INSTANTIATE_TEST_SUITE_P(Features, AnyEdits, testing::ValuesIn(features), [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace verlet_cable
