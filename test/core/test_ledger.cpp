#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../support/scenes.h"
#include "described_cables.h"

// Every joule of a world: what it gains is what holders, winches, obstacles and the fluid do, less what laws of damping,
// friction, edits and unresolved motion take.

namespace verlet_cable {
namespace {

using described::Case;
using described::Surroundings;
using Status = StepResult::Status;

constexpr double gravity = 9.81;

/// m g L [J] of a rope of 0.1 kg/m and 1 m.
constexpr double scale = 0.1 * gravity;
/// Of it, what a second of steps may leave: a solution of a step is found to 1e-5 segment lengths per second.
constexpr double tolerated = 1e-5;

double sum(const EnergyBalance::Dissipated& dissipated) {
  return dissipated.total();
}

TEST(Ledger, ConservedEnergyNeedsNoEntry) {
  SceneDesc scene = scenes::released(20, 1.5);
  scene.numerical_damping = false;
  scene.tolerance = 1e-6;
  World world(scene, BoundaryInputs(1));
  for (int i = 0; i < 1000; ++i) world.step(BoundaryInputs(1));
  const Ledger ledger = world.ledger();
  EXPECT_NEAR(ledger.unaccounted(), 0, 1e-8 * scale);
  EXPECT_NEAR(ledger.balance.work.total(), 0, 1e-12);
  EXPECT_NEAR(sum(ledger.balance.dissipated), 0, 1e-12);
  EXPECT_EQ(ledger.unaccounted_steps, 0);
}

/// The hand's work is that of its wrench, summed here by the trapezoidal way of each step.
TEST(Ledger, WorkIsThatOfTheWrench) {
  for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp}) {
    SceneDesc scene = scenes::held_by_a_hand(20, type);
    scene.materials[0].material.bending_stiffness = 0.002;
    scene.materials[0].material.bending_damping = 1e-4;
    scene.materials[0].material.drag = 0.05;
    const auto hand = [](double t) {
      BoundaryInputs inputs(2);
      const double swing = 0.05 * (1 - std::cos(4 * t)), turn = 0.3 * (1 - std::cos(3 * t));
      inputs[1].pose = {{0.7 + swing, swing, 0}, Quaternion(Eigen::AngleAxisd(turn, Vector3(0, 0.6, 0.8)))};
      return inputs;
    };
    World world(scene, hand(0));
    double work = 0;
    for (int i = 1; i <= 1000; ++i) {
      const Pose before = world.frame_pose(1);
      ASSERT_EQ(world.step(hand(1e-3 * i)).status, Status::ok);
      const Pose& after = world.frame_pose(1);
      const Attachment& grip = world.attachments()[find(world.attachments(), "grip")];
      const Eigen::AngleAxisd turn(after.orientation * before.orientation.conjugate());
      work -= grip.force.dot(after.position - before.position) + turn.angle() * grip.torque.dot(turn.axis());
    }
    const Ledger ledger = world.ledger();
    EXPECT_NEAR(ledger.balance.work.attachments, work, 1e-6 * scale);
    EXPECT_GT(std::abs(work), 0.01);
    EXPECT_GT(ledger.balance.dissipated.bending, 1e-5);
    EXPECT_GT(ledger.balance.dissipated.drag, 1e-4);
    EXPECT_NEAR(ledger.unaccounted(), 0, tolerated * scale);
    EXPECT_NEAR(ledger.change, ledger.balance.net() + ledger.unaccounted(), 1e-15);
  }
}

/// What slides to rest on a floor has lost its kinetic energy there.
TEST(Ledger, FrictionTakesWhatSlides) {
  SceneDesc scene = scenes::one_cable(10);
  CableDesc& cable = scene.cables[0];
  cable.initial.type = InitialShapeDesc::Type::points;
  for (int i = 0; i <= 10; ++i) {
    cable.initial.points.emplace_back(0.1 * i, 0, 0.005);
    cable.initial.velocities.emplace_back(0.3, 0, 0);
  }
  ObstacleDesc floor;
  floor.name = "floor";
  floor.friction = 0.3;
  scene.obstacles.push_back(floor);
  World world(scene, BoundaryInputs(1));
  const double kinetic = world.energy().kinetic;
  EXPECT_NEAR(kinetic, 0.5 * 0.1 * 0.09, 1e-12);
  for (int i = 0; i < 500; ++i) ASSERT_EQ(world.step(BoundaryInputs(1)).status, Status::ok);
  // And it has sunk in until the floor bears it, by some micrometers. Contacts are solved to 4e-3 segment lengths per second.
  EXPECT_NEAR(world.ledger().balance.dissipated.contact, kinetic, 0.01 * kinetic);
  EXPECT_NEAR(world.ledger().unaccounted(), 0, 4e-3 * kinetic);
}

