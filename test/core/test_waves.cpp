#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "../support/nets.h"
#include "../support/scenes.h"
#include "fluid/waves.h"

// Linear waves, and cables in them.

namespace verlet_cable {
namespace {

constexpr double gravity = 9.81, surface = 0.5, density = 1000;

SceneDesc in_waves(const std::vector<WaveDesc>& waves, double depth) {
  SceneDesc scene;
  scene.fluid.density = density;
  scene.fluid.surface = surface;
  scene.fluid.depth = depth;
  scene.fluid.waves = waves;
  return scene;
}

TEST(Waves, ObeyTheDispersionRelation) {
  for (const double depth : {0.01, 0.5, 3.0, 20.0, 500.0, 1e6})
    for (const double period : {0.5, 3.0, 8.0, 25.0, 600.0}) {
      const double frequency = 2 * M_PI / period, k = wave_number(frequency, gravity, depth);
      EXPECT_NEAR(gravity * k * std::tanh(k * depth) / (frequency * frequency), 1, 1e-14) << depth << " m, " << period << " s";
    }
  EXPECT_DOUBLE_EQ(wave_number(2, gravity, infinity), 4 / gravity);
}

/// Dean and Dalrymple (1991), table 3.1.
TEST(Waves, MoveTheWaterAsLinearTheorySays) {
  constexpr double amplitude = 0.7, period = 6, direction = 0.4, phase = 1.1, depth = 12, time = 3.7;
  const SceneDesc scene = in_waves({{amplitude, period, direction, phase}}, depth);
  const std::vector<Wave> waves = waves_of(scene);
  const Vector3 point(3, -2, surface - 5);
  const double w = 2 * M_PI / period, k = waves[0].number, z = point.z() - surface;
  const double angle = k * (std::cos(direction) * point.x() + std::sin(direction) * point.y()) - w * time + phase;
  const double along = amplitude * w * std::cosh(k * (z + depth)) / std::sinh(k * depth) * std::cos(angle);
  const double upright = amplitude * w * std::sinh(k * (z + depth)) / std::sinh(k * depth) * std::sin(angle);
  const WaterMotion water = water_at(scene.fluid, waves, point, time);
  EXPECT_NEAR(water.surface, surface + amplitude * std::cos(angle), 1e-14);
  EXPECT_LT((water.velocity - Vector3(std::cos(direction) * along, std::sin(direction) * along, upright)).norm(), 1e-14);
}

TEST(Waves, DieOutWithDepth) {
  const SceneDesc scene = in_waves({{0.5, 7, 0, 0}}, infinity);
  const std::vector<Wave> waves = waves_of(scene);
  const double at_surface = water_at(scene.fluid, waves, {0, 0, surface}, 0.3).velocity.norm();
  EXPECT_NEAR(at_surface, 0.5 * 2 * M_PI / 7, 1e-14);
  for (const double depth : {1.0, 10.0, 1e5})
    EXPECT_NEAR(water_at(scene.fluid, waves, {0, 0, surface - depth}, 0.3).velocity.norm() / at_surface,
                std::exp(-waves[0].number * depth), 1e-14);
}

/// In any depth: no water is made, none turns, accelerations are those of water that moves on, the surface moves with its water,
/// and none goes through the bottom.
TEST(Waves, AreFlowsOfWater) {
  constexpr double h = 1e-4, time = 2.3;
  for (const double depth : {2.0, 9.0, infinity}) {
    SceneDesc scene = in_waves({{0.3, 5, 0.3, 0}, {0.2, 3.1, 2.2, 1.7}}, depth);
    scene.fluid.velocity = {0.4, 0.1, 0};
    const std::vector<Wave> waves = waves_of(scene);
    const auto water = [&](const Vector3& point, double t) { return water_at(scene.fluid, waves, point, t); };
    const Vector3 point(1.3, 0.4, surface - 0.9);
    Eigen::Matrix3d slope;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 way = h * Vector3::Unit(axis);
      slope.col(axis) = (water(point + way, time).velocity - water(point - way, time).velocity) / (2 * h);
    }
    EXPECT_GT(slope.norm(), 0.05);
    EXPECT_NEAR(slope.trace(), 0, 1e-8);
    EXPECT_LT((slope - slope.transpose()).norm(), 1e-8);
    const Vector3 change = (water(point, time + h).velocity - water(point, time - h).velocity) / (2 * h);
    const WaterMotion here = water(point, time);
    EXPECT_LT((change + slope * here.velocity - here.acceleration).norm(), 1e-8);
    const Vector3 on_top(point.x(), point.y(), surface);
    EXPECT_NEAR((water(on_top, time + h).surface - water(on_top, time - h).surface) / (2 * h), water(on_top, time).velocity.z(),
                1e-8);
    EXPECT_EQ(water(on_top, time).velocity, water(on_top + Vector3(0, 0, 0.2), time).velocity);
    const double bottom = std::min(depth, 1e3);
    EXPECT_NEAR(water(on_top - Vector3(0, 0, bottom), time).velocity.z(), 0, 1e-15);
  }
}

/// A short piece of cable, along a crest, that weighs nothing in water: what its acceleration does to it alone.
TEST(CableInWaves, IsCarriedByTheAccelerationOfWhatItDisplaces) {
  SceneDesc scene = scenes::one_cable(1, 0.1);
  MaterialDesc& material = scene.materials[0].material;
  const SceneDesc water = in_waves({{0.4, 4, 0, 0.8}}, 15);
  scene.fluid = water.fluid;
  scene.fluid.normal_drag = scene.fluid.tangential_drag = 0;
  scene.time_step = 1e-3;
  material.linear_density = density * M_PI * material.radius * material.radius;
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{0, 0, -2}, {0, 0.1, -2}};
  const std::vector<Wave> waves = waves_of(scene);
  Vector3 x = scene.cables[0].initial.points[0], v = Vector3::Zero();
  const auto pull = [&](const Vector3& place, double t) { return water_at(scene.fluid, waves, place, t).acceleration; };
  World world(scene, initial_frames(scene));
  constexpr int steps = 8000;
  for (int i = 0; i < steps; ++i) {
    // The classical Runge-Kutta method, of x'' = a(x, t).
    const double h = scene.time_step, t = i * h;
    const Vector3 a = pull(x, t), b = pull(x + h / 2 * v, t + h / 2), c = pull(x + h / 2 * v + h * h / 4 * a, t + h / 2),
                  d = pull(x + h * v + h * h / 2 * b, t + h);
    x += h * v + h * h / 6 * (a + b + c);
    v += h / 6 * (a + 2 * b + 2 * c + d);
    world.step(initial_frames(scene));
  }
  EXPECT_GT((x - scene.cables[0].initial.points[0]).norm(), 0.3);
  EXPECT_LT((world.cables()[0].state.positions[0] - x).norm(), 1e-6);
  EXPECT_LT((world.cables()[0].state.velocities[0] - v).norm(), 1e-6);
}

