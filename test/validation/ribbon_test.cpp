#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "kirchhoff_references.h"
#include "rods.h"
#include "validation.h"

/// Lateral-torsional buckling: an upright ribbon, stiff against bending about y, leaves its plane, xz. EI2 = GJ = 1.
namespace verlet_cable::validation {
namespace {

constexpr double strong = 1000;

SceneDesc ribbon(int segments, double time_step) {
  SceneDesc scene = rod(segments, time_step);
  material(scene).bending_stiffness = {strong, 1};
  material(scene).torsional_stiffness = 1;
  return scene;
}

/// Load at which `stiffness_at(n, load)` vanishes, against `expected` and against the textbook's.
void expect_critical(const std::string& name, double expected, double textbook,
                     const std::function<double(int, double)>& stiffness_at) {
  std::vector<Sample> against_textbook;
  const auto samples = sample({20, 40, 80}, [&](int n) {
    std::vector<double> loads, stiffnesses;
    const auto stiffness = [&](double load) {
      loads.push_back(load / expected);
      stiffnesses.push_back(stiffness_at(n, load));
      return stiffnesses.back();
    };
    const double critical = critical_load(stiffness, expected);
    record_curve(name, "n = " + std::to_string(n), loads, stiffnesses);
    against_textbook.push_back({static_cast<double>(n), std::abs(critical / textbook - 1)});
    return critical / expected - 1;
  });
  report(name, against_textbook, 5e-3, Order::none);
  report(name + ", its own bow counted", samples, 5e-3, Order::second);
}

/// Michell 1899, Prandtl 1899: a cantilever under a load at its end buckles at 4.0126 sqrt(EI2 GJ) / L^2, if it is infinitely
/// stiff in its plane.
TEST(RibbonCantilever, BucklesAtPrandtlsLoad) {
  // The load is a weight, beside which the ribbon's is next to nothing. Drag is so much that the weight creeps.
  constexpr double drag = 50, duration = 100, time_step = 0.1;
  const auto mode = [](double s) { return s * s * (3 - s) / 2; };
  expect_critical("ribbon, cantilever", references::ribbon_buckling_load, 4.012599, [&](int n, double load) {
    SceneDesc scene = ribbon(n, time_step / time_unit);
    const double payload = material(scene).linear_density / references::ribbon_weight;
    scene.gravity.acceleration.z() = -load / payload;
    scene.cables[0].point_masses = {scenes::payload(payload)};
    material(scene).drag = drag;
    clamp_start(scene);
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    Simulation plane(scene);
    EXPECT_TRUE(plane.world.settle());
    scene.cables[0].initial.points = plane.positions();
    for (int i = 0; i <= n; ++i) scene.cables[0].initial.points[i].y() += 1e-6 * mode(static_cast<double>(i) / n);
    Simulation run(scene);
    // The end's motion is the slow one: what the stiffness's inertia and drag are does not matter where it vanishes.
    run.run(0.5 * duration);
    const double before = run.positions().back().y();
    run.run(0.5 * duration);
    return -std::log(std::abs(run.positions().back().y() / before));
  });
}

/// The same: a beam whose ends are supported, not rolled, and bent upwards by moments buckles at pi sqrt(EI2 GJ) / L, and a bow
/// that it has by then makes it sqrt((1 - EI2 / EI1) (1 - GJ / EI1)) times harder (Trahair, Flexural-Torsional Buckling of
/// Structures, 1993, section 7.3). Clamps hold its ends: turned about y they give the moment, and about z they give way until
/// they feel none.
TEST(RibbonBeam, BucklesUnderMichellsMoments) {
  constexpr double drag = 20, duration = 3, time_step = 2e-3, size = 3e-6;
  constexpr double yielding = 2e-3;  // [rad/(N m)] a step: far from the stiffness of half a segment
  const double expected = M_PI / std::sqrt((1 - 1 / strong) * (1 - 1 / strong));
  expect_critical("ribbon, supported beam", expected, M_PI, [&](int n, double moment) {
    const double bend = moment / strong, half = 0.5 * bend;
    // Of the polygon that turns by bend / n at a corner and by half of that at its ends.
    const auto corner = [&](double i) -> Vector3 {
      const double side = 0.5 * bend / n, angle = half - i * side;
      return std::sin(i * side) / std::sin(side) / n * Vector3(std::cos(angle), 0, std::sin(angle));
    };
    SceneDesc scene = ribbon(n, time_step);
    material(scene).axial_stiffness = 1e5;  // its ends stand: a bow of 1e-6 to the side must not tighten it
    damp(scene, drag);
    hold_ends(scene, AttachmentType::clamp, 0);
    scene.cables[0].attachments[0].frame = "base";
    scene.cables[0].attachments[1].initial_pose.reset();
    start_at(scene, [&](double s) { return corner(s * n); });
    const std::array<Quaternion, 2> pitch{Quaternion(Eigen::AngleAxisd(-half, Vector3::UnitY())),
                                          Quaternion(Eigen::AngleAxisd(half, Vector3::UnitY()))};
    std::array<double, 2> yaw{0, 0};  // of the clamps, about their own z
    BoundaryInputs frames = initial_frames(scene);
    const auto turn_clamps = [&](BoundaryInputs& inputs) {
      for (int end : {0, 1}) {
        inputs[1 + end] = {};
        inputs[1 + end].pose.position = corner(end * n);
        inputs[1 + end].pose.orientation = pitch[end] * Eigen::AngleAxisd(yaw[end], Vector3::UnitZ());
      }
    };
    turn_clamps(frames);
    Simulation run(scene, frames);
    yaw = {size, -size};  // not before: the clamps take a rod of any roll at first
    turn_clamps(run.inputs);
    const auto run_for = [&](double time) {
      for (long steps = std::lround(time / time_step); steps > 0 && !testing::Test::HasFatalFailure(); --steps) {
        run.step();
        for (int end : {0, 1}) {
          const Vector3 across = pitch[end] * Vector3::UnitZ();
          yaw[end] += yielding * run.torque(end == 0 ? "start" : "end").dot(across);
        }
        turn_clamps(run.inputs);
      }
    };
    const auto amplitude = projection(1, [](double s) { return std::sin(M_PI * s); });
    run_for(0.5 * duration);
    const double before = amplitude(run);
    run_for(0.5 * duration);
    return -std::log(std::abs(amplitude(run) / before));
  });
}

}  // namespace
}  // namespace verlet_cable::validation
