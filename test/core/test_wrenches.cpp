#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "../support/scenes.h"

// What changes momentum is in a wrench: in every step that of each body and cable changes by its weight and by what the wrenches
// of its attachments say, however these hold it and whatever substeps do about motion that they do not resolve.

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

const Vector3 gravity{0, 0, -9.81};

struct Momenta {
  std::vector<Vector3> bodies, cables;
  Vector3 angular = Vector3::Zero();  ///< of all, about the origin
};

double mass_of(const SimulatedCable& cable) {
  double mass = 0;
  for (const double m : cable.state.masses) mass += m;
  return mass;
}

Momenta momenta_of(const World& world) {
  Momenta momenta;
  for (const SimulatedBody& body : world.bodies()) {
    momenta.bodies.push_back(body.mass * body.velocity);
    const Eigen::Matrix3d axes = body.pose.orientation.toRotationMatrix();
    momenta.angular += (body.pose * Pose{body.center_of_mass}).position.cross(momenta.bodies.back()) +
                       axes * body.inertia * axes.transpose() * body.angular_velocity;
  }
  for (const SimulatedCable& cable : world.cables()) {
    Vector3& sum = momenta.cables.emplace_back(Vector3::Zero());
    for (int i = 0; i < cable.state.nodes(); ++i) {
      const Vector3 momentum = cable.state.masses[i] * cable.state.velocities[i];
      sum += momentum;
      momenta.angular += cable.state.positions[i].cross(momentum);
    }
  }
  return momenta;
}

/// [N] By how much the wrenches of a step miss what has changed the momentum of any body or cable.
double missing_force(const World& world, const Momenta& before, double h) {
  const Momenta after = momenta_of(world);
  std::vector<Vector3> bodies, cables;
  for (std::size_t b = 0; b < after.bodies.size(); ++b)
    bodies.push_back((after.bodies[b] - before.bodies[b]) / h - world.bodies()[b].mass * gravity);
  for (std::size_t c = 0; c < after.cables.size(); ++c)
    cables.push_back((after.cables[c] - before.cables[c]) / h - mass_of(world.cables()[c]) * gravity);
  for (const Attachment& a : world.attachments()) {
    (a.body.is_cable() ? cables : bodies)[a.body.index] += a.force;
    if (a.holder >= 0) bodies[a.holder] -= a.force;
  }
  double worst = 0;
  for (const std::vector<Vector3>* all : {&bodies, &cables})
    for (const Vector3& missing : *all) worst = std::max(worst, missing.norm());
  return worst;
}

struct Parameters {
  AttachmentType joint;
  double axial_stiffness;
  bool numerical_damping;
};

class Wrenches : public testing::TestWithParam<Parameters> {
 protected:
  SceneDesc scene_with(const std::string& cable, const std::string& from, const Vector3& offset, int segments) const {
    SceneDesc scene = scenes::one_cable(segments, 0.5);
    scene.numerical_damping = GetParam().numerical_damping;
    MaterialDesc& rope = scene.materials[0].material;
    rope.linear_density = 0.02;
    rope.axial_stiffness = GetParam().axial_stiffness;
    if (rope.axial_stiffness < infinity) rope.axial_damping = 1e-4 * rope.axial_stiffness;
    scene.cables[0].name = cable;
    scene.cables[0].attachments = {scenes::attachment("rope_start", PlaceDesc::At::start, offset)};
    scene.cables[0].attachments[0].body = from;
    return scene;
  }
};

using WrenchesOfRopes = Wrenches;

BodyDesc bar(const std::string& name, double x) {
  BodyDesc body;
  body.name = name;
  body.mass = 1;
  body.inertia = Vector3(1e-3, 1e-3, 2e-4);
  body.pose = InitialPose{x, 0, 0, 0, -M_PI / 2, 0};
  return body;
}

