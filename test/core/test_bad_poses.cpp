#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "../support/nets.h"
#include "../support/scenes.h"

// Nothing that is given makes anything of a world infinite or no number.

namespace verlet_cable {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

struct BadPose {
  const char* name;
  Pose pose;
};

Pose at(const Vector3& position) {
  return {position, Quaternion::Identity()};
}
Pose turned(double w, double x, double y, double z) {
  return {Vector3(0.6, 0, 0), Quaternion(w, x, y, z)};
}

const BadPose bad_poses[] = {
    {"nan x", at({nan, 0, 0})},
    {"nan z", at({0, 0, nan})},
    {"inf", at({infinity, 0, 0})},
    {"-inf", at({0, -infinity, 0})},
    {"1.1e9", at({1.1e9, 0, 0})},
    {"1e30", at({0, 1e30, 0})},
    {"1e308", at({0, 0, -1e308})},
    {"no rotation", turned(0, 0, 0, 0)},
    {"nan rotation", turned(nan, 0, 0, 0)},
    {"inf rotation", turned(1, infinity, 0, 0)},
    {"tiny rotation", turned(1e-200, 0, 0, 0)},
    {"large rotation", turned(1e200, 0, 0, 0)},
    {"long rotation", turned(3, 0, 0, 0)},
};

/// Cables of every kind in a frame, nets, an obstacle that moves with it, and a particle.
SceneDesc everything() {
  SceneDesc scene = scenes::held_by_a_hand(12);
  scene.materials[0].material.bending_stiffness = 0.01;
  scene.materials[0].material.torsional_stiffness = 0.01;
  MaterialDesc elastic = scene.materials[0].material, rope = scene.materials[0].material;
  elastic.axial_stiffness = 1e4;
  rope.bending_stiffness = rope.torsional_stiffness = 0;
  scene.materials.push_back({"elastic", elastic});
  scene.materials.push_back({"soft", rope});
  const CableDesc first = scene.cables[0];
  scene.cables.clear();
  for (const char* material : {"rope", "elastic", "soft"})
    for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp}) {
      CableDesc cable = first;
      cable.material = material;
      cable.name = std::string(material) + (type == AttachmentType::clamp ? "_clamped" : "_hinged");
      for (AttachmentDesc& attachment : cable.attachments) {
        attachment.name += "_" + cable.name;
        attachment.type = type;
        attachment.offset.y() = 0.1 * static_cast<double>(scene.cables.size());
      }
      scene.cables.push_back(cable);
    }
  for (const LinkType type : {LinkType::spring, LinkType::limited, LinkType::rigid}) {
    NetDesc net = scenes::grid(3, 4, 0.05, type);
    net.name = "net" + std::to_string(scene.nets.size());
    net.attachments = {scenes::net_attachment(net.name + "_held", 0, {0, 0, 0}),
                       scenes::net_attachment(net.name + "_carried", 3, {-0.45, 0, 0})};
    net.attachments[1].frame = "hand";
    scene.nets.push_back(net);
  }
  ObstacleDesc ball;
  ball.name = "ball";
  ball.type = ShapeType::sphere;
  ball.radius = 0.05;
  ball.frame = "hand";
  ball.pose = {0, 0, -0.2, 0, 0, 0};
  scene.obstacles = {ball};
  ParticleDesc particle;
  particle.name = "particle";
  particle.mass = 1;
  particle.position = {0.6, 0, 1};
  scene.particles = {particle};
  scene.contact = ContactDesc{};
  return scene;
}

::testing::AssertionResult all_finite(const World& world) {
  for (const SimulatedCable& cable : world.cables()) {
    for (const auto* vectors : {&cable.state.positions, &cable.state.velocities, &cable.state.accelerations})
      for (const Vector3& v : *vectors)
        if (!v.allFinite()) return ::testing::AssertionFailure() << "cable " << cable.model->name;
    for (const auto* values : {&cable.state.tension, &cable.state.axial_multiplier, &cable.state.twist})
      for (const double value : *values)
        if (!std::isfinite(value)) return ::testing::AssertionFailure() << "a number of cable " << cable.model->name;
    for (const Quaternion& q : segment_orientations(cable.state))
      if (!q.coeffs().allFinite()) return ::testing::AssertionFailure() << "axes of cable " << cable.model->name;
  }
  for (const SimulatedNet& net : world.nets()) {
    for (const auto* vectors : {&net.state.positions, &net.state.velocities})
      for (const Vector3& v : *vectors)
        if (!v.allFinite()) return ::testing::AssertionFailure() << "net " << net.model.name;
    for (const double value : net.state.tension)
      if (!std::isfinite(value)) return ::testing::AssertionFailure() << "tension of net " << net.model.name;
  }
  for (const SimulatedParticle& particle : world.particles())
    if (!particle.position.allFinite() || !particle.velocity.allFinite()) return ::testing::AssertionFailure() << "particle";
  for (const Attachment& attachment : world.attachments())
    if (!attachment.force.allFinite() || !attachment.torque.allFinite())
      return ::testing::AssertionFailure() << "wrench of " << attachment.name;
  for (const SimulatedContact& contact : world.findings().contacts)
    if (!contact.position.allFinite() || !contact.force.allFinite()) return ::testing::AssertionFailure() << "contact";
  const Energy e = world.energy();
  if (!std::isfinite(e.kinetic + e.total())) return ::testing::AssertionFailure() << "energy " << e.total();
  return ::testing::AssertionSuccess();
}

