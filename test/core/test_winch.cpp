#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "../support/scenes.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;
constexpr double gravity = 9.81, density = 0.1, payload = 0.2;

double mass(const World& world) {
  const std::vector<double>& masses = world.cables()[0].state.masses;
  return std::accumulate(masses.begin(), masses.end(), 0.0);
}

double length(const World& world) {
  return world.cables()[0].state.length();
}

/// A cable of 2 m with a load, hanging on a winch at one of its ends.
SceneDesc crane(bool winch_at_end, const MaterialDesc& material, AttachmentType type) {
  using At = PlaceDesc::At;
  SceneDesc scene = scenes::one_cable(100, 2);
  scene.materials[0].material = material;
  AttachmentDesc winch = scenes::attachment("winch", winch_at_end ? At::end : At::start, {0, 0, 0}, "", type);
  winch.rotation = {0, winch_at_end ? -M_PI / 2 : M_PI / 2, 0};
  scene.cables[0].attachments = {winch};
  PointMassDesc load = scenes::payload(payload);
  load.place.at = winch_at_end ? At::start : At::end;
  scene.cables[0].point_masses = {load};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  return scene;
}

MaterialDesc rope() {
  return scenes::one_cable(1).materials[0].material;
}
MaterialDesc bending_rope() {
  MaterialDesc material = rope();
  material.bending_stiffness = 0.02;
  material.bending_damping = 1e-3;
  return material;
}
MaterialDesc elastic_rope() {
  MaterialDesc material = rope();
  material.axial_stiffness = 1e4;
  material.axial_damping = 20;
  return material;
}

struct WinchCase {
  const char* name;
  bool at_end;
  MaterialDesc material;
  AttachmentType type;
};

class Winch : public testing::TestWithParam<WinchCase> {};

/// The clamp at the winch lets a rope that does not bend through in any direction, and holds it in its own when it is wound.
TEST(ClampedWinch, SlackRopeIsWoundThroughAClamp) {
  for (const AttachmentType start : {AttachmentType::clamp, AttachmentType::hinge}) {
    SceneDesc scene = scenes::one_cable(24, 1.2);
    scene.cables[0].attachments = {scenes::attachment("wall", PlaceDesc::At::start, {0, 0, 0}, "", start),
                                   scenes::attachment("winch", PlaceDesc::At::end, {1, 0, 0}, "", AttachmentType::clamp)};
    World world(scene, BoundaryInputs(1));
    for (const double goal : {1.8, 1.1}) {
      ASSERT_TRUE(world.apply(edit::SetLength{0, true, goal, 1}).ok);
      for (int i = 0; i < 2500; ++i) {
        EXPECT_EQ(world.step(BoundaryInputs(1)).status, Status::ok);
        // It weighs 1 to 2 N.
        for (const double tension : world.cables()[0].state.tension) ASSERT_LT(std::abs(tension), 20) << i;
      }
      EXPECT_NEAR(length(world), goal, 1e-6);
      const std::vector<Vector3>& x = world.cables()[0].state.positions;
      EXPECT_GT((x[x.size() - 1] - x[x.size() - 2]).normalized().x(), 1 - 1e-6);
    }
  }
}

TEST_P(Winch, LiftsAndLowersALoad) {
  const WinchCase& winch = GetParam();
  const SceneDesc scene = crane(winch.at_end, winch.material, winch.type);
  World world(scene, initial_frames(scene));
  for (const double goal : {0.5, 2.0}) {
    const EditResult started = world.apply(edit::SetLength{0, winch.at_end, goal, 0.5});
    ASSERT_TRUE(started.ok) << started.message;
    // 1.5 m at 0.5 m/s, half a second to speed up and another to brake; then a second to come to rest
    for (int i = 0; i < 4600; ++i) {
      ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
      const double ratio = world.attachments()[0].force.norm() / (gravity * mass(world));
      // Acceleration changes the tension by a tenth, and shakes what is elastic by about as much again.
      ASSERT_NEAR(ratio, 1, 0.25) << i;
      ASSERT_NEAR(mass(world), payload + density * length(world), 1e-12) << i;
      if (i > 600 && i < 3000) {
        ASSERT_NEAR(std::abs(length(world) - (2.5 - goal)), 0.5 * 0.001 * (i + 1) - 0.125, 1e-3) << i;
      }
    }
    EXPECT_NEAR(length(world), goal, 1e-9);
    EXPECT_EQ(world.cables()[0].state.segments(), std::lround(goal / 0.02));
    const double statics = gravity * (payload + density * goal);
    EXPECT_NEAR(world.attachments()[0].force.norm(), statics, 1e-3 * statics);
    const int far_end = winch.at_end ? 0 : world.cables()[0].state.segments();
    EXPECT_NEAR(world.cables()[0].state.positions[far_end].z(), -goal, 1e-3 * goal);
  }
}

