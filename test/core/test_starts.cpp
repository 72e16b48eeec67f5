#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <ctime>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "../support/scenes.h"

// Cables that are given no shape start at rest, and stay there.

namespace verlet_cable {
namespace {

using At = PlaceDesc::At;

struct Case {
  std::string name;
  std::vector<AttachmentDesc> attachments;
  bool floor = false;
  bool weightless = false;
};

std::ostream& operator<<(std::ostream& stream, const Case& start) {
  return stream << start.name;
}

AttachmentDesc clamp(const std::string& name, At at, const Vector3& offset, const Vector3& rotation = Vector3::Zero()) {
  AttachmentDesc desc = scenes::attachment(name, at, offset, "", AttachmentType::clamp);
  desc.rotation = rotation;
  desc.place.arc_length = 0.4;
  return desc;
}

std::vector<Case> cases() {
  const Vector3 up{0, -M_PI / 2, 0}, down{0, M_PI / 2, 0}, back{0, 0, M_PI};
  const auto two = [](const Vector3& end, const Vector3& first = Vector3::Zero(), const Vector3& second = Vector3::Zero()) {
    return std::vector<AttachmentDesc>{clamp("a", At::start, {0, 0, 0}, first), clamp("b", At::end, end, second)};
  };
  std::vector<Case> all{{"level", two({0.7, 0, 0})},
                        {"slack", two({0.3, 0, 0})},
                        {"taut", two({1, 0, 0})},
                        {"nearly_taut", two({0.999, 0, 0})},
                        {"coincident", two({0.001, 0, 0})},
                        {"opposite", two({0.5, 0, 0}, back, back)},
                        {"up_and_down", two({0.5, 0, 0}, up, down)},
                        {"down_and_up", two({0.5, 0, 0}, down, up)},
                        {"above_each_other", two({0, 0, -0.8}, down, down)},
                        {"rolled", two({0.6, 0, 0}, Vector3::Zero(), {3, 0, 0})},
                        {"askew", two({0.3, 0.4, 0.2}, {0.3, 0.5, 1.2}, {1, -0.6, -2})},
                        {"cantilever", {clamp("a", At::start, {0, 0, 0})}},
                        {"one_up", {clamp("a", At::start, {0, 0, 0}, up)}},
                        {"one_down", {clamp("a", At::start, {0, 0, 0}, down)}},
                        {"inner", {clamp("a", At::arc_length, {0, 0, 0})}},
                        {"inner_up", {clamp("a", At::arc_length, {0, 0, 0}, up)}}};
  Case hinged{"clamp_and_hinge", two({0.6, 0, 0.1}, {0, 0, M_PI / 2})};
  hinged.attachments[1].type = AttachmentType::hinge;
  all.push_back(hinged);
  Case three{"three", two({0.6, 0, 0})};
  three.attachments.push_back(clamp("c", At::arc_length, {0.25, 0.1, -0.1}));
  all.push_back(three);
  all.push_back({"weightless", two({0.6, 0, 0}), false, true});
  all.push_back({"on_a_floor", two({0.5, 0, 0}), true});
  return all;
}

SceneDesc make_scene(const Case& start, double bending, double axial) {
  SceneDesc scene = scenes::one_cable(50);
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = bending;
  material.torsional_stiffness = 0.8 * bending;
  material.axial_stiffness = axial;
  scene.cables[0].attachments = start.attachments;
  if (start.weightless) scene.gravity.acceleration.setZero();
  if (start.floor) {
    ObstacleDesc floor;
    floor.name = "floor";
    floor.pose = {0, 0, -0.2, 0, 0, 0};
    scene.obstacles = {floor};
  }
  return scene;
}

double fastest(World& world, int steps) {
  double speed = 0;
  const BoundaryInputs inputs(world.frames().size());
  for (int i = 0; i < steps; ++i) {
    EXPECT_EQ(world.step(inputs).status, StepResult::Status::ok);
    for (const Vector3& v : world.cables()[0].state.velocities) speed = std::max(speed, v.norm());
  }
  return speed;
}

class Starts : public ::testing::TestWithParam<Case> {};

TEST_P(Starts, StayAtRest) {
  for (const double bending : {1e-4, 1e-2, 0.1})
    for (const double axial : {infinity, 1e6}) {
      const SceneDesc scene = make_scene(GetParam(), bending, axial);
      World world(scene, initial_frames(scene));
      EXPECT_TRUE(world.findings().unsettled.empty());
      // Equilibria that would not last are left in fractions of a second; on a floor friction may hold what creeps.
      EXPECT_LT(fastest(world, 300), GetParam().floor ? 5e-3 : 2e-4) << "bending stiffness " << bending << ", axial " << axial;
      for (const double twist : world.cables()[0].state.twist) EXPECT_LT(std::abs(twist), 1e-3);
      EXPECT_EQ(World(scene, initial_frames(scene)).hash(), World(scene, initial_frames(scene)).hash());
    }
}

INSTANTIATE_TEST_SUITE_P(Cables, Starts, ::testing::ValuesIn(cases()), [](const auto& info) { return info.param.name; });

/// Any cable, held in any way.
SceneDesc random_scene(unsigned seed) {
  std::mt19937 random(seed);
  const auto between = [&](double low, double high) { return low + (high - low) * std::ldexp(random() >> 8, -24); };
  const auto direction = [&] {
    const double x = between(-1, 1), y = between(-1, 1), z = between(-1, 1);
    return Vector3(x, y, z);
  };
  SceneDesc scene = scenes::one_cable(static_cast<int>(between(8, 70)));
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = std::pow(10, between(-5, 1));
  material.torsional_stiffness = between(0, 1) < 0.5 ? 0 : 0.8 * material.bending_stiffness.front();
  if (between(0, 1) < 0.5) material.axial_stiffness = std::pow(10, between(3, 7));
  material.linear_density = std::pow(10, between(-2, 0.3));
  const Vector3 end = between(0.02, 1) * direction().normalized();
  std::vector<AttachmentDesc>& attachments = scene.cables[0].attachments;
  attachments = {clamp("a", At::start, {0, 0, 0}, M_PI * direction()), clamp("b", At::end, end, M_PI * direction())};
  const int kind = static_cast<int>(between(0, 4));
  if (kind == 1) attachments.pop_back();
  if (kind == 2) attachments[1].type = AttachmentType::hinge;
  if (between(0, 1) < 0.4) {
    ObstacleDesc floor;
    floor.name = "floor";
    floor.pose = {0, 0, -0.1 + (kind == 1 ? 0 : std::min(0.0, end.z())) - between(0, 0.5), 0, 0, 0};
    floor.friction = between(0, 1);
    scene.obstacles = {floor};
  }
  if (between(0, 1) < 0.2) scene.contact = ContactDesc{};
  return scene;
}

TEST(Start, WhatDoesNotStayIsNamed) {
  int named = 0, named_in_the_air = 0;
  constexpr int scenes = 200;
  for (unsigned seed = 0; seed < scenes; ++seed) {
    const SceneDesc scene = random_scene(seed);
    World world(scene, initial_frames(scene));
    if (!world.findings().unsettled.empty()) {
      ++named;
      named_in_the_air += scene.obstacles.empty();
      continue;
    }
    EXPECT_LT(fastest(world, 500), 1e-2) << "seed " << seed;
  }
  EXPECT_LT(named, scenes / 10);
  EXPECT_EQ(named_in_the_air, 0);
}

/// What cannot be settled soon is given up. A step is the measure, whatever the machine and the build.
TEST(Start, LongCableStartsSoon) {
  SceneDesc scene = make_scene(cases()[0], 0.02, infinity);
  scene.cables[0].segments = 10000;
  const std::vector<FrameInput> frames = initial_frames(scene);
  const std::clock_t begin = std::clock();
  World world(scene, frames);
  const std::clock_t started = std::clock();
  constexpr int steps = 10;
  for (int i = 0; i < steps; ++i) world.step(frames);
  const std::clock_t end = std::clock();
  const double start = static_cast<double>(started - begin), step = static_cast<double>(end - started) / steps;
  EXPECT_LT(start, 200 * step) << start / CLOCKS_PER_SEC << " s";
}

/// However long: rounding of places far from its first node does not make it hang, or start, elsewhere.
TEST(Start, LongCableStartsWhereItsShapeIs) {
  for (const double length : {40.0, 400.0})
    for (const bool is_held : {false, true}) {
      SceneDesc scene = scenes::one_cable(4000, length);
      const Vector3 from(3, 2, 1), to = from + length * Vector3(0.6, 0.8, 0);
      scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
      scene.cables[0].initial.from = from;
      scene.cables[0].initial.to = to;
      if (is_held) scene.cables[0].attachments = {scenes::attachment("end", PlaceDesc::At::end, to)};
      const World world(scene, initial_frames(scene));
      const std::vector<Vector3>& positions = world.cables()[0].state.positions;
      EXPECT_LT((positions.front() - from).norm(), 1e-9) << length << " m, held: " << is_held;
      EXPECT_LT((positions.back() - to).norm(), 1e-9) << length << " m, held: " << is_held;
    }
}

TEST(Start, WaitingCableStartsAtRest) {
  SceneDesc scene = scenes::held_by_a_hand(50, AttachmentType::clamp);
  scene.materials[0].material.bending_stiffness = 0.02;
  BoundaryInputs inputs = scenes::hand_at({0.6, 0, 0.1});
  inputs[1].known = false;
  World world(scene, inputs);
  inputs[1].known = true;
  for (int i = 0; i < 10; ++i) world.step(inputs);
  ASSERT_EQ(world.start_waiting(inputs), 1);
  for (int i = 0; i < 300; ++i) world.step(inputs);
  double speed = 0;
  for (const Vector3& v : world.cables()[0].state.velocities) speed = std::max(speed, v.norm());
  EXPECT_LT(speed, 1e-6);
}

/// Folded there it would be at rest, too, and fall open at the first touch.
TEST(Start, CableOnAHingeBetweenItsEndsIsNotFolded) {
  for (const double place : {0.5, 0.45, 0.2}) {
    for (const double stiffness : {1e-3, 1e-2, 1.0}) {
      SCOPED_TRACE(std::to_string(place) + " " + std::to_string(stiffness));
      SceneDesc scene = scenes::one_cable(50);
      scene.materials[0].material.bending_stiffness = stiffness;
      scene.cables[0].attachments = {scenes::attachment("pin", At::arc_length, {0, 0, 1})};
      scene.cables[0].attachments[0].place.arc_length = place * scene.cables[0].length;
      World world(scene, initial_frames(scene));
      EXPECT_TRUE(world.findings().unsettled.empty());
      const std::vector<Vector3> before = world.cables()[0].state.positions;
      for (std::size_t i = 2; i < before.size(); ++i)
        EXPECT_GT((before[i] - before[i - 1]).dot(before[i - 1] - before[i - 2]), 0) << i;
      for (int i = 0; i < 200; ++i) ASSERT_EQ(world.step(initial_frames(scene)).status, StepResult::Status::ok);
      for (std::size_t i = 0; i < before.size(); ++i)
        EXPECT_LT((world.cables()[0].state.positions[i] - before[i]).norm(), 1e-4) << i;
    }
  }
}

/// One that is a whole rod, though hardly another one than the cable, is found in the same equilibrium.
TEST(Start, RibbonOnAClampBetweenItsEndsStartsAsACableDoes) {
  for (const Vector3& rotation : {Vector3(0, 0, 0), Vector3(0, 1.57, 0), Vector3(0, -1.57, 0), Vector3(0.3, 0.5, 1.57)}) {
    for (const double place : {0.5, 0.8}) {
      SCOPED_TRACE(std::to_string(rotation.y()) + " " + std::to_string(place));
      SceneDesc scene = scenes::one_cable(40);
      MaterialDesc& material = scene.materials[0].material;
      material.bending_stiffness = 0.01;
      material.torsional_stiffness = 0.01;
      scene.cables[0].attachments = {clamp("pin", At::arc_length, {0, 0, 1}, rotation)};
      scene.cables[0].attachments[0].place.arc_length = place * scene.cables[0].length;
      const World cable(scene, initial_frames(scene));
      material.bending_stiffness = {0.01, 0.010001};
      World ribbon(scene, initial_frames(scene));
      EXPECT_TRUE(ribbon.findings().unsettled.empty());
      EXPECT_NEAR(ribbon.energy().total(), cable.energy().total(), 1e-3 * cable.energy().bend + 1e-6);
      EXPECT_LT(fastest(ribbon, 200), 2e-4);
      scene.cables[0].rest_twist = 3;
      World twisted(scene, initial_frames(scene));
      EXPECT_TRUE(twisted.findings().unsettled.empty());
      EXPECT_LT(fastest(twisted, 200), 2e-4);
    }
  }
}

TEST(Start, ShapeThatIsGivenIsKept) {
  Case level = cases()[0];
  SceneDesc scene = make_scene(level, 0.1, infinity);
  const double settled = World(scene, initial_frames(scene)).energy().total();
  scene.cables[0].initial.type = InitialShapeDesc::Type::catenary;
  const double catenary = World(scene, initial_frames(scene)).energy().total();
  EXPECT_GT(catenary, 5 * settled);
  // Without a clamp or without stiffness: a catenary.
  scene.cables[0].initial.type = InitialShapeDesc::Type::automatic;
  for (AttachmentDesc& attachment : scene.cables[0].attachments) attachment.type = AttachmentType::hinge;
  World hinged(scene, initial_frames(scene));
  EXPECT_GT(hinged.energy().bend, 0);
  EXPECT_EQ(hinged.cables()[0].state.tension[20], 0);
}

TEST(Start, ShapeThatDoesNotFitIsNamed) {
  SceneDesc scene = scenes::between_two_points(20, 0.5);
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  EXPECT_EQ(World(scene, initial_frames(scene)).findings().misfits, std::vector<std::string>{"cable"});
  scene = scenes::between_two_points(20, 1);
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  EXPECT_TRUE(World(scene, initial_frames(scene)).findings().misfits.empty());
}

/// Takes seconds.
SceneDesc slow_scene() {
  SceneDesc scene = scenes::one_cable(30000);
  scene.materials[0].material.bending_stiffness = 1;
  scene.cables[0].attachments = {clamp("held", At::start, {0, 0, 0})};
  return scene;
}

TEST(Starts, AWorldThatIsCancelledStartsNothing) {
  const std::atomic<bool> cancelled{true};
  const SceneDesc scene = slow_scene();
  const World world(scene, initial_frames(scene), &cancelled);
  EXPECT_TRUE(world.cables().empty());
  EXPECT_EQ(world.findings().waiting, std::vector<std::string>{"cable"});
}

TEST(Starts, SettlingEndsWhenTheWorldIsCancelled) {
  std::atomic<bool> cancelled{false};
  const SceneDesc scene = slow_scene();
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    cancelled = true;
  });
  const World world(scene, initial_frames(scene), &cancelled);
  canceller.join();
  EXPECT_TRUE(world.cables().empty() || !world.findings().unsettled.empty());
}

