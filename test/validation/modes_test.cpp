#include <gtest/gtest.h>

#include <algorithm>
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

/// Bends about y where it swings along z, and about z where it swings along y: four times the stiffness, twice the frequency.
TEST(FlatCantilever, SwingsTwiceAsFastAcross) {
  const double root = analytic::cantilever_roots[0];
  const auto shape = [root](double s) { return analytic::cantilever_mode(root, s); };
  for (const int component : {1, 2}) {
    const double exact = root * root / time_unit * (component == 1 ? 2 : 1);
    const auto samples = sample({20, 40, 80}, [&](int n) {
      SceneDesc scene = rod(n, step_for(exact * time_unit, n));
      material(scene).bending_stiffness = {1, 4};
      material(scene).torsional_stiffness = 1;
      clamp_start(scene);
      start_at(scene, [&](double s) {
        Vector3 point(s, 0, 0);
        point[component] = 1e-4 * shape(s);
        return point;
      });
      Simulation run(scene);
      return angular_frequency(run, projection(component, shape), 3) / exact - 1;
    });
    report(std::string("flat cantilever, along ") + (component == 1 ? "y" : "z"), samples, 5e-3, Order::second);
  }
}

/// Torsion of a rod of round section: waves of speed sqrt(GJ / (mu r^2 / 2)), four lengths long in the lowest mode of a
/// cantilever (Blevins 1979, table 8-16).
TEST(TorsionalMode, IsAQuarterWave) {
  constexpr double radius = 0.02, torsional_stiffness = 0.0075;
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = scenes::one_cable(n);
    scene.gravity.acceleration.setZero();
    material(scene).radius = radius;
    material(scene).bending_stiffness = {0.01, 0.02};
    material(scene).torsional_stiffness = torsional_stiffness;
    const double exact = M_PI / 2 * std::sqrt(2 * torsional_stiffness / material(scene).linear_density) / radius;
    scene.time_step = step_for(exact, n);
    scene.cables[0].attachments = {
        scenes::attachment("start", PlaceDesc::At::start, Vector3::Zero(), "hand", AttachmentType::clamp)};
    scene.cables[0].attachments[0].initial_pose = InitialPose{};
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    Simulation run(scene);
    // The clamp turns evenly for half a period, which leaves the lowest mode at its largest; the next one, three times as fast,
    // is no part of what is projected.
    constexpr double angle = 0.01;
    const double time = M_PI / exact;
    while (run.world.time() < time) {
      const double part = std::min(1.0, (run.world.time() + run.world.time_step()) / time);
      run.inputs[1].pose.orientation = Eigen::AngleAxisd(angle * part, Vector3::UnitX());
      run.step();
    }
    const auto roll = [angle](const Simulation& r) {
      const std::vector<Quaternion> frames = segment_orientations(r.cable().state);
      double sum = 0;
      for (std::size_t i = 0; i < frames.size(); ++i) {
        const Vector3 y = frames[i] * Vector3::UnitY();
        sum += (std::atan2(y.z(), y.y()) - angle) * std::sin(M_PI / 2 * (i + 0.5) / frames.size());
      }
      return sum;
    };
    return angular_frequency(run, roll, 4) / exact - 1;
  });
  report("torsional mode", samples, 5e-3, Order::second);
}

}  // namespace
}  // namespace verlet_cable::validation
