#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>

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

/// Steps for 1.5 s, and looks at the tension from 0.2 s on.
void watch(World& world, const BoundaryInputs& inputs, Statistics& late) {
  const double time_step = world.time_step();
  for (int i = 1; i * time_step < 1.5; ++i) {
    ASSERT_EQ(world.step(inputs).status, Status::ok) << i;
    if (i * time_step > 0.2) late.add(tension(world));
  }
}

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
  ASSERT_NO_FATAL_FAILURE(watch(world, initial_frames(scene), late));
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
  ASSERT_NO_FATAL_FAILURE(watch(world, initial_frames(scene), late));
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
                                         RopeCase{"rigid20coarse", infinity, 20, 5e-3}, RopeCase{"rigid200", infinity, 200, 1e-3},
                                         RopeCase{"rigid200coarse", infinity, 200, 5e-3}),
                         [](const auto& info) { return info.param.name; });

/// A hand draws rope off a spool that turns freely, on a level, where nothing hangs: it feels what it sets in motion.
TEST(FreeSpool, GivesRopeToAHand) {
  for (const double axial_stiffness : {infinity, 1e4}) {
    SceneDesc scene = winch_scene(40, 2, axial_stiffness, 2e-3);
    if (axial_stiffness < infinity) scene.materials[0].material.axial_damping = 50;
    scene.gravity.acceleration.setZero();
    scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
    scene.cables[0].initial.to = {2, 0, 0};
    scene.cables[0].attachments.push_back(scenes::attachment("hand", At::end, {0, 0, 0}, "hand"));
    World world(scene, scenes::hand_at({2, 0, 0}));
    ASSERT_TRUE(world.apply(kept(0)).ok);
    const double weight = gravity * density * 2;
    for (int i = 1; i <= 1500; ++i) {
      // 0.5 m/s within a second
      const double t = 2e-3 * i, way = t < 1 ? 0.25 * t * t : 0.25 + 0.5 * (t - 1);
      ASSERT_EQ(world.step(scenes::hand_at({2 + way, 0, 0})).status, Status::ok) << i;
      ASSERT_LT(std::abs(tension(world)), 0.01 * weight) << i;
    }
    EXPECT_NEAR(length(world), 3.25, 1e-3);
    // What comes back stays off the spool.
    const double most = length(world);
    for (int i = 1; i <= 200; ++i) world.step(scenes::hand_at({3.25 - 1e-3 * i, 0, 0}));
    EXPECT_GE(length(world), most - 1e-9);
  }
}

/// Where the next node is held, too, nothing of the cable can move there: its tension is the winch's, and its length the
/// distance.
TEST(KeptTensions, BesideAHeldNode) {
  for (const double axial_stiffness : {infinity, 1e4})
    for (const double wanted : {0.0, 5.0}) {
      SceneDesc scene = winch_scene(10, 1, axial_stiffness, 2e-3);
      scene.gravity.acceleration.setZero();
      scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
      scene.cables[0].initial.to = {1, 0, 0};
      scene.cables[0].attachments.push_back(scenes::attachment("hand", At::arc_length, {0, 0, 0}, "hand"));
      scene.cables[0].attachments.back().place.arc_length = 0.1;
      World world(scene, scenes::hand_at({0.1, 0, 0}));
      ASSERT_TRUE(world.apply(kept(wanted)).ok);
      for (int i = 1; i <= 500; ++i) {
        const double way = 0.0125 * (1 - std::cos(M_PI * i / 500));
        ASSERT_EQ(world.step(scenes::hand_at({0.1 + way, 0, 0})).status, Status::ok) << i;
        ASSERT_TRUE(world.cables()[0].state.velocities[5].allFinite()) << i;
      }
      EXPECT_NEAR(tension(world), wanted, 1e-3 * std::max(wanted, 1.0)) << axial_stiffness;
      EXPECT_NEAR(world.cables()[0].state.rest_lengths.front(), 0.025 + 0.1, 1e-3) << axial_stiffness;
      EXPECT_LT(unaccounted(world, gravity * density), 1e-6);
    }
}