/// Two bars in a row, lying along x: a frame holds the first one, which holds the second; both can turn about y, if at all. From
/// the end of the row hangs a rope with a ball.
SceneDesc row_of_bars(SceneDesc scene, AttachmentType type, const std::string& frame) {
  scene.bodies = {bar("first", 0.05), bar("second", 0.15)};
  for (BodyDesc& body : scene.bodies) {
    BodyAttachmentDesc& joint = body.attachments.emplace_back();
    joint.name = "joint_of_" + body.name;
    joint.type = type;
    joint.at = {0, 0, 0.05, -M_PI / 2, 0, 0};
  }
  BodyAttachmentDesc &first = scene.bodies[0].attachments[0], &second = scene.bodies[1].attachments[0];
  first.frame = frame;
  if (!frame.empty()) first.initial_pose = InitialPose{};
  first.rotation = {-M_PI / 2, -M_PI / 2, 0};
  second.body = "first";
  second.offset = {0, 0, -0.05};
  second.rotation = {-M_PI / 2, 0, 0};
  BodyDesc& ball = scene.bodies.emplace_back();
  ball.name = "ball";
  ball.mass = 0.1;
  ball.inertia = Vector3(4e-5, 4e-5, 4e-5);
  scene.cables[0].attachments.push_back(scenes::attachment("ball_hook", PlaceDesc::At::end, {0, 0, 0.02}));
  scene.cables[0].attachments[1].body = "ball";
  return scene;
}

/// [N m] The last iteration turns bodies after their arms were taken.
constexpr double tolerated_moment = 1e-4;
/// Newton's iterations leave 1e-5 of a segment length per second of velocities, and of what hangs on bodies a thousandth of that
/// or less: of some kg at 1 ms far less than this [N]. A joint ends velocities to a part in ten million.
constexpr double tolerated = 1e-5;
constexpr double time_step = 1e-3;

TEST_P(Wrenches, HaveAllThatJointsOfBodiesDo) {
  const SceneDesc scene = row_of_bars(scene_with("rope", "second", {0, 0, -0.05}, 15), GetParam().joint, "");
  ASSERT_TRUE(validate(scene).empty()) << validate(scene)[0];
  World world(scene, BoundaryInputs(1));
  double worst = 0, twisting = 0;  // [N], [N m]
  Vector3 impulse = Vector3::Zero();
  const Momenta start = momenta_of(world);
  double mass = 0;
  for (const SimulatedBody& body : world.bodies()) mass += body.mass;
  mass += mass_of(world.cables()[0]);
  for (int i = 0; i < 2000; ++i) {
    const Momenta before = momenta_of(world);
    Vector3 moment_of_weight = Vector3::Zero();
    const auto add_weight = [&] {
      for (const SimulatedBody& body : world.bodies())
        moment_of_weight += 0.5 * body.mass * (body.pose * Pose{body.center_of_mass}).position.cross(gravity);
      for (const SimulatedCable& cable : world.cables())
        for (int k = 0; k < cable.state.nodes(); ++k)
          moment_of_weight += 0.5 * cable.state.masses[k] * cable.state.positions[k].cross(gravity);
    };
    add_weight();
    ASSERT_EQ(world.step(BoundaryInputs(1)).status, Status::ok) << i;
    add_weight();
    worst = std::max(worst, missing_force(world, before, time_step));
    const Attachment& pivot = world.attachments()[find(world.attachments(), "joint_of_first")];
    impulse -= time_step * (pivot.force - mass * gravity);
    const Vector3 turned = (momenta_of(world).angular - before.angular) / time_step - moment_of_weight + pivot.torque;
    twisting = std::max(twisting, turned.norm());
  }
  EXPECT_LT(worst, tolerated);
  const Momenta end = momenta_of(world);
  Vector3 gain = Vector3::Zero();
  for (std::size_t b = 0; b < end.bodies.size(); ++b) gain += end.bodies[b] - start.bodies[b];
  gain += end.cables[0] - start.cables[0];
  EXPECT_LT((gain - impulse).norm(), 2 * tolerated);
  EXPECT_NEAR(world.ledger().balance.work.attachments, 0, 1e-12);
  // Substeps that damp keep angular momentum, here about the pivot, and energy to second order.
  if (GetParam().numerical_damping) return;
  EXPECT_LT(twisting, tolerated_moment);
  EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-5 * mass * 9.81 * 0.5);
}

