#include <gtest/gtest.h>

#include <cmath>

#include "rods.h"
#include "validation.h"

namespace verlet_cable::validation {
namespace {

/// A rod of length 1 that is closed to a ring in the xy plane.
struct Ring {
  BendingStiffness bending_stiffness;
  double torsional_stiffness;
  double rest_curvature;  ///< of that of the ring
  double twist;           ///< [rad] by which its ends are turned before it is closed
};

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

/// Stiffness of a ring against leaving its plane. Both clamps are at the origin: they only take the free ring's motions as a
/// rigid body.
double stiffness_of_ring(int n, const Ring& ring) {
  constexpr int turning_steps = 50;
  // What grows is the difference of two rings: next to the clamps a polygon is not quite plane in equilibrium.
  std::vector<Simulation> runs;
  for (const double size : {0.0, 1e-5}) {
    SceneDesc scene = rod(n, 1e-3);
    material(scene).bending_stiffness = ring.bending_stiffness;
    material(scene).torsional_stiffness = ring.torsional_stiffness;
    // So little that it takes a time of no account; without it waves of twist go to and fro after the ends were turned.
    material(scene).torsional_damping = 1e-3;
    if (ring.rest_curvature != 0) bend_at_rest(scene, 0, 2 * M_PI * ring.rest_curvature);
    damp(scene, 60);
    hold_ends(scene, AttachmentType::clamp, 0);
    start_at(scene, [&](double s) -> Vector3 { return polygon(s, n) + size * bow(2 * M_PI * s) * Vector3::UnitZ(); });
    runs.emplace_back(scene);
    for (int i = 1; i <= turning_steps; ++i) {
      runs.back().inputs[1].pose.orientation = Eigen::AngleAxisd(ring.twist * i / turning_steps, Vector3::UnitX());
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

/// Leaves its plane where `ring(load)` has no stiffness: at `expected`.
void expect_critical(const std::string& name, double expected, const std::function<Ring(double)>& ring) {
  const auto samples = sample({20, 40, 80}, [&](int n) {
    std::vector<double> loads, stiffnesses;
    const auto stiffness = [&](double load) {
      loads.push_back(load / expected);
      stiffnesses.push_back(stiffness_of_ring(n, ring(load)));
      return stiffnesses.back();
    };
    const double critical = critical_load(stiffness, expected);
    record_curve(name, "n = " + std::to_string(n), loads, stiffnesses);
    return critical / expected - 1;
  });
  report(name, samples, 5e-3, Order::second);
}

/// Michell, On the stability of a bent and twisted wire, 1889: the angle is 2 pi sqrt(3) EI / GJ. The second stiffness makes no
/// difference but that the rod's material axes are followed.
class Michell : public testing::TestWithParam<double> {};

TEST_P(Michell, RingLeavesItsPlaneAtHisAngle) {
  constexpr double torsional_stiffness = 2;
  const double difference = GetParam();
  expect_critical(difference == 0 ? "Michell ring" : "Michell ring, material axes",
                  2 * M_PI * std::sqrt(3.0) / torsional_stiffness, [&](double angle) {
                    return Ring{{1, 1 + difference}, torsional_stiffness, 0, angle};
                  });
}

INSTANTIATE_TEST_SUITE_P(Kernels, Michell, testing::Values(0, 1e-12));

/// Zajac, Stability of two planar loop elasticas, 1962; Manning and Hoffman, Stability of n-covered circles, 2001. A ring of
/// curvature k that is bent open from a rest curvature k0 carries the moment m k, m = B (1 - k0 / k) < 0, and no force. A small
/// rotation (a, b) about its tangent and its normal changes the moment's parts by (-b, a) m k, and the strains by
/// (a' - k b, b' + k a): a' = (1 - m / C) k b, b' = -(1 - m / A) k a. The ring closes where (1 - m / C)(1 - m / A) = 2^2. A and
/// B are the bending stiffnesses across and in its plane, C is the torsional one.
struct ZajacCase {
  const char* name;
  double across, in_plane, torsional;
};

class Zajac : public testing::TestWithParam<ZajacCase> {};

TEST_P(Zajac, RingLeavesItsPlaneAtARestCurvature) {
  const ZajacCase& c = GetParam();
  const double sum = c.across + c.torsional, moment = 0.5 * (sum - std::sqrt(sum * sum + 12 * c.across * c.torsional));
  expect_critical(std::string("Zajac ring") + c.name, 1 - moment / c.in_plane, [&](double rest_curvature) {
    return Ring{{c.across, c.in_plane}, c.torsional, rest_curvature, 0};
  });
}

INSTANTIATE_TEST_SUITE_P(Rings, Zajac, testing::Values(ZajacCase{"", 1, 1, 0.75}, ZajacCase{", flat", 1, 0.5, 0.6}));

}  // namespace
}  // namespace verlet_cable::validation
