#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/analytic_beam.h"
#include "rods.h"
#include "validation.h"

namespace verlet_cable::validation {
namespace {

/// Clamped at the origin, 0.5 m, EI = 0.01 N m^2: bends by half its length under its own weight.
SceneDesc bending_cable(int segments, double time_step) {
  SceneDesc scene = scenes::one_cable(segments, 0.5);
  scene.time_step = time_step;
  material(scene).bending_stiffness = 0.01;
  clamp_start(scene);
  start_at(scene, [](double s) { return Vector3(0.5 * s, 0, 0); });
  return scene;
}

struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

Momenta momenta(const Simulation& run) {
  Momenta sum;
  for (int i = 0; i < run.cable().state.nodes(); ++i) {
    const Vector3 momentum = run.cable().state.masses[i] * run.cable().state.velocities[i];
    sum.linear += momentum;
    sum.angular += run.positions()[i].cross(momentum);
  }
  return sum;
}

class FreeCable : public testing::TestWithParam<double> {};

TEST_P(FreeCable, KeepsItsMomenta) {
  SceneDesc scene = scenes::one_cable(50);
  scene.gravity.acceleration.setZero();
  material(scene).axial_stiffness = GetParam();
  material(scene).bending_stiffness = 0.01;
  start_at(scene, [](double s) { return Vector3(s, 0, 0); });
  for (int i = 0; i <= 50; ++i) {
    const double s = i / 50.0;
    scene.cables[0].initial.velocities.push_back({0.3 * std::sin(5 * s), std::cos(3 * s), 0.4 * std::cos(7 * s)});
  }
  Simulation run(scene);
  const Momenta before = momenta(run);
  const double energy = run.world.energy().total();
  run.run(10);
  const Momenta after = momenta(run);
  const std::string name = GetParam() < infinity ? "free cable, elastic" : "free cable, inextensible";
  report(name + ": linear momentum", {{50, (after.linear - before.linear).norm() / before.linear.norm()}}, 1e-9, Order::none);
  report(name + ": angular momentum", {{50, (after.angular - before.angular).norm() / before.angular.norm()}}, 1e-9, Order::none);
  report(name + ": energy", {{50, std::abs(run.world.energy().total() / energy - 1)}}, 1e-5, Order::none);
}

INSTANTIATE_TEST_SUITE_P(Materials, FreeCable, testing::Values(infinity, 100.0));

/// Both ends on a level, close together; one is let go. Calkin and March, The dynamics of a falling chain, 1989: energy is kept,
/// the tip of a tight fold that has fallen by x moves with v^2 = g x (2 - x) / (1 - x), lengths and x in the chain's length.
TEST(FoldedChain, TipFallsFasterThanFreely) {
  constexpr double gravity = 9.81;
  std::vector<double> times, falls, free_falls;
  double energy_error = 0, fastest = 0;
  SceneDesc scene = scenes::between_two_points(100, 0.04);
  Simulation run(scene);
  const double height = run.positions().back().z();
  EXPECT_TRUE(run.world.apply(edit::Unpin{"right"}).ok);
  const double energy = run.world.energy().total(), weight = 0.1 * gravity;
  double fallen = 0, time_to_fall = 0;
  while (fallen < 0.95 && run.world.time() < 0.5) {
    run.step();
    const double before = fallen, time = run.world.time();
    fallen = height - run.positions().back().z();
    if (before < 0.9 && fallen >= 0.9) time_to_fall = time;
    energy_error = std::max(energy_error, std::abs(run.world.energy().total() - energy) / weight);
    fastest = std::max(fastest, -run.cable().state.velocities.back().z() / std::sqrt(2 * gravity * fallen));
    times.push_back(time);
    falls.push_back(fallen);
    free_falls.push_back(0.5 * gravity * time * time);
  }
  record_curve("folded chain", "tip", times, falls);
  record_curve("folded chain", "free fall", times, free_falls);
  // Time of the tight fold to 0.9: midpoint sum of dx / v, with x = u^2 against the root at 0.
  double exact = 0;
  constexpr int parts = 1000;
  for (int i = 0; i < parts; ++i) {
    const double u = std::sqrt(0.9) * (i + 0.5) / parts, x = u * u;
    exact += std::sqrt(0.9) / parts * 2 * u / std::sqrt(gravity * x * (2 - x) / (1 - x));
  }
  EXPECT_GT(fallen, 0.95);
  EXPECT_LT(time_to_fall, 0.95 * std::sqrt(2 * 0.9 / gravity));
  EXPECT_GT(fastest, 1.5);
  report("folded chain: energy", {{100, energy_error}}, 1e-2, Order::none);
  // The fold of the chain is 4 % of its length wide.
  report("folded chain: time to fall", {{100, std::abs(time_to_fall / exact - 1)}}, 3e-2, Order::none);
}

/// A cantilever that starts from rest straight, with the speeds of its first mode: large deflections, no high modes to speak of.
TEST(StepSize, ErrorIsOfSecondOrder) {
  constexpr double duration = 0.64;
  const auto end_state = [](double time_step) {
    SceneDesc scene = bending_cable(20, time_step);
    scene.gravity.acceleration.setZero();
    const double root = analytic::cantilever_roots[0];
    for (int i = 0; i <= 20; ++i)
      scene.cables[0].initial.velocities.push_back({0, 0, 0.5 * analytic::cantilever_mode(root, i / 20.0)});
    Simulation run(scene);
    run.run(duration);
    return run.positions();
  };
  const std::vector<Vector3> exact = end_state(0.000125);
  std::vector<Sample> samples;
  for (const double step : {0.008, 0.004, 0.002, 0.001}) {
    const std::vector<Vector3> end = end_state(step);
    double largest = 0;
    for (std::size_t i = 0; i < end.size(); ++i) largest = std::max(largest, (end[i] - exact[i]).norm() / 0.5);
    samples.push_back({duration / step, largest});
  }
  report("step size halved", samples, 1e-3, Order::second);
}

/// The same material in more and more segments: what is measured goes to a limit, extrapolated from the two finest.
TEST(Segments, BehaviourDoesNotDependOnTheirNumber) {
  const std::vector<int> counts{25, 50, 100, 200};
  std::vector<double> deflections, periods;
  for (const int n : counts) {
    Simulation run(bending_cable(n, 0.0005));
    EXPECT_TRUE(run.world.settle());
    const double rest = run.positions().back().z();
    deflections.push_back(rest);
    // Swings about the shape at rest after a small push.
    SceneDesc pushed = bending_cable(n, 0.0005);
    pushed.cables[0].initial.points = run.positions();
    pushed.cables[0].initial.velocities.clear();
    for (int i = 0; i <= n; ++i) pushed.cables[0].initial.velocities.push_back({0, 0.01 * i * i / n / n, 0});
    Simulation swing(pushed);
    const auto sideways = [](const Simulation& s) {
      double sum = 0;
      for (int i = 0; i < s.cable().state.nodes(); ++i)
        sum += s.cable().state.masses[i] * s.positions()[i].y() * i * i / (s.cable().state.nodes() * s.cable().state.nodes());
      return sum;
    };
    swing.step();
    periods.push_back(1 / angular_frequency(swing, sideways, 6));
  }
  for (const auto& [name, values] : {std::pair{"deflection", deflections}, std::pair{"period", periods}}) {
    const double limit = (4 * values[3] - values[2]) / 3;
    std::vector<Sample> samples;
    for (int k = 0; k < 3; ++k) samples.push_back({static_cast<double>(counts[k]), std::abs(values[k] / limit - 1)});
    report(std::string("number of segments: ") + name, samples, 1e-3, Order::second);
  }
}

}  // namespace
}  // namespace verlet_cable::validation
