#include <gtest/gtest.h>

#include <cmath>

#include "rods.h"
#include "validation.h"

namespace verlet_cable::validation {
namespace {

constexpr double torsional_stiffness = 2;
/// Michell, On the stability of a bent and twisted wire, 1889: angle by which the ends are turned before the ring is closed.
const double michell_angle = 2 * M_PI * std::sqrt(3.0) / torsional_stiffness;

/// The free ring's lowest mode out of its plane, moved as a rigid body to keep to the clamps. Of its two phases it is the one
/// that a half turn about the ring's axis through the clamps leaves alone; to the other one belongs a motion without any
/// stiffness, the turning of the whole ring about the clamps' axis, which hides what grows.
double bow(double angle) {
  return std::sin(2 * angle) - 2 * std::sin(angle);
}

/// Corners of a regular polygon of sides 1 / n that leaves the origin along +x.
Vector3 polygon(double s, int n) {
  const double radius = 0.5 / n / std::sin(M_PI / n), angle = 2 * M_PI * s;
  return {radius * std::sin(angle), radius * (1 - std::cos(angle)), 0};
}

/// Stiffness against leaving the plane of a ring whose end clamp is turned by `angle`. Both clamps are at the origin: they only
/// take the free ring's motions as a rigid body.
double stiffness_of_ring(int n, double angle) {
  constexpr int turning_steps = 50;
  // What grows is the difference of two rings: next to the clamps a polygon is not quite plane in equilibrium.
  std::vector<Simulation> runs;
  for (const double size : {0.0, 1e-5}) {
    SceneDesc scene = rod(n, 5e-4);
    material(scene).torsional_stiffness = torsional_stiffness;
    damp(scene, 60);
    hold_ends(scene, AttachmentType::clamp, 0);
    start_at(scene, [&](double s) -> Vector3 { return polygon(s, n) + size * bow(2 * M_PI * s) * Vector3::UnitZ(); });
    runs.emplace_back(scene);
    for (int i = 1; i <= turning_steps; ++i) {
      runs.back().inputs[1].pose.orientation = Eigen::AngleAxisd(angle * i / turning_steps, Vector3::UnitX());
      runs.back().step();
    }
  }
  Simulation &flat = runs[0], &bowed = runs[1];
  const auto difference = [&flat](const Simulation& run) {
    flat.run(run.world.time() - flat.world.time());
    double sum = 0;
    for (std::size_t i = 0; i < run.positions().size(); ++i) sum += (run.positions()[i] - flat.positions()[i]).squaredNorm();
    return std::sqrt(sum);
  };
  return stiffness_from_growth(bowed, difference, 0.5, 1);
}

TEST(Ring, LeavesItsPlaneAtMichellsAngle) {
  const std::string name = "Michell ring";
  const auto samples = sample({25, 50, 100}, [&](int n) {
    std::vector<double> angles, stiffnesses;
    const auto stiffness = [&](double angle) {
      angles.push_back(angle / michell_angle);
      stiffnesses.push_back(stiffness_of_ring(n, angle));
      return stiffnesses.back();
    };
    const double critical = critical_load(stiffness, michell_angle);
    record_curve(name, "n = " + std::to_string(n), angles, stiffnesses);
    return critical / michell_angle - 1;
  });
  report(name, samples, 0.07, Order::second);
}

}  // namespace
}  // namespace verlet_cable::validation
