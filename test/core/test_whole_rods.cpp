#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "../support/scenes.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;
using At = PlaceDesc::At;

constexpr double curvature = 8, torsion = 3;  // [1/m], [rad/m]

Vector3 on_helix(double s) {
  const double square = curvature * curvature + torsion * torsion, rate = std::sqrt(square), radius = curvature / square;
  return {radius * std::cos(rate * s), radius * std::sin(rate * s), torsion / rate * s};
}

/// A weightless coil of 1 m that is at rest in its own shape; `ribbon`: it bends unequally.
SceneDesc coil(int segments, bool ribbon = true) {
  SceneDesc scene = scenes::one_cable(segments);
  scene.gravity.acceleration.setZero();
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = ribbon ? BendingStiffness(0.02, 0.005) : BendingStiffness(0.02);
  material.torsional_stiffness = 0.01;
  CableDesc& cable = scene.cables[0];
  cable.rest_curvature.type = RestCurvatureDesc::Type::initial;
  cable.rest_twist = 2;
  cable.length = segments * (on_helix(1.0 / segments) - on_helix(0)).norm();
  cable.initial.type = InitialShapeDesc::Type::points;
  for (int i = 0; i <= segments; ++i) cable.initial.points.push_back(on_helix(static_cast<double>(i) / segments));
  return scene;
}

/// A ribbon of 1 m that hangs between two clamps, the second in the frame "hand".
SceneDesc ribbon_between_clamps(int segments, double roll = 0) {
  SceneDesc scene = scenes::one_cable(segments);
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = {0.02, 0.005};
  material.torsional_stiffness = 0.006;
  material.bending_damping = material.torsional_damping = 1e-3;
  material.drag = 0.2;
  scene.cables[0].attachments = {scenes::attachment("start", At::start, {0, 0, 0}, "", AttachmentType::clamp),
                                 scenes::attachment("end", At::end, {0, 0, 0}, "hand", AttachmentType::clamp)};
  scene.cables[0].attachments[1].initial_pose = InitialPose{0.7, 0, 0, roll, 0, 0};
  return scene;
}

BoundaryInputs hand(double x, double roll) {
  BoundaryInputs inputs(2);
  inputs[1].pose = {{x, 0, 0}, Quaternion(Eigen::AngleAxisd(roll, Vector3::UnitX()))};
  return inputs;
}

double elastic_energy(const World& world) {
  const Energy energy = world.energy();
  return energy.bend + energy.twist;
}

double total_twist(const World& world, int cable = 0) {
  const std::vector<double>& twist = world.cables()[cable].state.joint_twist;
  return std::accumulate(twist.begin(), twist.end(), 0.0);
}