/// A winch that is to take in more than there is pulls with what it may, and stands.
TEST(SlippingWinch, StallsAtItsTension) {
  for (const double axial_stiffness : {infinity, 1e5}) {
    SceneDesc scene = winch_scene(40, 2, axial_stiffness, 2e-3);
    scene.cables[0].attachments.push_back(scenes::attachment("wall", At::end, {1.9, 0, 0}));
    scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
    World world(scene, initial_frames(scene));
    EXPECT_FALSE(world.apply(edit::SetLength{0, false, 1.5, 0.2}).ok && axial_stiffness == infinity);
    ASSERT_TRUE(world.apply(edit::SetLength{0, false, 1.5, 0.2, 60}).ok);
    for (int i = 1; i <= 1500; ++i) {
      ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
      ASSERT_LT(tension(world), 60 * 1.01) << i;
    }
    // Waves of what stretches go on for ever, and the motor follows them slowly.
    EXPECT_NEAR(tension(world), 60, axial_stiffness == infinity ? 0.6 : 6);
    EXPECT_NEAR(length(world), axial_stiffness == infinity ? 1.9 : 1.9 / (1 + 60 / axial_stiffness), 1e-3);
    EXPECT_LT(unaccounted(world, gravity * mass(world) * 2), 1e-4);
  }
}

/// Where what it pulls gives way it goes as one without a limit.
TEST(SlippingWinch, WindsWhatItCan) {
  SceneDesc scene = winch_scene(40, 2, infinity, 2e-3);
  scene.cables[0].point_masses = {scenes::payload(1)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World limited(scene, initial_frames(scene)), other(scene, initial_frames(scene));
  ASSERT_TRUE(limited.apply(edit::SetLength{0, false, 1, 0.5, 30}).ok);
  ASSERT_TRUE(other.apply(edit::SetLength{0, false, 1, 0.5}).ok);
  for (int i = 0; i < 1500; ++i) {
    limited.step(initial_frames(scene));
    other.step(initial_frames(scene));
    ASSERT_NEAR(length(limited), length(other), 1e-6) << i;
  }
  EXPECT_NEAR(length(limited), 1, 1e-9);
}

/// A load that is too light comes up, one that is too heavy goes down: to where the winch stops, without a jerk.
TEST(KeptTensions, EndAtTheirLengths) {
  SceneDesc scene = winch_scene(40, 2, infinity, 2e-3);
  scene.cables[0].point_masses = {scenes::payload(1)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  const double weight = gravity * 1.2;
  for (const bool up : {true, false}) {
    World world(scene, initial_frames(scene));
    edit::SetTension change{0, false, (up ? 1.05 : 0.95) * weight, 0.5, 1.6, 2.4};
    ASSERT_TRUE(world.apply(change).ok);
    for (int i = 0; i < 2000; ++i) {
      ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
      // Speeding up and braking change it by a tenth, and by twice that in single steps as segments are taken in.
      ASSERT_NEAR(tension(world), weight, 0.25 * weight) << i;
    }
    EXPECT_NEAR(length(world), up ? 1.6 : 2.4, 1e-3);
  }
}

/// It reaches its speed by `winch_acceleration`: slack rope resists nothing.
TEST(KeptTensions, SpeedUpAsTheSceneSays) {
  for (const double acceleration : {0.5, 2.0}) {
    SceneDesc scene = winch_scene(40, 2, infinity, 2e-3);
    scene.winch_acceleration = acceleration;
    scene.cables[0].attachments.push_back(scenes::attachment("wall", At::end, {0.5, 0, 0}));
    scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
    World world(scene, initial_frames(scene));
    ASSERT_TRUE(world.apply(kept(100)).ok);
    for (int i = 1; i <= 250; ++i) {
      world.step(initial_frames(scene));
      const double t = 2e-3 * i;
      ASSERT_NEAR(2 - length(world), 0.5 * acceleration * t * t, 5e-3 * acceleration * t) << i;
    }
  }
}

TEST(KeptTensions, CopiesGoOnAlikeAndLengthsReplaceThem) {
  SceneDesc scene = winch_scene(40, 2, 1e5, 2e-3);
  scene.cables[0].point_masses = {scenes::payload(1)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, initial_frames(scene));
  const std::uint64_t before = world.hash();
  ASSERT_TRUE(world.apply(kept(10)).ok);
  EXPECT_NE(world.hash(), before);
  for (int i = 0; i < 100; ++i) world.step(initial_frames(scene));
  World copy = world;
  for (int i = 0; i < 300; ++i) {
    world.step(initial_frames(scene));
    copy.step(initial_frames(scene));
  }
  EXPECT_EQ(world.hash(), copy.hash());
  // The winch at the other end is refused until this one is done.
  const EditResult other = world.apply(edit::SetTension{0, true, 1, 1, 0.2, 3});
  EXPECT_NE(other.message.find("set a length there first"), std::string::npos) << other.message;
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 1.5, 0.5}).ok);
  for (int i = 0; i < 2500; ++i) ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok);
  EXPECT_NEAR(length(world), 1.5, 1e-6);
  EXPECT_TRUE(world.apply(edit::SetLength{0, true, 1.6, 0.5}).ok);
}