/// Two metres of cable whose start is held a metre above a floor.
class LongerThanTheRoom : public testing::TestWithParam<std::tuple<double, bool>> {};

TEST_P(LongerThanTheRoom, StartsLyingOnTheFloor) {
  const auto [bending, settled] = GetParam();
  SceneDesc scene = scenes::one_cable(40, 2);
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = bending;
  material.bending_damping = 0.01 * bending;
  scene.cables[0].attachments = {scenes::attachment("hand", At::start, {0, 0, 1})};
  if (settled) scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  ObstacleDesc& floor = scene.obstacles.emplace_back();
  floor.name = "floor";
  floor.type = ShapeType::plane;
  World world(scene, initial_frames(scene));
  EXPECT_TRUE(world.findings().unsettled.empty());
  for (const Vector3& place : world.cables()[0].state.positions) EXPECT_GT(place.z(), 0);
  for (int i = 0; i < 300; ++i) ASSERT_EQ(world.step(BoundaryInputs(world.frames().size())).status, StepResult::Status::ok) << i;
  for (const Vector3& velocity : world.cables()[0].state.velocities) EXPECT_LT(velocity.norm(), 0.01);
  // What lies bears no tension, and where it is not bent a cable pulls with the weight of what hangs between the heights of its
  // ends: what slides along its own shape does no work.
  const double weight = material.linear_density * -scene.gravity.acceleration.z();
  EXPECT_NEAR(-world.attachments()[0].force.z(), weight, 0.05 * weight);
}

