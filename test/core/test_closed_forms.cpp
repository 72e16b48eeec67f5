#include <gtest/gtest.h>

#include <cmath>

#include "../support/scenes.h"

namespace verlet_cable {
namespace {

constexpr double g = 9.81;

struct Simulation {
  World world;
  BoundaryInputs inputs;

  explicit Simulation(const SceneDesc& scene) : world(scene, initial_frames(scene)), inputs(initial_frames(scene)) {}
  StepResult step() { return world.step(inputs); }
  const SimulatedCable& cable() const { return world.cables()[0]; }
};

/// Time between the first and the `count`th upward crossing of x = 0 by the last node, over the number of periods.
double period(Simulation& run, int count) {
  double first = 0, before = run.cable().state.positions.back().x();
  int crossings = 0;
  while (run.world.time() < 60) {
    run.step();
    const double now = run.cable().state.positions.back().x();
    if (before < 0 && now >= 0) {
      const double time = run.world.time() - run.world.time_step() * now / (now - before);
      if (crossings == 0) first = time;
      if (crossings++ == count) return (time - first) / count;
    }
    before = now;
  }
  return 0;
}

TEST(ClosedForms, FreeFall) {
  SceneDesc scene = scenes::one_cable(20);
  Simulation run(scene);
  const Vector3 start = run.cable().state.positions[7];
  for (int i = 0; i < 1000; ++i) run.step();
  // The scheme is exact for constant acceleration: what is left is rounding over 1000 steps.
  EXPECT_NEAR(run.cable().state.positions[7].z() - start.z(), -0.5 * g, 1e-10);
  EXPECT_NEAR(run.cable().state.velocities[7].z(), -g, 1e-10);
  EXPECT_NEAR(run.cable().state.positions[7].x(), start.x(), 1e-10);
}

TEST(ClosedForms, LinearDragGivesTerminalVelocity) {
  SceneDesc scene = scenes::one_cable(20);
  scene.materials[0].material.drag = 1.0;
  Simulation run(scene);
  for (int i = 0; i < 2000; ++i) run.step();
  // Time constant 0.1 s: after 2 s it is reached to e^-20.
  EXPECT_NEAR(run.cable().state.velocities[10].z(), -0.1 * g / 1.0, 1e-7);
}

TEST(ClosedForms, PendulumOfSmallAmplitude) {
  Simulation run(scenes::released(1, 0.01));
  // 2 pi sqrt(L/g) (1 + angle^2/16); the step's second-order error is (w h)^2 / 24 = 4e-7.
  EXPECT_NEAR(period(run, 5), 2 * M_PI * std::sqrt(1 / g) * (1 + 0.01 * 0.01 / 16), 2e-6);
}

TEST(ClosedForms, PendulumFromTheHorizontal) {
  Simulation run(scenes::released(1, M_PI / 2));
  // 4 sqrt(L/g) K(1/2), K = 1.8540746773
  const double exact = 4 * std::sqrt(1 / g) * 1.8540746773;
  EXPECT_NEAR(period(run, 5) / exact, 1, 1e-5);
}

TEST(ClosedForms, PayloadIsPartOfThePendulum) {
  SceneDesc scene = scenes::released(2, 0.01);
  scene.cables[0].point_masses = {scenes::payload(1000)};
  Simulation run(scene);
  // The cable's own 0.1 kg shorten the period by less than 1e-4 of it.
  EXPECT_NEAR(period(run, 3) / (2 * M_PI * std::sqrt(1 / g)), 1, 1e-4);
}

TEST(ClosedForms, CatenaryBetweenTwoPoints) {
  SceneDesc scene = scenes::between_two_points(100, 0.6);
  scene.materials[0].material.drag = 1;
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{0, 0, 0}, {0.3, 0, -0.4}, {0.6, 0, 0}};
  Simulation run(scene);
  for (int i = 0; i < 20000; ++i) run.step();
  // 2 a sinh(span / 2a) = length; sag = a (cosh(span / 2a) - 1); horizontal force = weight per length times a
  double a = 0.1;
  for (int i = 0; i < 100; ++i) a += (2 * a * std::sinh(0.3 / a) - 1) / (2 * (0.3 / a * std::cosh(0.3 / a) - std::sinh(0.3 / a)));
  const double sag = a * (std::cosh(0.3 / a) - 1);
  const double sag_error = -run.cable().state.positions[50].z() / sag - 1;
  const double force_error = run.world.attachments()[0].force.x() / (0.1 * g * a) - 1;
  RecordProperty("sag_error", std::to_string(sag_error));
  RecordProperty("force_error", std::to_string(force_error));
  // 100 chords differ from the curve at second order, about 1 / 100^2.
  EXPECT_NEAR(sag_error, 0, 2e-4);
  EXPECT_NEAR(force_error, 0, 2e-3);
  EXPECT_NEAR(run.world.attachments()[0].force.z(), -0.5 * 0.1 * g, 1e-4);
}

TEST(ClosedForms, DefaultShapeHangsAtRest) {
  Simulation run(scenes::between_two_points(100, 0.6));
  const Vector3 lowest = run.cable().state.positions[50];
  for (int i = 0; i < 1000; ++i) run.step();
  EXPECT_LT((run.cable().state.positions[50] - lowest).norm(), 1e-6);
}

TEST(ClosedForms, HangingCableCarriesItsWeight) {
  SceneDesc scene = scenes::released(100, 0);
  scene.cables[0].point_masses = {scenes::payload(0.5)};
  Simulation run(scene);
  for (int i = 0; i < 10; ++i) run.step();
  EXPECT_NEAR(run.world.attachments()[0].force.z(), -0.6 * g, 1e-7);
  EXPECT_NEAR(run.cable().state.tension.front(), (0.5 + 0.1 * (1 - 0.5 / 100)) * g, 1e-7);
  EXPECT_NEAR(run.cable().state.tension.back(), (0.5 + 0.1 * 0.5 / 100) * g, 1e-7);
}

TEST(ClosedForms, FreeCableKeepsItsMomentaAndEnergy) {
  SceneDesc scene = scenes::one_cable(50);
  scene.gravity.acceleration.setZero();
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  for (int i = 0; i <= 10; ++i) {
    scene.cables[0].initial.points.push_back({0.1 * i, 0, 0});
    scene.cables[0].initial.velocities.push_back({0.3 * std::sin(i), 0.1 * i, 0.2 * std::cos(0.7 * i)});
  }
  Simulation run(scene);
  const auto momenta = [&](Vector3& linear, Vector3& angular) {
    linear.setZero();
    angular.setZero();
    for (int i = 0; i < run.cable().state.nodes(); ++i) {
      const Vector3 p = run.cable().state.masses[i] * run.cable().state.velocities[i];
      linear += p;
      angular += run.cable().state.positions[i].cross(p);
    }
  };
  Vector3 linear0, angular0, linear, angular;
  momenta(linear0, angular0);
  const double energy0 = run.world.energy().total();
  for (int i = 0; i < 10000; ++i) run.step();
  momenta(linear, angular);
  // The scheme conserves all three exactly; what is left is rounding and Newton's tolerance.
  EXPECT_LT((linear - linear0).norm() / linear0.norm(), 1e-11);
  EXPECT_LT((angular - angular0).norm() / angular0.norm(), 1e-11);
  EXPECT_NEAR(run.world.energy().total() / energy0, 1, 1e-8);
}

TEST(ClosedForms, GentleSwingKeepsEnergyAndLength) {
  Simulation run(scenes::released(100, 20 * M_PI / 180));
  const double energy0 = run.world.energy().total();
  double energy_error = 0, strain = 0;
  for (int i = 0; i < 10000; ++i) {
    strain = std::max(strain, run.step().max_strain);
    energy_error = std::max(energy_error, std::abs(run.world.energy().total() - energy0));
  }
  EXPECT_LT(energy_error / (0.1 * g), 1e-5);
  EXPECT_LT(strain, 1e-5);
}

class Whip : public testing::TestWithParam<int> {};

TEST_P(Whip, StaysFiniteAndKeepsEnergyAndLength) {
  Simulation run(scenes::released(GetParam(), M_PI / 2));
  const double energy0 = run.world.energy().total();
  double energy_error = 0, strain = 0;
  while (run.world.time() < 3) {
    const StepResult result = run.step();
    ASSERT_EQ(result.status, StepResult::Status::ok);
    strain = std::max(strain, result.max_strain);
    energy_error = std::max(energy_error, std::abs(run.world.energy().total() - energy0));
  }
  EXPECT_LT(energy_error / (0.1 * g), 1e-5);
  EXPECT_LT(strain, 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Sizes, Whip, testing::Values(20, 50, 100, 200));

}  // namespace
}  // namespace verlet_cable
