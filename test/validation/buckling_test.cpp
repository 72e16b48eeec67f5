#include <gtest/gtest.h>

#include <cmath>

#include "../support/analytic_rod.h"
#include "rods.h"
#include "validation.h"

namespace verlet_cable::validation {
namespace {

struct EulerCase {
  std::string name;
  AttachmentType ends;
  double load;  ///< P L^2 / EI
  std::function<double(double)> shape;
};

class Euler : public testing::TestWithParam<EulerCase> {};

/// Stiffness of the lowest bending mode of a rod under a load on its ends.
double stiffness_under_load(const EulerCase& euler, int n, double load) {
  constexpr double axial_stiffness = 1e6;  // the load shortens the rod by 1e-5 or 4e-5 of its length
  const double length = 1 - load / axial_stiffness;
  SceneDesc scene = rod(n, 1e-3);
  material(scene).axial_stiffness = axial_stiffness;
  damp(scene, 2 * euler.load);
  hold_ends(scene, euler.ends, length);
  // So little bow adds 1e-5 of the load.
  start_at(scene, [&](double s) { return Vector3(length * s, 0, 3e-6 * euler.shape(s)); });
  Simulation run(scene);
  return stiffness_from_growth(run, projection(2, euler.shape), 10 / euler.load, 20 / euler.load);
}

TEST_P(Euler, BucklesAtTheCriticalLoad) {
  const EulerCase& euler = GetParam();
  const auto samples = sample({20, 40, 80}, [&](int n) {
    std::vector<double> loads, stiffnesses;
    const auto stiffness = [&](double load) {
      loads.push_back(load / euler.load);
      stiffnesses.push_back(stiffness_under_load(euler, n, load));
      return stiffnesses.back();
    };
    const double critical = critical_load(stiffness, euler.load);
    record_curve(euler.name, "n = " + std::to_string(n), loads, stiffnesses);
    return critical / euler.load - 1;
  });
  report(euler.name, samples, 5e-3, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Ends, Euler,
                         testing::Values(EulerCase{"Euler hinged", AttachmentType::hinge, M_PI* M_PI,
                                                   [](double s) { return std::sin(M_PI * s); }},
                                         EulerCase{"Euler clamped", AttachmentType::clamp, 4 * M_PI* M_PI,
                                                   [](double s) { return 0.5 * (1 - std::cos(2 * M_PI * s)); }}));

/// Stiffness of the helical mode `shape` of a rod under tension whose end clamp is turned until it carries `torque`. A
/// difference between its bending stiffnesses that is nothing has it follow its material axes.
double stiffness_under_torque(int n, double difference, double tension, double torque, const analytic::TwistedRod& shape,
                              double drag, double time) {
  constexpr double torsional_stiffness = 5;
  const double axial_stiffness = tension > 0 ? 1e5 * tension : 1, length = 1 + tension / axial_stiffness;
  SceneDesc scene = rod(n, time / 2000);
  material(scene).axial_stiffness = axial_stiffness;
  material(scene).bending_stiffness = {1, 1 + difference};
  material(scene).torsional_stiffness = torsional_stiffness;
  // So little that it takes a time of no account; without it waves of twist go to and fro after the end was turned.
  material(scene).torsional_damping = 1e-3;
  damp(scene, drag);
  hold_ends(scene, AttachmentType::clamp, length);
  const auto helix = [&](double s) {
    const std::complex<double> w = shape.shape(s - 0.5) / std::abs(shape.shape(0));
    return Vector3(0, w.real(), w.imag());
  };
  start_at(scene, [&](double s) -> Vector3 { return length * s * Vector3::UnitX() + 1e-6 * helix(s); });
  Simulation run(scene);
  constexpr int turning_steps = 20;  // so fast that the rod keeps its shape
  for (int i = 1; i <= turning_steps; ++i) {
    const double angle = torque / torsional_stiffness * i / turning_steps;
    run.inputs[1].pose.orientation = Eigen::AngleAxisd(angle, Vector3::UnitX());
    run.step();
  }
  const auto y = projection(1, [&](double s) { return helix(s).y(); }), z = projection(2, [&](double s) { return helix(s).z(); });
  return stiffness_from_growth(
      run, [&](const Simulation& r) { return y(r) + z(r); }, 0.5 * time, time);
}

/// Torque at which the rod buckles: where that stiffness vanishes.
double critical_torque(const std::string& name, int n, double difference, double tension, double expected,
                       const analytic::TwistedRod& shape, double drag, double time) {
  std::vector<double> torques, stiffnesses;
  const auto stiffness = [&](double torque) {
    torques.push_back(torque / expected);
    stiffnesses.push_back(stiffness_under_torque(n, difference, tension, torque, shape, drag, time));
    return stiffnesses.back();
  };
  const double critical = critical_load(stiffness, expected);
  record_curve(name, "n = " + std::to_string(n), torques, stiffnesses);
  return critical;
}

class TwistedRod : public testing::TestWithParam<double> {};

TEST_P(TwistedRod, BucklesWithoutTension) {
  const std::string name = GetParam() == 0 ? "twisted rod" : "twisted rod, material axes";
  const analytic::TwistedRod shape = analytic::twisted_rod(1e-3);
  const double expected = analytic::untensioned_buckling_torque;
  const auto samples = sample(
      {20, 40, 80}, [&](int n) { return critical_torque(name, n, GetParam(), 0, expected, shape, 30, 1.2) / expected - 1; });
  report(name, samples, 5e-3, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Kernels, TwistedRod, testing::Values(0, 1e-12));

TEST(TautTwistedRod, BucklesUnderTension) {
  constexpr double tension = 400;  // three turns of the helix fit on the rod
  const analytic::TwistedRod rod = analytic::twisted_rod(tension);
  const double long_rod = 2 * std::sqrt(tension);
  std::vector<Sample> against_long_rod;
  const auto samples = sample({80, 160, 320}, [&](int n) {
    const double torque = critical_torque("long twisted rod", n, 0, tension, rod.torque, rod, 300, 0.2);
    against_long_rod.push_back({static_cast<double>(n), std::abs(torque / long_rod - 1)});
    return torque / rod.torque - 1;
  });
  report("long twisted rod, its length counted", samples, 5e-3, Order::second);
  // The rod's finite length raises its torque.
  report("long twisted rod", against_long_rod, 0.05, Order::none);
}

}  // namespace
}  // namespace verlet_cable::validation