/// A winch that lifts a load lends it the energy, and that of the material that goes in.
TEST(Ledger, WinchesLift) {
  SceneDesc scene = scenes::one_cable(20);
  scene.cables[0].attachments = {scenes::attachment("winch", PlaceDesc::At::start, {0, 0, 0})};
  scene.cables[0].point_masses = {scenes::payload(0.2)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, BoundaryInputs(1));
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 0.7, 0.2}).ok);
  for (int i = 0; i < 3000; ++i) ASSERT_EQ(world.step(BoundaryInputs(1)).status, Status::ok);
  const Ledger ledger = world.ledger();
  EXPECT_GT(ledger.change, 0.2 * gravity * 0.29);
  EXPECT_NEAR(ledger.balance.work.winches, ledger.change, 1e-3 * ledger.change);
  EXPECT_NEAR(ledger.unaccounted(), 0, 1e-3 * scale);
}

/// Directions of segments change with the lengths that they are divided by, which grow and shrink beside a guide.
TEST(Ledger, BendsThatMaterialFlowsThroughLoseWhatTheirDampingTakes) {
  SceneDesc scene = scenes::one_cable(50, 2);
  scene.materials[0].material.bending_stiffness = 0.01;
  scene.materials[0].material.bending_damping = 1e-3;
  scene.cables[0].point_masses = {scenes::payload(0.1), scenes::payload(0.3)};
  scene.cables[0].point_masses[0].place.at = PlaceDesc::At::start;
  const Vector3 side(0.5, 0, -0.5 * std::sqrt(3.0));
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{-side.x(), 0, side.z()}, Vector3::Zero(), side};
  GuideDesc eye;
  eye.name = "eye";
  eye.cable = "cable";
  eye.place = PlaceDesc{PlaceDesc::At::arc_length, 1};
  eye.friction = 0.1;
  scene.guides = {eye};
  World world(scene, {});
  for (int i = 0; i < 300; ++i) ASSERT_EQ(world.step({}).status, Status::ok);
  const Ledger ledger = world.ledger();
  EXPECT_GT(ledger.balance.dissipated.bending, 0.01);
  EXPECT_LT(ledger.balance.dissipated.bending, scale);
  EXPECT_NEAR(ledger.unaccounted(), 0, 1e-4 * 12 * scale);  // of a rope of 0.2 kg, 2 m, and its loads
}

TEST(Ledger, BodiesLoseWhatTheirDampingTakes) {
  SceneDesc scene = scenes::one_cable(10);
  BodyDesc body;
  body.name = "ball";
  body.mass = 0.3;
  body.inertia = Vector3(1e-3, 2e-3, 3e-3);
  body.linear_damping = 0.2;
  body.angular_damping = 1e-3;
  body.pose = InitialPose{1, 0, 0, 0, 0, 0};
  scene.bodies.push_back(body);
  scene.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 0}),
                                 scenes::attachment("load", PlaceDesc::At::end, {-0.02, 0, 0})};
  scene.cables[0].attachments[1].body = "ball";
  World world(scene, BoundaryInputs(1));
  for (int i = 0; i < 1500; ++i) ASSERT_EQ(world.step(BoundaryInputs(1)).status, Status::ok);
  const Ledger ledger = world.ledger();
  EXPECT_GT(ledger.balance.dissipated.bodies, 0.1);
  EXPECT_NEAR(ledger.unaccounted(), 0, tolerated * 0.4 * gravity);
  EXPECT_EQ(ledger.unaccounted_steps, 0);
}

/// What a cut takes with its segment's bends, and what a tuned material adds, are edits.
TEST(Ledger, EditsHaveEntries) {
  SceneDesc scene = scenes::between_two_points(20, 0.6);
  scene.materials[0].material.bending_stiffness = 0.01;
  World world(scene, BoundaryInputs(1));
  for (int i = 0; i < 10; ++i) world.step(BoundaryInputs(1));
  const double before = world.energy().total(), edits = world.ledger().balance.dissipated.edits;
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 10}).ok);
  const double cut = world.energy().total() - before;
  EXPECT_LT(cut, -1e-4);
  EXPECT_NEAR(world.ledger().balance.dissipated.edits - edits, -cut, 1e-12);
  scene.materials[0].material.bending_stiffness = 0.02;
  const double untuned = world.energy().total();
  world.tune(scene);
  EXPECT_GT(world.energy().total() - untuned, 1e-4);
  EXPECT_NEAR(world.ledger().balance.work.applied, world.energy().total() - untuned, 1e-12);
  for (int i = 0; i < 100; ++i) world.step(BoundaryInputs(1));
  EXPECT_NEAR(world.ledger().unaccounted(), 0, tolerated * scale);
}

