#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "../support/scenes.h"
#include "law/winch.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;
using At = PlaceDesc::At;
constexpr double gravity = 9.81, density = 0.1;

/// Of what leaves a winch at the start.
double tension(const World& world) {
  return world.cables()[0].state.tension.front();
}
double length(const World& world) {
  return world.cables()[0].state.length();
}
double mass(const World& world) {
  const std::vector<double>& masses = world.cables()[0].state.masses;
  return std::accumulate(masses.begin(), masses.end(), 0.0);
}

struct Statistics {
  double least = infinity, most = -infinity, sum = 0, squares = 0;
  int count = 0;
  void add(double value) {
    least = std::min(least, value);
    most = std::max(most, value);
    sum += value;
    squares += value * value;
    ++count;
  }
  double mean() const { return sum / count; }
  double deviation() const { return std::sqrt(std::max(0.0, squares / count - mean() * mean())); }
};

/// Joules that the ledger misses, over what lifts the cable by its length.
double unaccounted(const World& world, double weight_times_length) {
  const Ledger ledger = world.ledger();
  return std::abs(ledger.change - ledger.balance.net()) / weight_times_length;
}

edit::SetTension kept(double tension) {
  return {0, false, tension, 2, 0.2, 100};
}

/// A winch at the origin, to which a cable runs.
SceneDesc winch_scene(int segments, double rope_length, double axial_stiffness, double time_step) {
  SceneDesc scene = scenes::one_cable(segments, rope_length);
  scene.materials[0].material.axial_stiffness = axial_stiffness;
  scene.time_step = time_step;
  scene.cables[0].attachments = {scenes::attachment("winch", At::start, {0, 0, 0})};
  return scene;
}

struct RopeCase {
  const char* name;
  double axial_stiffness;
  int segments;
  double time_step;
};

class KeptTension : public testing::TestWithParam<RopeCase> {};

/// A rope of 4 m to a wall, which weighs 4 N.
TEST_P(KeptTension, IsReachedOnARopeToAWall) {
  const RopeCase& rope = GetParam();
  SceneDesc scene = winch_scene(rope.segments, 4, rope.axial_stiffness, rope.time_step);
  // 80 N strain it by that; what it sags by w² l³ / (24 T²) is 4e-4 m.
  const double span = 4 * (1 + 80 / rope.axial_stiffness) - 4e-4;
  scene.cables[0].attachments.push_back(scenes::attachment("wall", At::end, {span, 0, 0}));
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, initial_frames(scene));
  const EditResult started = world.apply(kept(100));
  ASSERT_TRUE(started.ok) << started.message;
  Statistics late;
  for (int i = 1; i * rope.time_step < 1.5; ++i) {
    ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
    if (i * rope.time_step > 0.2) late.add(tension(world));
  }
  EXPECT_NEAR(late.least, 100, 1);
  EXPECT_NEAR(late.most, 100, 1);
  EXPECT_LT(late.deviation(), 0.1);
  EXPECT_LT(unaccounted(world, gravity * mass(world) * 4), 1e-4);
}

/// A load of 10 kg that a tension of 1.05 times its weight lifts: half as fast as a winch may.
TEST_P(KeptTension, LiftsALoad) {
  const RopeCase& rope = GetParam();
  SceneDesc scene = winch_scene(rope.segments, 4, rope.axial_stiffness, rope.time_step);
  scene.cables[0].point_masses = {scenes::payload(10)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, initial_frames(scene));
  const double pull = 1.05 * gravity * 10;
  ASSERT_TRUE(world.apply(kept(pull)).ok);
  Statistics late;
  for (int i = 1; i * rope.time_step < 1.5; ++i) {
    ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
    if (i * rope.time_step > 0.2) late.add(tension(world));
  }
  EXPECT_NEAR(late.least, pull, 0.01 * pull);
  EXPECT_NEAR(late.most, pull, 0.01 * pull);
  EXPECT_LT(late.deviation(), 0.01 * pull);
  EXPECT_LT(unaccounted(world, gravity * mass(world) * 4), 1e-4);
}

/// The wall heaves by 1 m in 8 s: 0.62 m/s^2.
TEST_P(KeptTension, IsHeldInASwell) {
  const RopeCase& rope = GetParam();
  SceneDesc scene = winch_scene(rope.segments, 8, rope.axial_stiffness, rope.time_step);
  const double start = 8 * (1 + 90 / rope.axial_stiffness) - 3e-3;
  scene.cables[0].attachments.push_back(scenes::attachment("buoy", At::end, {0, 0, 0}, "swell"));
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, scenes::hand_at({start, 0, 0}));
  ASSERT_TRUE(world.apply(kept(100)).ok);
  Statistics late;
  for (int i = 1; i * rope.time_step < 10; ++i) {
    const double phase = 2 * M_PI / 8 * std::max(0.0, i * rope.time_step - 0.4);
    ASSERT_EQ(world.step(scenes::hand_at({start + 0.5 * (1 - std::cos(phase)) * 2, 0, 0})).status, Status::ok) << i;
    if (i * rope.time_step > 0.4) late.add(tension(world));
  }
  EXPECT_NEAR(late.least, 100, 2);
  EXPECT_NEAR(late.most, 100, 2);
  EXPECT_LT(late.deviation(), 1);
  EXPECT_LT(unaccounted(world, gravity * mass(world) * 8), 1e-4);
}

/// A load of twice what the brake holds slides down as if the rope pulled with that.
TEST_P(KeptTension, ABrakeSlips) {
  const RopeCase& rope = GetParam();
  SceneDesc scene = winch_scene(rope.segments, 2, rope.axial_stiffness, rope.time_step);
  scene.cables[0].point_masses = {scenes::payload(10)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, initial_frames(scene));
  const double holds = 0.5 * gravity * 10;
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 2, 0.5, holds}).ok);
  Statistics late;
  double before = 0, after = 0;
  for (int i = 1; i * rope.time_step <= 0.8 + 1e-9; ++i) {
    ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
    if (i * rope.time_step > 0.2) late.add(tension(world));
    const double speed = -world.cables()[0].state.velocities.back().z();
    if (std::abs(i * rope.time_step - 0.4) < 1e-9) before = speed;
    after = speed;
  }
  EXPECT_LT(late.most, 1.01 * holds);
  EXPECT_GT(late.least, 0.99 * holds);
  // The rope's own weight pulls, too: 2 to 5 N of it.
  EXPECT_NEAR((after - before) / 0.4, gravity - holds / 10, 0.03 * gravity);
  EXPECT_LT(unaccounted(world, gravity * mass(world) * 2), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Ropes, KeptTension,
                         testing::Values(RopeCase{"soft20", 1e4, 20, 1e-3}, RopeCase{"soft200", 1e4, 200, 5e-3},
                                         RopeCase{"middle", 1e5, 50, 2e-3}, RopeCase{"wire20", 1e6, 20, 5e-3},
                                         RopeCase{"wire200", 1e6, 200, 1e-3}, RopeCase{"rigid20", infinity, 20, 1e-3},
                                         RopeCase{"rigid20coarse", infinity, 20, 5e-3},
                                         RopeCase{"rigid200", infinity, 200, 1e-3},
                                         RopeCase{"rigid200coarse", infinity, 200, 5e-3}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace verlet_cable