INSTANTIATE_TEST_SUITE_P(Stiffness, LongerThanTheRoom, testing::Combine(testing::Values(0.0, 1e-3, 1e-2), testing::Bool()));

/// A metre of cable that would hang through something.
class HangsThrough : public testing::TestWithParam<std::tuple<ShapeType, double, bool>> {};

TEST_P(HangsThrough, StartsLyingOnIt) {
  const auto [shape, bending, between_ends] = GetParam();
  SceneDesc scene = between_ends ? scenes::between_two_points(40, 0.8) : scenes::one_cable(40);
  if (!between_ends) scene.cables[0].attachments = {scenes::attachment("hand", At::start, {0.4, 0, 0.3})};
  MaterialDesc& material = scene.materials[0].material;
  material.bending_stiffness = bending;
  material.bending_damping = 0.01 * bending;
  ObstacleDesc& obstacle = scene.obstacles.emplace_back();
  obstacle.name = "obstacle";
  obstacle.type = shape;
  obstacle.pose = {0.4, 0, -0.25, shape == ShapeType::plane || shape == ShapeType::box ? 0 : M_PI / 2, 0, 0};
  obstacle.radius = 0.1;
  obstacle.length = 0.5;
  obstacle.size = {0.2, 0.3, 0.1};
  World world(scene, initial_frames(scene));
  EXPECT_TRUE(world.findings().unsettled.empty());
  double fastest_late = 0;
  for (int i = 0; i < 300; ++i) {
    ASSERT_EQ(world.step(BoundaryInputs(world.frames().size())).status, StepResult::Status::ok) << i;
    for (const Vector3& velocity : world.cables()[0].state.velocities) fastest_late = std::max(fastest_late, velocity.norm());
  }
  EXPECT_LT(fastest_late, 0.01);
  EXPECT_TRUE(world.findings().intrusions.empty());
}

INSTANTIATE_TEST_SUITE_P(Shapes, HangsThrough,
                         testing::Combine(testing::Values(ShapeType::plane, ShapeType::sphere, ShapeType::cylinder,
                                                          ShapeType::capsule, ShapeType::box),
                                          testing::Values(0.0, 1e-3, 1e-2), testing::Bool()));

}  // namespace
}  // namespace verlet_cable