TEST(KeptTensions, AreRefusedWithAllReasons) {
  SceneDesc scene = winch_scene(40, 2, infinity, 2e-3);
  World world(scene, initial_frames(scene));
  const std::uint64_t before = world.hash();
  const EditResult result = world.apply(edit::SetTension{0, false, -1, 0, -2, std::nan("")});
  EXPECT_FALSE(result.ok);
  for (const char* part : {"tension: -1", "max_speed: 0", "min_length: -2", "max_length: "})
    EXPECT_NE(result.message.find(part), std::string::npos) << result.message;
  EXPECT_FALSE(world.apply(edit::SetTension{0, false, 1, 1, 3, 2}).ok);
  EXPECT_FALSE(world.apply(edit::SetTension{1, false, 1, 1, 1, 2}).ok);
  for (const double bad : {-1.0, 1.1e9, 1e300, infinity, std::nan("")}) {
    const EditResult refused = world.apply(edit::SetLength{0, false, 1.5, 0, bad});
    for (const char* part : {"speed: 0", "max_tension: ", "allowed: 0 or more [N] (from 0 to 1e+09)"})
      EXPECT_NE(refused.message.find(part), std::string::npos) << refused.message;
    EXPECT_NE(world.apply(kept(bad)).message.find("(from 0 to 1e+09)"), std::string::npos);
  }
  EXPECT_EQ(world.hash(), before);
}

/// Let go, it winds no longer, and the cable goes on as it went.
TEST(KeptTensions, EndWhereNothingHoldsTheWinch) {
  const SceneDesc scene = winch_scene(40, 2, infinity, 2e-3);
  for (const bool keeps : {true, false}) {
    World world(scene, initial_frames(scene));
    ASSERT_TRUE(keeps ? world.apply(kept(0)).ok : world.apply(edit::SetLength{0, false, 4, 0.5, 100}).ok);
    for (int i = 0; i < 200; ++i) world.step(initial_frames(scene));
    EXPECT_TRUE(world.view_winch(0));
    const double out = length(world);
    ASSERT_TRUE(world.apply(edit::Unpin{"winch"}).ok);
    EXPECT_FALSE(world.view_winch(0));
    for (int i = 0; i < 200; ++i) ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
    EXPECT_EQ(length(world), out);
    EXPECT_LT(unaccounted(world, gravity * mass(world) * 2), 1e-6);
  }
}

