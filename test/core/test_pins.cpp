#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/scenes.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

edit::Pin pin_where_it_is(const World& world, int cable, int node, AttachmentType type = AttachmentType::hinge) {
  const CableState& state = world.cables()[cable].state;
  edit::Pin pin;
  pin.name = "pin";
  pin.body = cable_id(cable);
  pin.node = node;
  pin.pose = {state.positions[node], segment_orientations(state)[std::min(node, state.segments() - 1)]};
  pin.type = type;
  return pin;
}

GuideDesc guide(double at, const Vector3& offset) {
  GuideDesc desc;
  desc.name = "eye";
  desc.cable = "cable";
  desc.place = PlaceDesc{PlaceDesc::At::arc_length, at};
  desc.offset = offset;
  return desc;
}

/// From a holder to an eyelet, and hanging down behind it.
SceneDesc through_eyelet(double friction) {
  SceneDesc scene = scenes::one_cable(40, 2);
  scene.cables[0].attachments = {scenes::attachment("start", PlaceDesc::At::start, {0, 0, 1})};
  scene.guides = {guide(0.8, {0.7, 0, 1})};
  scene.guides[0].friction = friction;
  return scene;
}

/// Over a wheel, with a heavier load on one side.
SceneDesc over_wheel(double bearing_friction) {
  SceneDesc scene = scenes::one_cable(40, 2);
  CableDesc& cable = scene.cables[0];
  cable.point_masses = {scenes::payload(0.5), scenes::payload(0.6)};
  cable.point_masses[1].place.at = PlaceDesc::At::start;
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {{-0.05, 0, -0.93}, {-0.05, 0, 0}, {0, 0, 0.05}, {0.05, 0, 0}, {0.05, 0, -0.93}};
  scene.guides = {guide(1, Vector3::Zero())};
  scene.guides[0].type = GuideDesc::Type::sheave;
  scene.guides[0].rotation = {0.5 * M_PI, 0, 0};
  scene.guides[0].radius = 0.05;
  scene.guides[0].bearing_friction = bearing_friction;
  return scene;
}

double weight(const World& world) {
  double weight = 0;
  for (const double mass : world.cables()[0].state.masses) weight += 9.81 * mass;
  return weight;
}

/// Two neighbours that are held further apart than they are long feel the tension of what is between them.
TEST(Pins, NeighboursFeelWhatIsStrainedBetweenThem) {
  for (const bool one_by_one : {false, true}) {
    SceneDesc scene = scenes::one_cable(5);
    scene.materials[0].material.axial_stiffness = 1000;
    scene.gravity.acceleration.setZero();
    scene.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 0}),
                                   scenes::attachment("next", PlaceDesc::At::arc_length, {0, 0, -0.202})};
    scene.cables[0].attachments[1].place.arc_length = 0.2;
    World world(scene, initial_frames(scene));
    world.step_one_by_one(one_by_one);
    ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok);
    EXPECT_NEAR(world.cables()[0].state.tension.front(), 10, 1e-6);
    EXPECT_NEAR(world.attachments()[1].force.z(), 10, 1e-6);
  }
}

TEST(Pins, areRefusedBesideGuides) {
  for (const SceneDesc& scene : {through_eyelet(0.1), over_wheel(0)}) {
    World start(scene, {});
    ASSERT_EQ(start.step({}).status, Status::ok);
    const std::vector<double> arc_length = start.cables()[0].state.arc_length();
    const Attachment& eye = start.attachments()[find(start.attachments(), "eye")];
    const int last = is_wheel(eye) ? eye.node + 1 : eye.node;
    int refused = 0;
    for (int node = 1; node <= start.cables()[0].state.segments(); ++node) {
      const int nearest = std::clamp(node, eye.node, last);
      World world = start;
      const EditResult result = world.apply(pin_where_it_is(world, 0, node));
      EXPECT_EQ(result.ok, std::abs(arc_length[node] - arc_length[nearest]) >= 0.1 * (1 - 1e-9))
          << node << ": " << result.message;
      refused += result.ok ? 0 : 1;
      if (!result.ok) EXPECT_EQ(world.hash(), start.hash());
      if (node == last + 1)
        EXPECT_NE(result.message.find("m of cable from guide eye, must be at least 0.1 m from it"), std::string::npos)
            << result.message;
    }
    EXPECT_GT(refused, 2);
  }
}

struct PinnedGuide {
  const char* name;
  SceneDesc scene;
};

void PrintTo(const PinnedGuide& pinned, std::ostream* stream) {
  *stream << pinned.name;
}

class PinnedGuides : public testing::TestWithParam<PinnedGuide> {};