double largest_distance(const std::vector<Vector3>& a, const std::vector<Vector3>& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

void expect_sound_frames(const SimulatedCable& cable) {
  const std::size_t n = cable.state.segments();
  ASSERT_EQ(cable.state.directors.size(), n);
  ASSERT_EQ(cable.state.spin.size(), n);
  ASSERT_EQ(cable.state.joint_twist.size(), n + 1);
  for (std::size_t i = 0; i < n; ++i) {
    const Vector3 along = (cable.state.positions[i + 1] - cable.state.positions[i]).normalized();
    ASSERT_NEAR(cable.state.directors[i].norm(), 1, 1e-9) << i;
    ASSERT_NEAR(cable.state.directors[i].dot(along), 0, 1e-9) << i;
  }
}

void run(World& world, int steps, const BoundaryInputs& inputs = {FrameInput{}}) {
  for (int i = 0; i < steps; ++i) ASSERT_EQ(world.step(inputs).status, Status::ok) << i;
}

void expect_at_rest(World& world, double tolerance, const char* what) {
  std::vector<std::vector<Vector3>> before;
  for (const SimulatedCable& cable : world.cables()) before.push_back(cable.state.positions);
  EXPECT_LT(elastic_energy(world), tolerance * tolerance) << what;
  run(world, 200);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_LT(largest_distance(world.cables()[i].state.positions, before[i]), tolerance) << what << " " << i;
}

TEST(WholeRod, InitialShapeIsFreeOfStress) {
  for (const bool ribbon : {false, true}) {
    SceneDesc scene = coil(30, ribbon);
    World free(scene, initial_frames(scene));
    expect_sound_frames(free.cables()[0]);
    expect_at_rest(free, 1e-9, "free");

    // Clamps that are neither along the cable nor rolled as it is: all of it is taken for its shape.
    AttachmentDesc start = scenes::attachment("start", At::start, on_helix(0), "", AttachmentType::clamp);
    start.rotation = {0.5, -0.4, 1.5};
    AttachmentDesc end = scenes::attachment("end", At::end, on_helix(1), "", AttachmentType::clamp);
    end.rotation = {-2, -0.3, 3.0};
    scene.cables[0].attachments = {start, end};
    World clamped(scene, initial_frames(scene));
    expect_at_rest(clamped, 1e-9, "clamped");
  }
}

TEST(WholeRod, HasItsRestTwistAtTheStartWhateverTheRollOfItsClamps) {
  for (const double roll : {0.0, 1.0, -3.0}) {
    SceneDesc scene = ribbon_between_clamps(20, roll);
    scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
    scene.cables[0].rest_twist = -1.5;
    scene.cables[0].attachments.push_back(scenes::attachment("middle", At::arc_length, {0.35, 0, 0}, "", AttachmentType::clamp));
    scene.cables[0].attachments[2].place.arc_length = 0.5;
    const World world(scene, initial_frames(scene));
    for (const double twist : node_twist(world.cables()[0].state)) EXPECT_NEAR(twist, -1.5, 1e-12);
    EXPECT_LT(world.energy().twist, 1e-20);
  }
}

TEST(WholeRod, AxesAreThoseOfTheFirstClamp) {
  SceneDesc scene = ribbon_between_clamps(10);
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].attachments.pop_back();
  scene.cables[0].attachments[0].rotation = {0.7, 0, 0};
  const World clamped(scene, initial_frames(scene));
  for (const Vector3& y : clamped.cables()[0].state.directors)
    EXPECT_LT((y - Vector3(0, std::cos(0.7), std::sin(0.7))).norm(), 1e-12);

  scene.cables[0].attachments.clear();
  scene.cables[0].initial.to = {1, 2, 3};
  const World free(scene, initial_frames(scene));
  const Vector3 y = smallest_rotation(Vector3::UnitX(), Vector3(1, 2, 3)) * Vector3::UnitY();
  EXPECT_LT((free.cables()[0].state.directors[0] - y).norm(), 1e-12);
}

/// A rod of constant curvature and twist, clamped and left to itself, coils up: radius k / (k² + t²), pitch t / (k² + t²).
TEST(WholeRod, ConstantCurvatureAndTwistMakeACoil) {
  std::vector<double> errors;
  for (const int n : {20, 40}) {
    SceneDesc scene = scenes::one_cable(n);
    scene.gravity.acceleration.setZero();
    scene.materials[0].material.bending_stiffness = {0.02, 0.01};
    scene.materials[0].material.torsional_stiffness = 0.01;
    scene.cables[0].attachments = {scenes::attachment("a", At::start, {0, 0, 0}, "", AttachmentType::clamp)};
    scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
    scene.cables[0].rest_curvature = {RestCurvatureDesc::Type::constant, {0, 4}, {}};
    scene.cables[0].rest_twist = 2;
    World world(scene, initial_frames(scene));
    EXPECT_TRUE(world.settle());
    // About the screw's axis, which is along (twist, 0, curvature) at the clamp.
    const Vector3 axis = Vector3(2, 0, 4) / std::sqrt(20.0);
    const double rate = std::sqrt(20.0), radius = 4 / 20.0;
    const Vector3 inward(0, 1, 0), tangent = axis.cross(-inward);
    const Vector3 tip = radius * inward - radius * std::cos(rate) * inward + radius * std::sin(rate) * tangent + 2 / rate * axis;
    errors.push_back((world.cables()[0].state.positions.back() - tip).norm());
  }
  EXPECT_LT(errors[1], 2e-3);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.5) << "second order";
}

