#include <gtest/gtest.h>

#include <cmath>

#include "rods.h"
#include "validation.h"

namespace verlet_cable::validation {
namespace {

constexpr double gravity = 9.81, length = 2;

/// A cable of 10 mm and 0.2 kg/m in water.
SceneDesc in_water(int segments) {
  SceneDesc scene = scenes::one_cable(segments, length);
  material(scene).linear_density = 0.2;
  scene.fluid.density = 1000;
  return scene;
}

/// [N/m]
double weight_in_water(const SceneDesc& scene) {
  const MaterialDesc& m = scene.materials[0].material;
  return gravity * (m.linear_density - scene.fluid.density * M_PI * m.radius * m.radius);
}

/// [N s^2/m^3] per length: drag over the square of the speed, the diameter as width.
double drag_per_length(const SceneDesc& scene, double coefficient) {
  return 0.5 * scene.fluid.density * coefficient * 2 * scene.materials[0].material.radius;
}

class Towed : public testing::TestWithParam<double> {};

/// A cable that is free at its end is straight in a steady stream. Across it, weight balances the normal drag: w cos(angle) =
/// drag sin(angle)^2, its angle against the stream. (Faltinsen, Sea Loads, 1990; the critical angle of towed arrays.)
TEST_P(Towed, HangsAtTheAngleOfTheDragBalance) {
  const double speed = GetParam();
  const auto samples = sample({10, 20, 40}, [speed](int n) {
    SceneDesc scene = in_water(n);
    scene.fluid.velocity = {speed, 0, 0};
    scene.cables[0].attachments = {scenes::attachment("boat", PlaceDesc::At::start, Vector3::Zero())};
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    const double drag = drag_per_length(scene, scene.fluid.normal_drag) * speed * speed, weight = weight_in_water(scene);
    const double cosine = (std::sqrt(weight * weight + 4 * drag * drag) - weight) / (2 * drag), angle = std::acos(cosine);
    // What is tangential ends up at the boat.
    const double along = drag_per_length(scene, scene.fluid.tangential_drag) * speed * speed * cosine * cosine;
    const double tension = length * (weight * std::sin(angle) + along);
    EXPECT_NEAR(run.force("boat").norm() / tension, 1, 5e-3);
    const Vector3& end = run.positions().back();
    return std::atan2(-end.z(), end.x()) / angle - 1;
  });
  report("towed cable, " + std::to_string(speed).substr(0, 3) + " m/s", samples, 5e-3, Order::none);
}

INSTANTIATE_TEST_SUITE_P(Speeds, Towed, testing::Values(0.3, 1.0));

/// The same angle is reached in time, when the boat moves and the water stands.
TEST(Towed, ComesToTheSameAngleBehindABoat) {
  constexpr double speed = 0.5;
  SceneDesc scene = in_water(20);
  scene.time_step = 0.005;
  scene.cables[0].attachments = {scenes::attachment("boat", PlaceDesc::At::start, Vector3::Zero(), "boat")};
  scene.cables[0].attachments[0].initial_pose = InitialPose{};
  Simulation run(scene);
  while (run.world.time() < 40 && !HasFatalFailure()) {
    run.inputs[1].pose.position.x() = -speed * run.world.time();
    run.step();
  }
  const double drag = drag_per_length(scene, scene.fluid.normal_drag) * speed * speed, weight = weight_in_water(scene);
  const double angle = std::acos((std::sqrt(weight * weight + 4 * drag * drag) - weight) / (2 * drag));
  const Vector3 trail = run.positions().back() - run.positions().front();
  report("towed cable, moving boat", {{20, std::abs(std::atan2(-trail.z(), trail.x()) / angle - 1)}}, 5e-3, Order::none);
}

struct Fall {
  std::string name;
  Vector3 along;
  double FluidDesc::*coefficient;
};

class Falling : public testing::TestWithParam<Fall> {};

TEST_P(Falling, ReachesTerminalVelocity) {
  std::vector<double> times, speeds;
  const auto samples = sample({20}, [&](int n) {
    SceneDesc scene = in_water(n);
    scene.fluid.tangential_drag = 0.1;
    scene.time_step = 0.01;
    scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
    scene.cables[0].initial.to = GetParam().along;
    Simulation run(scene);
    while (run.world.time() < 10 && !HasFatalFailure()) {
      run.step();
      times.push_back(run.world.time());
      speeds.push_back(-run.cable().state.velocities[n / 2].z());
    }
    const double exact = std::sqrt(weight_in_water(scene) / drag_per_length(scene, scene.fluid.*GetParam().coefficient));
    return speeds.back() / exact - 1;
  });
  record_curve("terminal velocity", GetParam().name, times, speeds);
  report("terminal velocity, " + GetParam().name, samples, 2e-3, Order::none);
}

INSTANTIATE_TEST_SUITE_P(Directions, Falling,
                         testing::Values(Fall{"across", Vector3::UnitX(), &FluidDesc::normal_drag},
                                         Fall{"along", -Vector3::UnitZ(), &FluidDesc::tangential_drag}));

}  // namespace
}  // namespace verlet_cable::validation