TEST(KeptTensions, AreSeen) {
  SceneDesc scene = winch_scene(40, 2, infinity, 2e-3);
  scene.cables[0].point_masses = {scenes::payload(1)};
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, initial_frames(scene));
  EXPECT_FALSE(world.view_winch(0));
  ASSERT_TRUE(world.apply(kept(11)).ok);
  for (int i = 0; i < 50; ++i) world.step(initial_frames(scene));
  WinchView seen = world.view_winch(0).value();
  EXPECT_EQ(seen.kind, WinchView::Kind::tension);
  EXPECT_FALSE(seen.at_end || seen.slips);
  EXPECT_EQ(seen.goal, 11);
  EXPECT_NEAR(seen.tension, 11, 1e-3);
  EXPECT_NEAR(seen.speed, -world.cables()[0].state.velocities.back().z(), 0.01);
  EXPECT_GT(seen.speed, 0.05);
  ASSERT_TRUE(world.apply(kept(0)).ok);
  EXPECT_EQ(world.view_winch(0)->kind, WinchView::Kind::free_spool);
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 1.5, 0.5, 5}).ok);
  for (int i = 0; i < 50; ++i) world.step(initial_frames(scene));
  seen = world.view_winch(0).value();
  EXPECT_EQ(seen.kind, WinchView::Kind::length);
  EXPECT_NEAR(seen.goal, 1.5, 1e-9);
  EXPECT_EQ(seen.max_tension, 5);
  EXPECT_TRUE(seen.slips);
  EXPECT_GT(seen.speed, 0);
}

/// No more than the scene's segments come out of a winch that slips.
TEST(SlippingWinch, KeepsTheLimitOfSegments) {
  SceneDesc scene = winch_scene(40, 2, infinity, 2e-3);
  scene.cables[0].point_masses = {scenes::payload(1)};
  scene.limits.segments = 50;
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(edit::SetLength{0, false, 2, 0.5, 1}).ok);
  for (int i = 0; i < 1000; ++i) {
    world.step(initial_frames(scene));
    ASSERT_LE(world.cables()[0].state.segments(), 50) << i;
  }
  EXPECT_NEAR(length(world), 2.5, 5e-3);
}

/// A body of 2 kg on a rope that hangs from a winch.
SceneDesc hoist(double rope_length, double axial_stiffness, double acceleration) {
  SceneDesc scene = winch_scene(20, rope_length, axial_stiffness, 2e-3);
  scene.winch_acceleration = acceleration;
  scene.materials[0].material.linear_density = 0.05;
  BodyDesc& load = scene.bodies.emplace_back();
  load.name = "load";
  load.mass = 2;
  load.inertia = Vector3::Constant(0.01);
  AttachmentDesc end = scenes::attachment("hook", At::end, {0, 0, 0});
  end.body = "load";
  scene.cables[0].attachments.push_back(end);
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  return scene;
}

double velocity(const World& world) {
  return world.bodies()[0].velocity.z();
}

/// A winch that is as fast as it likes takes in what hangs on a body, and no more than its acceleration is felt.
TEST(Hoist, TensionIsThatOfTheAcceleration) {
  for (const double speed : {0.9, 1.5, 3.0}) {
    const SceneDesc scene = hoist(6, infinity, 2);
    World world(scene, initial_frames(scene));
    ASSERT_TRUE(world.apply(edit::SetLength{0, false, 0.5, speed}).ok);
    for (int i = 1; i <= 1500; ++i) {
      ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
      ASSERT_GT(tension(world), 0.99 * 2 * (gravity - 2)) << i;
      ASSERT_LT(tension(world), 1.01 * (2 + 0.3) * (gravity + 2)) << i;
    }
    EXPECT_LT(unaccounted(world, gravity * 2.3 * 6), 1e-4);
  }
}