TEST_P(PinnedGuides, stand) {
  for (const double stiffness : {0.0, 0.01})
    for (const int steps : {1, 20})
      for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp}) {
        SceneDesc scene = GetParam().scene;
        scene.materials[0].material.bending_stiffness = stiffness;
        World start(scene, {});
        for (int i = 0; i < steps; ++i) ASSERT_EQ(start.step({}).status, Status::ok);
        // Clamps nearer to the start would straighten what is taut.
        for (int node = 5; node < start.cables()[0].state.segments(); ++node) {
          World world = start;
          if (!world.apply(pin_where_it_is(world, 0, node, type)).ok) continue;
          SCOPED_TRACE("stiffness " + std::to_string(stiffness) + ", after " + std::to_string(steps) + " steps, " +
                       (type == AttachmentType::clamp ? "clamp" : "hinge") + " at node " + std::to_string(node));
          for (int i = 0; i < 5; ++i) {
            ASSERT_EQ(world.step({}).status, Status::ok);
            for (const Vector3& velocity : world.cables()[0].state.velocities) ASSERT_TRUE(velocity.allFinite());
            ASSERT_TRUE(std::isfinite(world.energy().total()));
            for (const Attachment& attachment : world.attachments()) ASSERT_LT(attachment.force.norm(), 1000 * weight(world));
          }
        }
      }
}

const PinnedGuide pinned_guides[] = {{"eyelet", through_eyelet(0)},
                                     {"rubbing eyelet", through_eyelet(0.1)},
                                     {"holding eyelet", through_eyelet(infinity)},
                                     {"wheel", over_wheel(0)},
                                     {"rubbing wheel", over_wheel(1e-3)}};
INSTANTIATE_TEST_SUITE_P(All, PinnedGuides, testing::ValuesIn(pinned_guides));

TEST(Pins, holdAPointOfAHarnessOnce) {
  SceneDesc scene = scenes::between_two_points(20, 0.6);
  CableDesc branch = scenes::one_cable(8, 0.4).cables[0];
  branch.name = "branch";
  scene.cables.push_back(branch);
  JunctionDesc junction;
  junction.name = "fork";
  junction.cable = "cable";
  junction.place = PlaceDesc{PlaceDesc::At::arc_length, 0.5};
  junction.type = JunctionDesc::Type::hinge;
  BranchDesc end;
  end.cable = "branch";
  end.end = BranchDesc::End::start;
  junction.branches = {end};
  scene.junctions = {junction};
  for (const int first : {0, 1}) {
    World world(scene, {});
    const int node[] = {10, 0};
    ASSERT_TRUE(world.apply(pin_where_it_is(world, first, node[first])).ok);
    edit::Pin second = pin_where_it_is(world, 1 - first, node[1 - first]);
    second.name = "second";
    const EditResult result = world.apply(second);
    EXPECT_FALSE(result.ok);
    EXPECT_NE(result.message.find("is already held by pin"), std::string::npos) << result.message;
    // What is let go may be held anew.
    ASSERT_TRUE(world.apply(edit::Unpin{"pin"}).ok);
    EXPECT_TRUE(world.apply(second).ok);
  }
}

TEST(Pins, besideOthersStretchNothing) {
  for (const std::vector<int>& nodes : {std::vector<int>{1}, std::vector<int>{10, 11}}) {
    World world(scenes::between_two_points(20, 0.8), {});
    for (int i = 0; i < 50; ++i) ASSERT_EQ(world.step({}).status, Status::ok);
    for (const int node : nodes) {
      edit::Pin pin = pin_where_it_is(world, 0, node);
      pin.name = "pin" + std::to_string(node);
      ASSERT_TRUE(world.apply(pin).ok);
    }
    for (int i = 0; i < 500; ++i) ASSERT_EQ(world.step({}).status, Status::ok) << nodes.front() << ", step " << i;
  }
}

TEST(Pins, thatAreDrawnApartStretchWhatIsBetween) {
  SceneDesc scene = scenes::held_by_a_hand(20);
  const double length = 1;
  World world(scene, scenes::hand_at({0.9 * length, 0, 0}));
  ASSERT_EQ(world.step(scenes::hand_at({0.9 * length, 0, 0})).status, Status::ok);
  const auto final_status = [&](double place) {
    StepResult result;
    const double from = world.cables()[0].state.positions.back().x();
    for (int i = 1; i <= 1000; ++i) result = world.step(scenes::hand_at({from + i * (place - from) / 1000, 0, 0}));
    return result.status;
  };
  EXPECT_EQ(final_status((1 - 1e-6) * length), Status::ok);
  EXPECT_EQ(final_status((1 + 3e-6) * length), Status::overstretched);
}

}  // namespace
}  // namespace verlet_cable
