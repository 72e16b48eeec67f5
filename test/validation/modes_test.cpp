#include <gtest/gtest.h>

#include <cmath>

#include "../support/analytic_beam.h"
#include "rods.h"
#include "validation.h"

namespace verlet_cable::validation {
namespace {

/// Steps a period at the coarsest refinement; more in proportion to the segments, so that space and time converge together.
constexpr double coarse_steps = 200;
constexpr int coarse_segments = 20;
constexpr double hanging_tolerances[] = {2e-3, 5e-3, 1e-2};
constexpr double cantilever_tolerances[] = {5e-3, 1e-2};

double step_for(double frequency, int n) {
  return 2 * M_PI / frequency / coarse_steps * coarse_segments / n;
}

std::string ordinal(int mode) {
  return "mode " + std::to_string(mode);
}

/// Relative error of the frequency [rad/s] of a shape in z of amplitude `size` [m], held as `scene` says.
double frequency_error(SceneDesc scene, double stretch, double size, const std::function<double(double)>& shape, double exact) {
  start_at(scene, [&](double s) { return Vector3(stretch * s, 0, size * shape(s)); });
  Simulation run(scene);
  return angular_frequency(run, projection(2, shape), 3) / exact - 1;
}

class HangingCable : public testing::TestWithParam<int> {};

TEST_P(HangingCable, ModesAreThoseOfBesselsFunction) {
  const double zero = analytic::bessel_zeros[GetParam() - 1], tolerance = hanging_tolerances[GetParam() - 1];
  const double exact = 0.5 * zero * std::sqrt(9.81);
  // D. Bernoulli 1733; Lamb, Higher Mechanics, section 78: J0(2 w sqrt(z / g)), z from the free end.
  const auto shape = [zero](double s) { return std::cyl_bessel_j(0, zero * std::sqrt(1 - s)); };
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = scenes::one_cable(n);
    scene.time_step = step_for(exact, n);
    scene.gravity.acceleration = {9.81, 0, 0};
    scene.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 0})};
    return frequency_error(scene, 1, 1e-3, shape, exact);
  });
  report("hanging cable " + ordinal(GetParam()), samples, tolerance, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Modes, HangingCable, testing::Values(1, 2, 3));

class TautString : public testing::TestWithParam<int> {};

TEST_P(TautString, ModesAreHarmonic) {
  const int k = GetParam();
  constexpr double strain = 0.01, stiffness = 1000, density = 0.1;
  const double length = 1 + strain, tension = stiffness * strain;
  // The density is that of the stretched string.
  const double exact = k * M_PI / length * std::sqrt(tension / (density / length));
  const auto shape = [k](double s) { return std::sin(k * M_PI * s); };
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = scenes::one_cable(n);
    scene.time_step = step_for(exact, n);
    scene.gravity.acceleration.setZero();
    material(scene).axial_stiffness = stiffness;
    hold_ends(scene, AttachmentType::hinge, length);
    return frequency_error(scene, length, 3e-5, shape, exact);
  });
  report("taut string " + ordinal(k), samples, 2e-3, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Modes, TautString, testing::Values(1, 2, 3));

class Cantilever : public testing::TestWithParam<int> {};

TEST_P(Cantilever, ModesAreThoseOfABeam) {
  const double root = analytic::cantilever_roots[GetParam() - 1], tolerance = cantilever_tolerances[GetParam() - 1];
  const auto shape = [root](double s) { return analytic::cantilever_mode(root, s); };
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rod(n, step_for(root * root, n));
    clamp_start(scene);
    return frequency_error(scene, 1, 1e-4, shape, root * root / time_unit);
  });
  report("cantilever " + ordinal(GetParam()), samples, tolerance, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Modes, Cantilever, testing::Values(1, 2));

}  // namespace
}  // namespace verlet_cable::validation