/// Where the tension says how fast it winds, a rope that sways a little goes on so as segments are taken in. 0.64 m/s: of 22 N.
TEST(Hoist, SwayingRopesAreTakenIn) {
  for (const bool slips : {false, true})
    for (const double axial_stiffness : {infinity, 1e5}) {
      const SceneDesc scene = hoist(1, axial_stiffness, 10);
      World world(scene, initial_frames(scene));
      std::vector<Vector3> velocities = world.cables()[0].state.velocities;
      for (int i = 5; i < 15; ++i) velocities[i].x() += 1e-3;
      edit::SetState sway;
      sway.cables.push_back({0, std::nullopt, velocities});
      ASSERT_TRUE(world.apply(sway).ok);
      if (slips)
        ASSERT_TRUE(world.apply(edit::SetLength{0, false, 0.3, 3, 22}).ok);
      else
        ASSERT_TRUE(world.apply(kept(22)).ok);
      double aside = 0;
      for (int i = 1; i <= 300; ++i) {
        ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
        for (const Vector3& place : world.cables()[0].state.positions) aside = std::max(aside, std::abs(place.x()));
      }
      EXPECT_LT(aside, 1e-3) << slips << axial_stiffness;
      EXPECT_NEAR(tension(world), 22, 0.1);
      EXPECT_NEAR(velocity(world), 0.6 * (22 / 2.05 - gravity), 0.05);
    }
}

/// What a winch does is its tension times what it takes in; a spool that turns freely does nothing.
TEST(Hoist, WorkOfElasticRopesIsTensionTimesLength) {
  for (const double axial_stiffness : {1e4, 1e5, 1e6})
    for (const double wanted : {0.0, 15.0, 25.0}) {
      const SceneDesc scene = hoist(1, axial_stiffness, 1000);
      World world(scene, initial_frames(scene));
      ASSERT_TRUE(world.apply(edit::SetTension{0, false, wanted, 10, 0.2, 100}).ok);
      double work = 0;
      for (int i = 1; i <= 150; ++i) {
        const double before = length(world);
        ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
        work -= wanted * (length(world) - before);
      }
      const EnergyBalance balance = world.ledger().balance;
      // What is paid out and falls brings its own energy.
      EXPECT_NEAR(balance.work.winches, work, 0.03 * gravity * 2) << axial_stiffness << ' ' << wanted;
      EXPECT_LT(balance.dissipated.unresolved, 0.01 * gravity * 2) << axial_stiffness << ' ' << wanted;
      EXPECT_LT(unaccounted(world, gravity * 2), 1e-4) << axial_stiffness << ' ' << wanted;
    }
}

/// Where the brake of a spool that turned freely comes on, a load that fell is slowed as the winch brakes: its tension rises to
/// that, and nowhere beyond.
TEST(Hoist, TheBrakeOfAFreeSpoolComesOnWithoutAJerk) {
  for (const double acceleration : {1.0, 5.0})
    for (const double time_step : {5e-4, 2e-3}) {
      SceneDesc scene = hoist(1, infinity, acceleration);
      scene.time_step = time_step;
      World world(scene, initial_frames(scene));
      ASSERT_TRUE(world.apply(edit::SetTension{0, false, 0, 5, 0.1, 2}).ok);
      const double braking = (2 + 0.05 * 1.5) * (gravity + acceleration);
      double most = 0;
      for (int i = 1; i * time_step < 0.5; ++i) {
        ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
        most = std::max(most, tension(world));
      }
      EXPECT_NEAR(most, braking, 0.02 * braking) << acceleration << ' ' << time_step;
    }
}

/// It stands where the body is as near as it may be.
TEST(Hoist, KeptTensionBrakesAtTheLastSegment) {
  for (const double shortest : {0.0, 0.05, 0.1}) {
    const SceneDesc scene = hoist(1, infinity, 1);
    World world(scene, initial_frames(scene));
    ASSERT_TRUE(world.apply(edit::SetTension{0, false, 30, 1, shortest, 2}).ok);
    double before = 0;
    for (int i = 1; i <= 1500; ++i) {
      ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << shortest << ' ' << i;
      ASSERT_LT(std::abs(velocity(world) - before), 0.02) << shortest << ' ' << i;
      before = velocity(world);
    }
    EXPECT_NEAR(before, 0, 1e-3) << shortest;
    EXPECT_NEAR(length(world), std::max(shortest, 0.005), 1e-3);
  }
}