INSTANTIATE_TEST_SUITE_P(Cables, Winch,
                         testing::Values(WinchCase{"start", false, rope(), AttachmentType::hinge},
                                         WinchCase{"end", true, rope(), AttachmentType::hinge},
                                         WinchCase{"welded", false, rope(), AttachmentType::clamp},
                                         WinchCase{"bending", false, bending_rope(), AttachmentType::clamp},
                                         WinchCase{"bendingEnd", true, bending_rope(), AttachmentType::clamp},
                                         WinchCase{"elastic", false, elastic_rope(), AttachmentType::hinge}),
                         [](const auto& info) { return info.param.name; });

/// A wire rope, whose waves along it no step resolves.
TEST(WinchEdits, AWireRopeIsTakenInWithoutJerks) {
  MaterialDesc wire_rope = rope();
  wire_rope.axial_stiffness = 1e6;
  const SceneDesc scene = crane(false, wire_rope, AttachmentType::hinge);
  World world(scene, initial_frames(scene));
  for (int i = 0; i < 100; ++i) world.step({FrameInput{}});
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 1.4, 0.2}).ok);
  for (int i = 0; i < 4000; ++i) {
    ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
    const double ratio = -world.attachments()[0].force.z() / (gravity * mass(world));
    // A tenth by its acceleration, and the waves that this sends along the rope.
    ASSERT_NEAR(std::abs(ratio), 1, 0.5) << i;
  }
  EXPECT_NEAR(length(world), 1.4, 1e-6);
}

TEST(WinchEdits, ASwingingLoadIsTakenInWithoutJerks) {
  SceneDesc scene = crane(false, bending_rope(), AttachmentType::hinge);
  scene.cables[0].initial = {};
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = {std::sin(0.2), 0, -std::cos(0.2)};
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 0.5, 0.5}).ok);
  double before = world.attachments()[0].force.norm();
  for (int i = 0; i < 4000; ++i) {
    ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
    const double now = world.attachments()[0].force.norm();
    // The winch's acceleration changes the tension by a tenth of the weight, the swing by up to 3 sin(angle) times its turn in
    // ten milliseconds: 8 %.
    if (i > 0) {
      ASSERT_NEAR(now, before, 0.13 * gravity * mass(world)) << i;
    }
    if (i % 10 == 0) before = now;
  }
  EXPECT_NEAR(length(world), 0.5, 1e-6);
}

TEST(WinchEdits, OtherAttachmentsKeepTheirMaterialPoint) {
  SceneDesc scene = scenes::between_two_points(50, 0.8);
  AttachmentDesc middle = scenes::attachment("middle", PlaceDesc::At::arc_length, {0.4, 0, -0.1});
  middle.place.arc_length = 0.5;
  scene.cables[0].attachments.push_back(middle);
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 1.3, 1}).ok);
  for (int i = 0; i < 3000; ++i) ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
  const SimulatedCable& cable = world.cables()[0];
  const int node = world.attachments()[2].node;
  EXPECT_EQ(cable.state.positions[node], Vector3(0.4, 0, -0.1));
  EXPECT_NEAR(cable.state.length(node, cable.state.segments()), 0.5, 1e-12);
  EXPECT_NEAR(cable.state.length(0, node), 0.8, 1e-9);
  EXPECT_EQ(world.attachments()[1].node, cable.state.segments());
}

TEST(WinchEdits, TwistPerLengthStaysAsItIs) {
  SceneDesc scene = scenes::held_by_a_hand(50, AttachmentType::clamp);
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = 0.02;
  material.bending_damping = 2e-3;
  material.torsional_stiffness = 0.015;
  scene.gravity.acceleration.setZero();
  BoundaryInputs hand = scenes::hand_at({0.999, 0, 0});
  World world(scene, hand);
  for (int i = 1; i <= 500; ++i) {
    hand[1].pose.orientation = quaternion_from_rpy({0.004 * i, 0, 0});
    world.step(hand);
  }
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 1.4, 0.5}).ok);
  for (int i = 0; i < 1500; ++i) {
    hand[1].pose.position.x() = 0.999 * length(world);
    ASSERT_EQ(world.step(hand).status, Status::ok) << i;
  }
  // The cable is nearly straight: what little it is bent takes up a few parts in a thousand.
  EXPECT_NEAR(node_twist(world.cables()[0].state)[20], 2, 0.01);
}