/// What the hand does is the way of the wrench.
TEST_P(Wrenches, OfAHandThatMovesWork) {
  const SceneDesc scene = row_of_bars(scene_with("rope", "second", {0, 0, -0.05}, 15), GetParam().joint, "hand");
  const auto hand = [](double t) {
    BoundaryInputs inputs = scenes::hand_at({0, 0.02 * (1 - std::cos(5 * t)), 0.05 * (1 - std::cos(4 * t))});
    inputs[1].pose.orientation = Quaternion(Eigen::AngleAxisd(0.2 * (1 - std::cos(3 * t)), Vector3(0, 0.6, 0.8)));
    return inputs;
  };
  World world(scene, hand(0));
  double worst = 0, work = 0;
  for (int i = 1; i <= 2000; ++i) {
    const Momenta before = momenta_of(world);
    const Pose from = world.frame_pose(1);
    ASSERT_EQ(world.step(hand(time_step * i)).status, Status::ok) << i;
    worst = std::max(worst, missing_force(world, before, time_step));
    const Attachment& pivot = world.attachments()[find(world.attachments(), "joint_of_first")];
    const Pose& to = world.frame_pose(1);
    const Quaternion turn = to.orientation * from.orientation.conjugate();
    work -= pivot.force.dot(to.position - from.position) + 2 / turn.w() * pivot.torque.dot(turn.vec());
  }
  EXPECT_LT(worst, tolerated);
  EXPECT_GT(std::abs(work), 1e-3);
  EXPECT_NEAR(world.ledger().balance.work.attachments, work, 1e-9);
}

/// A load on a rope and a rope beside it, from a hand and a frame; what holds the ropes there are frames.
TEST_P(WrenchesOfRopes, AreAllThatHoldsABody) {
  SceneDesc scene = scene_with("left", "load", {-0.05, 0, 0}, 12);
  scene.cables.push_back(scene.cables[0]);
  scene.cables[1].name = "right";
  scene.cables[1].attachments = {scenes::attachment("right_start", PlaceDesc::At::start, {0.05, 0, 0})};
  scene.cables[1].attachments[0].body = "load";
  scene.cables[0].attachments.push_back(scenes::attachment("left_end", PlaceDesc::At::end, {0, 0, 0}, "hand"));
  scene.cables[0].attachments[1].initial_pose = InitialPose{-0.3, 0, 0, 0, 0, 0};
  scene.cables[1].attachments.push_back(scenes::attachment("right_end", PlaceDesc::At::end, {0.3, 0, 0}));
  BodyDesc& load = scene.bodies.emplace_back();
  load.name = "load";
  load.mass = 1;
  load.inertia = Vector3(2e-3, 1e-3, 2e-3);
  load.pose = InitialPose{0.1, 0, -0.2, 0, 0, 0};
  ASSERT_TRUE(validate(scene).empty()) << validate(scene)[0];
  const auto hand = [](double t) { return scenes::hand_at({-0.3 + 0.05 * (1 - std::cos(4 * t)), 0.05 * std::sin(t) * t, 0}); };
  World world(scene, hand(0));
  double worst = 0;
  for (int i = 1; i <= 2000; ++i) {
    const Momenta before = momenta_of(world);
    ASSERT_EQ(world.step(hand(time_step * i)).status, Status::ok) << i;
    worst = std::max(worst, missing_force(world, before, time_step));
  }
  EXPECT_LT(worst, tolerated);
}

std::vector<Parameters> all_with(const std::vector<AttachmentType>& joints) {
  std::vector<Parameters> all;
  for (const AttachmentType joint : joints)
    for (const double stiffness : {infinity, 2e4})
      for (const bool damping : {true, false}) all.push_back({joint, stiffness, damping});
  return all;
}

std::string name_of(const testing::TestParamInfo<Parameters>& info) {
  const Parameters& p = info.param;
  const std::string joint = p.joint == AttachmentType::hinge ? "Hinge" : p.joint == AttachmentType::axle ? "Axle" : "Clamp";
  return joint + (p.axial_stiffness < infinity ? "Elastic" : "Inextensible") + (p.numerical_damping ? "" : "Conserving");
}

INSTANTIATE_TEST_SUITE_P(All, Wrenches,
                         testing::ValuesIn(all_with({AttachmentType::hinge, AttachmentType::axle, AttachmentType::clamp})),
                         name_of);
INSTANTIATE_TEST_SUITE_P(All, WrenchesOfRopes, testing::ValuesIn(all_with({AttachmentType::hinge})), name_of);

}  // namespace
}  // namespace verlet_cable