TEST(WholeRod, SettledStartHasItsRestTwistAltogether) {
  for (const double roll : {0.0, 2.0}) {
    SceneDesc scene = ribbon_between_clamps(24, roll);
    scene.cables[0].rest_twist = 0.5;
    World world(scene, initial_frames(scene));
    EXPECT_TRUE(world.findings().unsettled.empty());
    EXPECT_NEAR(total_twist(world), 0.5, 1e-3);
    const std::vector<Vector3> before = world.cables()[0].state.positions;
    run(world, 300, hand(0.7, roll));
    EXPECT_LT(largest_distance(world.cables()[0].state.positions, before), 1e-4);
  }
}

TEST(WholeRod, PiecesOfACutKeepTheirShape) {
  const SceneDesc scene = coil(30);
  World world(scene, initial_frames(scene));
  const CableState whole = world.cables()[0].state;
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 12}).ok);
  for (int i = 0; i < 12; ++i) EXPECT_EQ(world.cables()[0].state.directors[i], whole.directors[i]);
  for (int i = 0; i < 17; ++i) EXPECT_EQ(world.cables()[1].state.directors[i], whole.directors[13 + i]);
  for (const SimulatedCable& cable : world.cables()) expect_sound_frames(cable);
  expect_at_rest(world, 1e-9, "pieces");
}

/// Two halves of a coil, each with its own axes and in any direction, are the coil when welded.
TEST(WholeRod, PiecesThatAreJoinedAreWhatTheyWere) {
  for (const bool first_reversed : {false, true})
    for (const bool second_reversed : {false, true}) {
      SceneDesc scene = coil(30);
      scene.cables.push_back(scene.cables[0]);
      for (int half = 0; half < 2; ++half) {
        CableDesc& cable = scene.cables[half];
        cable.name = half == 0 ? "first" : "second";
        cable.segments = 15;
        cable.length *= 0.5;
        const std::vector<Vector3>& all = cable.initial.points;
        std::vector<Vector3> points(all.begin() + 15 * half, all.begin() + 15 * half + 16);
        if (half == 0 ? first_reversed : second_reversed) std::reverse(points.begin(), points.end());
        cable.initial.points = points;
      }
      World world(scene, initial_frames(scene));
      const std::vector<Vector3> directors = world.cables()[0].state.directors;
      ASSERT_TRUE(world.apply(edit::Join{0, !first_reversed, 1, second_reversed}).ok);
      ASSERT_EQ(world.cables().size(), 1u);
      const SimulatedCable& cable = world.cables()[0];
      ASSERT_EQ(cable.state.segments(), 30);
      expect_sound_frames(cable);
      for (int i = 0; i < 15; ++i) EXPECT_LT((cable.state.directors[first_reversed ? 15 + i : i] - directors[i]).norm(), 1e-9);
      // The weld alone is not measured, but as curved as its neighbours, to 0.2 %.
      expect_at_rest(world, 4e-4, "joined");
    }
}

TEST(WholeRod, EndsThatAreApartAreJoinedAsTheyCome) {
  SceneDesc scene = coil(20);
  scene.materials[0].material.drag = 0.3;
  scene.materials[0].material.bending_damping = scene.materials[0].material.torsional_damping = 1e-3;
  scene.cables.push_back(scene.cables[0]);
  scene.cables[1].name = "other";
  for (Vector3& point : scene.cables[1].initial.points) point = Vector3(0.1, 0.2, 0.4) - point;
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, true}).ok);
  for (int i = 0; i < 4000; ++i) ASSERT_LE(world.step({FrameInput{}}).status, Status::overstretched) << i;
  ASSERT_EQ(world.cables().size(), 1u);
  EXPECT_EQ(world.cables()[0].state.segments(), 40);
  expect_sound_frames(world.cables()[0]);
  EXPECT_LT(elastic_energy(world), 1e-3);
}

