#include <gtest/gtest.h>

#include <cmath>

#include "rods.h"
#include "validation.h"

namespace verlet_cable::validation {
namespace {

constexpr double torsional_stiffness = 2;
/// Michell, On the stability of a bent and twisted wire, 1889: angle by which the ends are turned before the ring is closed.
const double michell_angle = 2 * M_PI * std::sqrt(3.0) / torsional_stiffness;

/// Corners of a regular polygon of sides 1 / n that leaves the origin along +x, and with it `bow` of the two shapes that leave
/// the plane and keep to the clamps.
Vector3 ring_point(double s, int n, double bow) {
  const double radius = 0.5 / n / std::sin(M_PI / n), angle = 2 * M_PI * s;
  return {radius * std::sin(angle), radius * (1 - std::cos(angle)),
          bow * (std::cos(2 * angle) - std::cos(angle) + std::sin(2 * angle) - 2 * std::sin(angle))};
}

/// Stiffness against leaving the plane of a ring whose end clamp is turned by `angle`. Both clamps are at the origin: they only
/// take the free ring's motions as a rigid body.
double stiffness_of_ring(int n, double angle) {
  constexpr int turning_steps = 50;
  // What grows is the difference of two rings: next to the clamps a polygon is not quite plane in equilibrium.
  std::vector<Simulation> runs;
  for (const double bow : {0.0, 1e-5}) {
    SceneDesc scene = rod(n, 2e-4);
    material(scene).torsional_stiffness = torsional_stiffness;
    damp(scene, 200);
    hold_ends(scene, AttachmentType::clamp, 0);
    start_at(scene, [&](double s) { return ring_point(s, n, bow); });
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
  return stiffness_from_growth(bowed, difference, 0.1, 0.2);
}

TEST(Ring, LeavesItsPlaneAtMichellsAngle) {
  const auto samples = sample({25, 50, 100}, [](int n) {
    const double low = 0.93 * michell_angle, high = 1.07 * michell_angle;
    const double y0 = stiffness_of_ring(n, low), y1 = stiffness_of_ring(n, high);
    record_curve("Michell ring", "n = " + std::to_string(n), {0.93, 1.07}, {y0, y1});
    return std::sqrt(zero_between(low * low, y0, high * high, y1)) / michell_angle - 1;
  });
  report("Michell ring", samples, 0.07, Order::second);
}

}  // namespace
}  // namespace verlet_cable::validation