/// What ends that are drawn together lose as they are welded is an edit's.
TEST(Ledger, ClosesOverAJoin) {
  SceneDesc scene = scenes::between_two_points(40, 0.6);
  scene.materials[0].material.bending_stiffness = 0.02;
  scene.materials[0].material.torsional_stiffness = 0.015;
  scene.materials[0].material.bending_damping = 1e-3;
  for (AttachmentDesc& attachment : scene.cables[0].attachments) attachment.type = AttachmentType::clamp;
  World world(scene, BoundaryInputs(1));
  for (int i = 0; i < 100; ++i) world.step(BoundaryInputs(1));
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 20}).ok);
  for (int i = 0; i < 30; ++i) world.step(BoundaryInputs(1));
  const double edits = world.ledger().balance.dissipated.edits, before = world.ledger().unaccounted();
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, false}).ok);
  for (int i = 0; i < 300; ++i) world.step(BoundaryInputs(1));
  ASSERT_EQ(world.cables().size(), 1u);
  ASSERT_EQ(world.cables()[0].state.segments(), 39);
  EXPECT_GT(world.ledger().balance.dissipated.edits - edits, 1e-3);
  EXPECT_NEAR(world.ledger().unaccounted(), before, 10 * tolerated * scale);
}

/// Without gravity, what is bent and at rest has no energy that moves, and its energies are rounded.
TEST(Ledger, RoundingIsNotTold) {
  SceneDesc scene = scenes::held_by_a_hand(20, AttachmentType::clamp);
  scene.gravity.acceleration = Vector3::Zero();
  scene.materials[0].material.bending_stiffness = 0.05;
  scene.materials[0].material.bending_damping = 0.01;
  scene.materials[0].material.yield_curvature = 2;
  scene.materials[0].material.hardening = 0.1;
  const auto hand = [](double x) { return scenes::hand_at({x, 0, 0}); };
  constexpr double apart = 0.7;
  World world(scene, hand(apart));
  for (int i = 0; i < 3000; ++i) world.step(hand(apart));
  ASSERT_GT(world.energy().total(), 0.01);
  const auto told = world.ledger().unaccounted_steps;
  for (int i = 0; i < 2000; ++i) world.step(hand(apart));
  EXPECT_EQ(world.ledger().unaccounted_steps, told);
}

/// It is state: a copy goes on with it, and the hash knows it.
TEST(Ledger, IsCopiedWithItsWorld) {
  const SceneDesc scene = scenes::released(12, 1);
  World world(scene, BoundaryInputs(1));
  for (int i = 0; i < 20; ++i) world.step(BoundaryInputs(1));
  World copy = world;
  for (World* w : {&world, &copy})
    for (int i = 0; i < 20; ++i) w->step(BoundaryInputs(1));
  EXPECT_EQ(world.ledger().unaccounted(), copy.ledger().unaccounted());
  EXPECT_EQ(world.hash(), copy.hash());
}

/// The same whether a cable is stepped alone or in the lanes of many.
TEST(Ledger, IsTheSameInLanes) {
  SceneDesc scene = scenes::between_two_points(17, 0.5);
  scene.materials[0].material.bending_stiffness = 0.002;
  scene.materials[0].material.bending_damping = 1e-4;
  scene.materials[0].material.drag = 0.1;
  SceneDesc many = scene;
  for (int k = 1; k < 8; ++k) {
    many.cables.push_back(scene.cables[0]);
    many.cables.back().name += std::to_string(k);
    for (AttachmentDesc& attachment : many.cables.back().attachments) attachment.name += std::to_string(k);
  }
  World one(scene, BoundaryInputs(1)), eight(many, BoundaryInputs(1));
  for (int i = 0; i < 200; ++i) {
    one.step(BoundaryInputs(1));
    eight.step(BoundaryInputs(1));
  }
  const EnergyBalance::Dissipated &alone = one.ledger().balance.dissipated, &all = eight.ledger().balance.dissipated;
  EXPECT_GT(alone.bending, 1e-6);
  EXPECT_NEAR(all.bending, 8 * alone.bending, 1e-14);
  EXPECT_NEAR(all.drag, 8 * alone.drag, 1e-14);
}

/// 0 to 1 in 0.3 s with the greatest jerks where it begins and ends, there and back each second.
double stroke(double t) {
  const double phase = std::fmod(t, 1.0), p = std::clamp((phase < 0.5 ? phase : 1 - phase) / 0.3, 0.0, 1.0);
  return p * p * (3 - 2 * p);
}