TEST(BadPoses, FrameStaysWhereItWasAndIsReported) {
  const SceneDesc scene = everything();
  const BoundaryInputs good = scenes::hand_at({0.6, 0, 0});
  for (const BadPose& bad : bad_poses) {
    World world(scene, good), still(scene, good);
    BoundaryInputs inputs = good;
    inputs[1].pose = bad.pose;
    for (int i = 0; i < 10; ++i) {
      const StepResult result = world.step(inputs);
      EXPECT_EQ(result.ignored_frame, 1) << bad.name;
      EXPECT_EQ(still.step(good).ignored_frame, -1);
    }
    EXPECT_TRUE(all_finite(world)) << bad.name;
    EXPECT_EQ(world.hash(), still.hash()) << bad.name;
    // What needs the frame waits for a pose that can be worked with.
    World waiting(scene, inputs);
    EXPECT_TRUE(waiting.cables().empty()) << bad.name;
    EXPECT_EQ(waiting.start_waiting(inputs), 0) << bad.name;
    EXPECT_EQ(waiting.start_waiting(good), 9) << bad.name;
    EXPECT_TRUE(all_finite(waiting)) << bad.name;
  }
}

TEST(BadPoses, EditsRefuseThemByName) {
  const SceneDesc scene = everything();
  World world(scene, scenes::hand_at({0.6, 0, 0}));
  const std::uint64_t before = world.hash();
  for (const BadPose& bad : bad_poses) {
    const bool placed = is_sound(Pose{bad.pose.position, Quaternion::Identity()});
    const char* part = placed ? ".orientation: of length " : ".position.";
    const EditResult pin = world.apply(edit::Pin{"", cable_id(0), 5, 0, bad.pose, AttachmentType::clamp});
    EXPECT_FALSE(pin.ok) << bad.name;
    EXPECT_EQ(pin.message.find(std::string("offset") + part), 0u) << pin.message;
    EXPECT_NE(pin.message.find("allowed: "), std::string::npos) << pin.message;
    const EditResult move = world.apply(edit::MoveAttachment{"base_rope_hinged", bad.pose});
    EXPECT_FALSE(move.ok) << bad.name;
    EXPECT_EQ(move.message, pin.message);
    if (!placed) {
      const EditResult pin_net = world.apply(edit::Pin{"", net_id(0), 5, 0, {bad.pose.position, Quaternion::Identity()}});
      EXPECT_FALSE(pin_net.ok) << bad.name;
      EXPECT_EQ(pin_net.message, pin.message);
    }
    Obstacle obstacle = world.obstacles()[0];
    obstacle.pose = bad.pose;
    const EditResult set = world.apply(edit::SetObstacle{obstacle});
    EXPECT_FALSE(set.ok) << bad.name;
    EXPECT_NE(set.message.find(std::string("pose") + part), std::string::npos) << set.message;
    EXPECT_FALSE(world.apply(edit::SetLength{0, true, bad.pose.position.x() < 1e9 ? nan : bad.pose.position.x(), 0.1}).ok);
    EXPECT_FALSE(world.apply(edit::SetLength{0, true, 1, nan}).ok);
  }
  EXPECT_EQ(world.hash(), before);
  World other = world;
  const int frame = other.add_frame("new", bad_poses[0].pose);
  EXPECT_FALSE(other.frame_known(frame));
}

TEST(BadPoses, LargestPosesKeepEverythingFinite) {
  const Pose far[] = {at({1e9, -1e9, 1e9}), at({-1e9, 0, 0}),   at({0.6, 0, 1e6}), at({1e5, 0, 0}), at({0.6, 0, 0}),
                      turned(2, 0, 0, 0),   turned(0, 0, 1, 0), at({0, 0, 0}),     at({1e-9, 0, 0})};
  for (const bool winch : {false, true}) {
    const SceneDesc scene = everything();
    World world(scene, scenes::hand_at({0.6, 0, 0}));
    if (winch) {
      ASSERT_TRUE(world.apply(edit::SetLength{0, true, 2, 0.5}).ok);
      ASSERT_TRUE(
          world.apply(edit::Pin{"", cable_id(1), 5, 0, Pose{{1e9, 1e9, 1e9}, Quaternion(0, 1, 0, 0)}, AttachmentType::clamp}).ok);
      ASSERT_TRUE(world.apply(edit::Pin{"", net_id(1), 5, 0, {{-1e9, 1e9, 1e9}, Quaternion::Identity()}}).ok);
      Obstacle obstacle = world.obstacles()[0];
      obstacle.name = "far";
      obstacle.pose.position = {1e9, 1e9, 1e9};
      ASSERT_TRUE(world.apply(edit::SetObstacle{obstacle}).ok);
    }
    for (const Pose& pose : far)
      for (int i = 0; i < 6; ++i) {
        BoundaryInputs inputs = scenes::hand_at({0.6, 0, 0});
        if (i < 4) inputs[1].pose = pose;
        const StepResult result = world.step(inputs);
        EXPECT_EQ(result.ignored_frame, -1);
        ASSERT_TRUE(all_finite(world)) << pose.position.transpose() << ", step " << i;
      }
  }
}

}  // namespace
}  // namespace verlet_cable
