#include <gtest/gtest.h>

#include <cmath>

#include "../support/analytic_rod.h"
#include "rods.h"
#include "validation.h"

/// Rods of material frames where they lose their stability. A small load across gives a deflection d; 1 / d goes to nothing as
/// the load that buckles is approached, in a straight line close to it.
namespace verlet_cable::validation {
namespace {

constexpr double across = 1e-6;  ///< of the load across, relative

/// Where the straight line through `stiffness` at two loads close below `expected` vanishes.
double vanishing_load(const std::function<double(double)>& stiffness, double expected) {
  const double x0 = 0.99 * expected, x1 = 0.998 * expected, y0 = stiffness(x0), y1 = stiffness(x1);
  return x1 + y1 * (x1 - x0) / (y0 - y1);
}

/// A ribbon on edge, clamped at its start, with a load at its tip: it gives way sideways and twists (Timoshenko and Gere, Theory
/// of Elastic Stability, 1961, 6.3).
TEST(Ribbon, CantileverBucklesSideways) {
  constexpr double weak = 1, torsional = 1;
  const double expected = 4.01260 * std::sqrt(weak * torsional);
  const auto samples = sample({20, 40, 80}, [&](int n) {
    const auto stiffness = [n](double load) {
      SceneDesc scene = rod(n, 1e-3);
      material(scene).linear_density = 1e-6;
      material(scene).bending_stiffness = {1000 * weak, weak};
      material(scene).torsional_stiffness = torsional;
      clamp_start(scene);
      start_at(scene, [](double s) { return Vector3(s, 0, 0); });
      scene.cables[0].point_masses = {scenes::payload(1)};
      scene.gravity.acceleration = {0, across * load, -load};
      Simulation run(scene);
      EXPECT_TRUE(run.world.settle());
      return across * load / run.positions().back().y();
    };
    return vanishing_load(stiffness, expected) / expected - 1;
  });
  report("ribbon: cantilever", samples, 5e-3, Order::none);
}

/// A rod that is straight and bends alike about all axes, with frames: a torque buckles it (Greenhill 1883), its end free to come
/// closer.
TEST(MaterialFrames, TwistedRodBuckles) {
  const double expected = analytic::untensioned_buckling_torque;
  constexpr double torsional = 5;
  const auto samples = sample({20, 40, 80}, [&](int n) {
    const auto stiffness = [n](double torque) {
      SceneDesc scene = rod(n, 1e-3);
      material(scene).axial_stiffness = 1;
      material(scene).torsional_stiffness = torsional;
      scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::constant;
      scene.cables[0].rest_curvature.curvature = {0, 1e-100};
      hold_ends(scene, AttachmentType::clamp, 1);
      start_at(scene, [](double s) { return Vector3(s, 0, 0); });
      scene.gravity.acceleration = {0, 0, -1e-4};
      Simulation run(scene);
      constexpr int steps = 10;
      for (int i = 1; i <= steps; ++i) {
        run.inputs[1].pose.orientation = Eigen::AngleAxisd(torque / torsional * i / steps, Vector3::UnitX());
        run.step();
        EXPECT_TRUE(run.world.settle());
      }
      return 1e-6 / run.positions()[n / 2].tail<2>().norm();
    };
    return vanishing_load(stiffness, expected) / expected - 1;
  });
  report("twisted rod of frames", samples, 0.05, Order::second);
}

}  // namespace
}  // namespace verlet_cable::validation