TEST(WinchEdits, ACopyGoesOnAlikeAndACutCableIsWoundOn) {
  const SceneDesc scene = crane(false, bending_rope(), AttachmentType::clamp);
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 1, 0.5}).ok);
  for (int i = 0; i < 700; ++i) world.step({FrameInput{}});
  World copy = world;
  for (int i = 0; i < 1000; ++i) {
    world.step({FrameInput{}});
    copy.step({FrameInput{}});
  }
  EXPECT_EQ(world.hash(), copy.hash());
  const double before = length(world);
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 30}).ok);
  const double lost = before - length(world);
  for (int i = 0; i < 3000; ++i) ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
  EXPECT_NEAR(length(world), 1 - lost, 1e-6);
}

TEST(WinchEdits, WinchesTogetherKeepTheLimitOfSegments) {
  SceneDesc scene = scenes::between_two_points(50, 0.8);
  scene.cables.push_back(scene.cables.front());
  scene.cables.back().name = "other";
  for (AttachmentDesc& attachment : scene.cables.back().attachments) attachment.name = "other_" + attachment.name;
  scene.limits.segments = 120;
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::SetLength{0, true, 1.3, 0.5}).ok);  // 65 segments
  const EditResult more = world.apply(edit::SetLength{1, true, 1.3, 0.5});
  EXPECT_FALSE(more.ok);
  EXPECT_NE(more.message.find("at most 1.1 m, as limits.segments allows"), std::string::npos) << more.message;
  EXPECT_TRUE(world.apply(edit::SetLength{1, true, 1.09, 0.5}).ok);
  for (int i = 0; i < 2000; ++i) world.step(initial_frames(scene));
  EXPECT_LE(world.cables()[0].state.segments() + world.cables()[1].state.segments(), 120);
}

TEST(WinchEdits, BadRequestsChangeNothing) {
  SceneDesc scene = scenes::between_two_points(50, 0.8);
  scene.limits.segments = 60;
  World world(scene, initial_frames(scene));
  const std::uint64_t before = world.hash();
  const auto refused = [&](int cable, double length, double speed, const char* part) {
    const EditResult result = world.apply(edit::SetLength{cable, true, length, speed});
    EXPECT_FALSE(result.ok);
    EXPECT_NE(result.message.find(part), std::string::npos) << result.message;
  };
  refused(1, 1, 0.5, "cable: 1");
  for (const double bad : {std::nan(""), infinity, 0.0, -1.0}) {
    refused(0, bad, 0.5, "length: ");
    refused(0, 1, bad, "speed: ");
  }
  refused(0, 0.79, 0.5, "distance");
  refused(0, 1.21, 0.5, "limits.segments");
  refused(0, 1.1, 11, "at most 10 m/s");  // half a segment of 2 cm a step
  EXPECT_EQ(world.hash(), before);
  ASSERT_TRUE(world.apply(edit::SetLength{0, true, 1.1, 0.5}).ok);
  world.step({FrameInput{}});
  const EditResult other_end = world.apply(edit::SetLength{0, false, 1, 0.5});
  EXPECT_FALSE(other_end.ok);
  EXPECT_NE(other_end.message.find("other end"), std::string::npos) << other_end.message;
}

/// No shape fits where a segment's nodes are held at one place. The winch pays out between them, and segments appear there.
TEST(Winch, PaysOutWhereNothingFitsAndAllStaysFinite) {
  for (const bool twists : {false, true}) {
    SceneDesc scene = scenes::one_cable(4);
    if (twists) scene.materials[0].material.bending_stiffness = scene.materials[0].material.torsional_stiffness = 1e-3;
    scene.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, Vector3::Zero())};
    World world(scene, {});
    for (const int node : {1, 2}) {
      edit::Pin pin;
      pin.body = cable_id(0);
      pin.node = node;
      ASSERT_TRUE(world.apply(pin).ok);
    }
    ASSERT_TRUE(world.apply(edit::SetLength{0, false, 2, 1}).ok);
    for (int i = 0; i < 1500; ++i) {
      world.step({});
      const CableState& cable = world.cables()[0].state;
      for (const Vector3& position : cable.positions) ASSERT_TRUE(position.allFinite()) << world.time() << " s";
      for (const Vector3& velocity : cable.velocities) ASSERT_TRUE(velocity.allFinite()) << world.time() << " s";
      for (const Quaternion& q : segment_orientations(cable)) ASSERT_NEAR(q.norm(), 1, 1e-9) << world.time() << " s";
    }
  }
}

}  // namespace
}  // namespace verlet_cable