TEST(WholeRod, PinsAndUnpinsDoNotTwistIt) {
  SceneDesc scene = ribbon_between_clamps(6);
  World world(scene, initial_frames(scene));
  // Three turns: more than half a turn in every joint.
  for (int i = 0; i < 3000; ++i) world.step(hand(0.7, 6 * M_PI * (i + 1) / 3000));
  run(world, 2000, hand(0.7, 6 * M_PI));
  const double twist = total_twist(world), energy = elastic_energy(world);
  EXPECT_NEAR(std::abs(twist), 6 * M_PI, 1.5);
  for (const int node : {3, 2}) {
    edit::Pin pin;
    pin.name = "pin";
    pin.body = cable_id(0);
    pin.node = node;
    pin.type = AttachmentType::clamp;
    pin.pose.position = world.cables()[0].state.positions[node];
    pin.pose.orientation =
        Quaternion(Eigen::AngleAxisd(2, Vector3::UnitX())) * segment_orientations(world.cables()[0].state)[node];
    ASSERT_TRUE(world.apply(pin).ok);
    EXPECT_NEAR(elastic_energy(world), energy, 0.05 * energy);
    EXPECT_EQ(world.cables()[0].state.joint_twist[node], 0);
    ASSERT_TRUE(world.apply(edit::Unpin{"pin"}).ok);
    EXPECT_NEAR(total_twist(world), twist, 1e-9);
    EXPECT_NEAR(elastic_energy(world), energy, 1e-9 * energy);
  }
  // An end that is let go and caught again is not twisted, but as it is unloaded.
  ASSERT_TRUE(world.apply(edit::Unpin{"end"}).ok);
  EXPECT_EQ(world.cables()[0].state.joint_twist[6], 0);
  run(world, 300, hand(0.7, 0));
  const double untwisted = elastic_energy(world);
  edit::Pin pin;
  pin.body = cable_id(0);
  pin.node = 6;
  pin.type = AttachmentType::clamp;
  pin.pose.position = world.cables()[0].state.positions[6];
  pin.pose.orientation = Quaternion(Eigen::AngleAxisd(1, Vector3(1, 2, 3).normalized()));
  ASSERT_TRUE(world.apply(pin).ok);
  EXPECT_NEAR(elastic_energy(world), untwisted, 1e-6);
}

TEST(WholeRod, TuningGivesAndTakesFrames) {
  SceneDesc scene = ribbon_between_clamps(20);
  scene.materials[0].material.bending_stiffness = 0.02;
  scene.materials[0].material.bending_damping = scene.materials[0].material.torsional_damping = 1e-4;
  World world(scene, initial_frames(scene));
  for (int i = 0; i < 1000; ++i) world.step(hand(0.7, 2 * (i + 1) / 1000.0));
  run(world, 9000, hand(0.7, 2));
  const std::vector<Quaternion> before = segment_orientations(world.cables()[0].state);
  const std::vector<double> twist = node_twist(world.cables()[0].state);
  const Energy energy = world.energy();
  const auto expect_same = [&] {
    const std::vector<Quaternion> now = segment_orientations(world.cables()[0].state);
    for (std::size_t i = 0; i < now.size(); ++i) EXPECT_LT(now[i].angularDistance(before[i]), 1e-6) << i;
    for (std::size_t i = 0; i < twist.size(); ++i) EXPECT_NEAR(node_twist(world.cables()[0].state)[i], twist[i], 1e-6) << i;
    EXPECT_NEAR(world.energy().twist, energy.twist, 1e-6);
  };
  // A round straight cable that clamps twist needs its frames for the damping of bending only.
  expect_sound_frames(world.cables()[0]);
  const double damping = std::exchange(scene.materials[0].material.bending_damping, 0.0);
  world.tune(scene);
  EXPECT_TRUE(world.cables()[0].state.directors.empty());
  run(world, 200, hand(0.7, 2));
  expect_same();
  scene.materials[0].material.bending_damping = damping;
  world.tune(scene);
  expect_sound_frames(world.cables()[0]);
  expect_same();
  run(world, 200, hand(0.7, 2));
  expect_same();
}

/// A straight cable that was joined with a curved one needs torsional stiffness, too, though the scene does not know.
TEST(WholeRod, TuningDoesNotTakeTheTorsionalStiffnessThatAJoinedCableNeeds) {
  SceneDesc scene = coil(20, false);
  scene.materials.push_back(scene.materials[0]);
  scene.materials[1].name = "other";
  scene.cables.push_back(scene.cables[0]);
  scene.cables[0].rest_twist = 0;
  scene.cables[0].rest_curvature = {};
  scene.cables[1].name = "curved";
  scene.cables[1].material = "other";
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, true}).ok);
  SceneDesc tuned = scene;
  tuned.materials[0].material.torsional_stiffness = 0;
  ASSERT_TRUE(validate(tuned).empty());
  const std::uint64_t before = world.hash();
  EXPECT_THROW(world.tune(tuned), SceneError);
  EXPECT_EQ(world.hash(), before);
}