SceneDesc hanging_in_waves() {
  SceneDesc scene = scenes::released(20, 0.3, 2);
  scene.fluid = in_waves({{0.3, 2.5, 0.2, 0}, {0.1, 1.4, -1, 2}}, 4).fluid;
  scene.fluid.velocity = {0.2, 0, 0};
  scene.fluid.surface = -0.5;
  scene.materials[0].material.linear_density = 0.2;
  scene.materials[0].material.drag = 0.1;
  scene.time_step = 0.004;
  return scene;
}

/// The top is in the air, the surface goes up and down along the cable.
TEST(CableInWaves, ClosesTheLedger) {
  for (const bool damping : {false, true}) {
    SceneDesc scene = hanging_in_waves();
    scene.numerical_damping = damping;
    scene.tolerance = 1e-6;
    World world(scene, initial_frames(scene));
    scenes::run(world, 1000);
    const Ledger ledger = world.ledger();
    EXPECT_GT(std::abs(ledger.balance.work.applied), 0.1);
    EXPECT_GT(ledger.balance.dissipated.drag, 0.1);
    EXPECT_LT(std::abs(ledger.unaccounted()), 1e-6);
    EXPECT_EQ(ledger.unaccounted_steps, 0);
  }
}

TEST(CableInWaves, IsOfSecondOrderInTheStep) {
  const auto end = [](int refinement) {
    SceneDesc scene = hanging_in_waves();
    scene.fluid.surface = 3;  // forces of what gets into the water are not smooth
    scene.numerical_damping = false;
    scene.tolerance = 1e-6;
    scene.time_step /= refinement;
    World world(scene, initial_frames(scene));
    scenes::run(world, 250 * refinement);
    return world.cables()[0].state.positions.back();
  };
  const Vector3 coarse = end(1), middle = end(2), fine = end(4);
  EXPECT_GT((coarse - middle).norm(), 1e-7);
  EXPECT_NEAR((coarse - middle).norm() / (middle - fine).norm(), 4, 0.4);
}

TEST(CableInWaves, SettlesInStillWater) {
  SceneDesc scene = hanging_in_waves();
  World in_waves(scene, initial_frames(scene));
  scene.fluid.waves.clear();
  World still(scene, initial_frames(scene));
  ASSERT_TRUE(in_waves.settle());
  ASSERT_TRUE(still.settle());
  EXPECT_EQ(in_waves.cables()[0].state.positions, still.cables()[0].state.positions);
}

/// On its own, among others, in any lanes and on any threads, copied on the way.
TEST(CableInWaves, IsTheSameOnAnyPath) {
  SceneDesc scene = hanging_in_waves();
  const SceneDesc one = scene;
  for (int i = 1; i < 60; ++i) {
    CableDesc& other = scene.cables.emplace_back(one.cables[0]);
    other.name = "cable_" + std::to_string(i);
    other.attachments[0].name = "top_" + std::to_string(i);
    other.attachments[0].offset.x() = other.initial.from.x() = 0.1 * i;
  }
  World all(scene, initial_frames(scene)), one_by_one = all, narrow = all, alone(one, initial_frames(one));
  one_by_one.step_one_by_one(true);
  narrow.limit_lanes(2);
  for (int i = 0; i < 100; ++i) {
    for (World* world : {&all, &one_by_one, &narrow, &alone}) scenes::run(*world, 1);
    if (i == 50) narrow = all;
  }
  EXPECT_EQ(all.hash(), one_by_one.hash());
  EXPECT_EQ(all.hash(), narrow.hash());
  EXPECT_EQ(all.cables()[0].state.positions, alone.cables()[0].state.positions);
}

TEST(CableInWaves, FeelsThemAsTuned) {
  SceneDesc scene = hanging_in_waves();
  World world(scene, initial_frames(scene));
  scene.fluid.waves[0].amplitude = 0.6;
  scene.gravity.acceleration.z() = -5;
  World tuned = world;
  tuned.tune(scene);
  World anew(scene, initial_frames(scene));
  EXPECT_NE(world.hash(), tuned.hash());
  scenes::run(tuned, 10);
  scenes::run(anew, 10);
  EXPECT_EQ(tuned.cables()[0].state.positions, anew.cables()[0].state.positions);
}

}  // namespace
}  // namespace verlet_cable