/// Whatever its motor is to do meanwhile, a brake lets what bends out of a clamp at the tension that it holds: at several m/s.
TEST(SlippingWinch, LetsStiffCablesThroughItsClamp) {
  for (const double acceleration : {1.0, 1000.0})
    for (const auto& [bending_stiffness, time_step] : {std::pair{0.02, 2e-3}, std::pair{0.2, 1e-3}}) {
      SceneDesc scene = hoist(3, infinity, acceleration);
      scene.time_step = time_step;
      scene.cables[0].segments = 60;
      scene.materials[0].material.bending_stiffness = bending_stiffness;
      scene.cables[0].attachments[0].type = AttachmentType::clamp;
      scene.cables[0].attachments[0].rotation = {0, M_PI / 2, 0};
      World world(scene, initial_frames(scene));
      ASSERT_TRUE(world.apply(edit::SetLength{0, false, 3, 1, 5}).ok);
      for (int i = 1; i * time_step < 0.6; ++i) {
        ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
        ASSERT_NEAR(tension(world), 5, 0.02 * 5) << i << ' ' << acceleration << ' ' << bending_stiffness;
      }
      EXPECT_NEAR(velocity(world), -0.6 * (gravity - 5 / 2.15), 0.06);
    }
}

struct HookCase {
  const char* name;
  bool bends, clamped, is_rod;
};

class WinchWithAHook : public testing::TestWithParam<HookCase> {};

/// A body hangs on it; cables bend, and clamps hold them.
TEST_P(WinchWithAHook, KeepsAndSlips) {
  const HookCase& hook = GetParam();
  SceneDesc scene = winch_scene(60, 3, infinity, 2e-3);
  if (hook.is_rod) scene.materials[0].material.torsional_stiffness = 0.02;
  if (hook.bends) scene.materials[0].material.bending_stiffness = hook.is_rod ? BendingStiffness(0.02, 0.01) : 0.02;
  scene.cables[0].attachments[0].type = hook.clamped ? AttachmentType::clamp : AttachmentType::hinge;
  scene.cables[0].attachments[0].rotation = {0, M_PI / 2, 0};
  BodyDesc load;
  load.name = "load";
  load.mass = 2;
  load.inertia = Vector3(0.01, 0.01, 0.01);
  scene.bodies = {load};
  AttachmentDesc end = scenes::attachment("hook", At::end, {0, 0, 0.05});
  end.body = "load";
  scene.cables[0].attachments.push_back(end);
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  const double weight = gravity * 2.3;
  for (const bool slips : {true, false}) {
    World world(scene, initial_frames(scene));
    const double pull = slips ? 0.7 * weight : 1.03 * weight;
    if (slips)
      ASSERT_TRUE(world.apply(edit::SetLength{0, false, 3, 0.5, pull}).ok);
    else
      ASSERT_TRUE(world.apply(kept(pull)).ok);
    for (int i = 1; i <= 300; ++i) {
      ASSERT_EQ(world.step(initial_frames(scene)).status, Status::ok) << i;
      // What bends adds a little to what leaves the winch, where that goes fast.
      if (i > 100) {
        ASSERT_NEAR(tension(world), pull, 0.03 * pull) << i;
      }
    }
    EXPECT_LT(unaccounted(world, weight * 3), 1e-4);
  }
}

INSTANTIATE_TEST_SUITE_P(Cables, WinchWithAHook,
                         testing::Values(HookCase{"rope", false, false, false}, HookCase{"clampedRope", false, true, false},
                                         HookCase{"bends", true, false, false}, HookCase{"clampedBends", true, true, false},
                                         HookCase{"rod", true, false, true}, HookCase{"clampedRod", true, true, true}),
                         [](const auto& info) { return info.param.name; });

}  // namespace
}  // namespace verlet_cable