/// A hand that starts and stops: no velocity that is mended at the end of a step makes energy.
TEST(Ledger, JerksOfHandsMakeNoEnergy) {
  for (const double stiffness : {infinity, 2e4})
    for (const double across : {0.02, 0.005})  // two bending stiffnesses: a whole rod, whose sections spin
      for (const AttachmentType type : {AttachmentType::hinge, AttachmentType::clamp}) {
        SceneDesc scene = scenes::held_by_a_hand(40, type);
        scene.time_step = 0.005;
        MaterialDesc& material = scene.materials[0].material;
        material.bending_stiffness[0] = 0.02;
        material.bending_stiffness[1] = across;
        if (across < 0.02) material.torsional_stiffness = 0.01;
        material.axial_stiffness = stiffness;
        World world(scene, scenes::hand_at({0.7, 0, 0}));
        double greatest = 0;
        for (int i = 1; i <= 600; ++i) {
          const double before = world.ledger().unaccounted(), s = stroke(0.005 * i);
          ASSERT_EQ(world.step(scenes::hand_at({0.7 - 0.3 * s, 0.2 * s, 0.1 * s})).status, Status::ok);
          greatest = std::max(greatest, std::abs(world.ledger().unaccounted() - before));
        }
        const std::string name = testing::PrintToString(stiffness) + " " + testing::PrintToString(across);
        EXPECT_EQ(world.ledger().unaccounted_steps, 0) << name << " " << greatest;
        EXPECT_GT(world.ledger().balance.dissipated.unresolved, 0) << name;
      }
}

/// What falls on a floor and cannot be stretched by much: iterations end when no energy is missing.
TEST(Ledger, BlowsOfStiffCablesMakeNoEnergy) {
  for (const double stiffness : {infinity, 2e5}) {
    SceneDesc scene = scenes::one_cable(40);
    scene.time_step = 0.002;
    scene.materials[0].material.bending_stiffness = 0.01;
    scene.materials[0].material.axial_stiffness = stiffness;
    CableDesc& cable = scene.cables[0];
    cable.initial.type = InitialShapeDesc::Type::points;
    cable.initial.points = {{0, 0, 0.1}, {0.6, 0, 0.9}};
    ObstacleDesc floor;
    floor.name = "floor";
    floor.friction = 0.4;
    scene.obstacles.push_back(floor);
    World world(scene, BoundaryInputs(1));
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(world.step(BoundaryInputs(1)).status, Status::ok);
    EXPECT_EQ(world.ledger().unaccounted_steps, 0) << stiffness;
    EXPECT_GT(world.ledger().balance.dissipated.unresolved, 0.05 * scale);
  }
}

class DescribedLedgers : public testing::TestWithParam<Case> {};

/// [J] What a tenth of a second may leave.
double tolerance(const Case& parameters) {
  const std::string name = described::name_of(parameters);
  const auto has = [&](const char* part) { return name.find(part) != std::string::npos; };
  // m g L, of 0.05 kg/m along half a meter; of two cables where there are two.
  const double scale = (parameters.surroundings == Surroundings::likes ? 2 : 1) * 0.05 * 0.5 * gravity * 0.5;
  // Joints beside a stiff end are a hundred times as stiff as the others: what is left of their angles works a hundred times as
  // much.
  if (has("StiffEnds")) return 0.05 * scale;
  // So is a stiff section beside its soft neighbours, ten times as much.
  if (has("StiffInside")) return 1e-3 * scale;
  // At a winch, what can stretch is wound in the middle of a step; the rest length of its end is of first order there.
  if (parameters.winch != described::Winch::none && described::is_elastic(parameters)) return 5e-3 * scale;
  // Steps that contacts keep busy are solved to 4e-3 segment lengths per second.
  if (parameters.surroundings == Surroundings::floor) return 3e-3 * scale;
  // Junctions and bodies have velocities of their own at the end of a step, which their cables follow.
  if (described::is_in_island(parameters) || described::is_split(parameters.description)) return 2e-3 * scale;
  return 2e-4 * scale;
}

/// Of all features, however a cable is described and held.
TEST_P(DescribedLedgers, Close) {
  described::Run run(GetParam(), GetParam().description);
  for (int i = 0; i < 100; ++i) run.step();
  const Ledger ledger = run.world().ledger();
  RecordProperty("unaccounted_nJ", static_cast<int>(std::clamp(1e9 * ledger.unaccounted(), -2e9, 2e9)));
  EXPECT_NEAR(ledger.unaccounted(), 0, tolerance(GetParam()));
}

INSTANTIATE_TEST_SUITE_P(All, DescribedLedgers, testing::ValuesIn(described::all_cases()),
                         [](const auto& info) { return described::name_of(info.param); });

}  // namespace
}  // namespace verlet_cable