/// What a winch pays out is as twisted as the cable is: the cheap law of straight round cables says the same.
/// Both of its nodes may be held at one place.
TEST(SegmentOrientations, AreRotationsWhereASegmentHasNoLength) {
  for (const bool whole : {false, true}) {
    CableState state = World(scenes::one_cable(3), {}).cables()[0].state;
    if (whole) {
      std::vector<DirectionTarget> no_clamps;
      give_frames(state, no_clamps);
    }
    const auto check = [&] {
      for (const Quaternion& q : segment_orientations(state)) EXPECT_NEAR(q.norm(), 1, 1e-9) << "frames: " << whole;
    };
    for (const int node : {0, 1, 2}) {
      const std::vector<Vector3> apart = state.positions;
      state.positions[node + 1] = state.positions[node];
      carry_frames(apart, state);
      check();
      const std::vector<Vector3> together = state.positions;
      state.positions = apart;
      carry_frames(together, state);
      check();
    }
  }
}

TEST(WholeRod, WinchPassesTwistOn) {
  std::vector<World> worlds;
  for (const double difference : {0.0, 1e-9}) {
    SceneDesc scene = ribbon_between_clamps(30);
    scene.materials[0].material.bending_stiffness = {0.02, 0.02 * (1 + difference)};
    World world(scene, initial_frames(scene));
    for (int i = 0; i < 1000; ++i) world.step(hand(0.7, 3 * (i + 1) / 1000.0));
    for (const double length : {1.4, 1.1}) {
      ASSERT_TRUE(world.apply(edit::SetLength{0, false, length, 0.3}).ok);
      run(world, 3000, hand(0.7, 3));
    }
    worlds.push_back(world);
  }
  const SimulatedCable &cheap = worlds[0].cables()[0], &whole = worlds[1].cables()[0];
  expect_sound_frames(whole);
  ASSERT_EQ(cheap.state.segments(), whole.state.segments());
  EXPECT_LT(largest_distance(cheap.state.positions, whole.state.positions), 0.01);
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  EXPECT_NEAR(mean(node_twist(whole.state)) / mean(node_twist(cheap.state)), 1, 0.03);
}

/// A coil that a winch pays out and takes in keeps its shape: new segments are curved and twisted at rest as the others.
TEST(WholeRod, WinchKeepsRestShape) {
  SceneDesc scene = coil(30);
  scene.materials[0].material.drag = 0.2;
  scene.materials[0].material.bending_damping = scene.materials[0].material.torsional_damping = 1e-3;
  AttachmentDesc start = scenes::attachment("start", At::start, on_helix(0), "", AttachmentType::clamp);
  start.rotation = {0, -0.3, M_PI / 2};
  scene.cables[0].attachments = {start};
  World world(scene, initial_frames(scene));
  for (const double length : {1.3, 1.0}) {  // [m]
    ASSERT_TRUE(world.apply(edit::SetLength{0, false, length, 0.3}).ok);
    run(world, 4000);
    const SimulatedCable& cable = world.cables()[0];
    expect_sound_frames(cable);
    EXPECT_NEAR(cable.state.length(), length, 1e-9);
    const std::vector<double> curvatures = node_curvature(cable.state);
    for (const double k : curvatures) EXPECT_NEAR(k, curvature, 0.08 * curvature);
    EXPECT_LT(elastic_energy(world), 1e-4);
  }
}

TEST(WholeRod, CopiesGoOnAsTheirOriginal) {
  SceneDesc scene = ribbon_between_clamps(20);
  World world(scene, initial_frames(scene));
  for (int i = 0; i < 200; ++i) world.step(hand(0.7 - 1e-4 * i, 0.01 * i));
  World copy = world;
  EXPECT_EQ(copy.hash(), world.hash());
  for (int i = 0; i < 100; ++i) {
    world.step(hand(0.68, 2));
    copy.step(hand(0.68, 2));
  }
  EXPECT_EQ(copy.hash(), world.hash());
  EXPECT_EQ(copy.cables()[0].state.directors, world.cables()[0].state.directors);
}

}  // namespace
}  // namespace verlet_cable
