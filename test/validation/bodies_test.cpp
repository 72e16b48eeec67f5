#include "bodies.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "validation.h"

/// Oscillations and equilibria of rigid bodies against closed forms.
namespace verlet_cable::validation {
namespace {

/// [rad/s] Small enough that a pendulum's period is that of small swings within 1e-5.
constexpr double small_spin = 0.02;
constexpr int half_periods = 6;

MaterialDesc& rope(SceneDesc& scene) {
  return scene.materials[0].material;
}

/// Relative error of the period of small swings, `spin_of` being what swings, from rest at its middle.
double period_error(const SceneDesc& scene, double exact, const std::function<double(const Simulation&)>& spin_of) {
  Simulation run(scene);
  return 2 * M_PI / angular_frequency(run, spin_of, half_periods) / exact - 1;
}

std::function<double(const Simulation&)> spin(int component) {
  return [component](const Simulation& run) { return run.world.bodies()[0].angular_velocity[component]; };
}

/// Coulomb 1784. The wire is clamped on both sides, and carries the body's weight.
TEST(Body, OnATorsionWire) {
  constexpr double inertia = 0.002, length = 0.5, torsional_stiffness = 0.01;
  const double exact = 2 * M_PI * std::sqrt(inertia * length / torsional_stiffness);
  const auto samples = sample({4, 40}, [&](int n) {
    SceneDesc scene = no_cables();
    rope(scene).linear_density = 1e-3;
    rope(scene).radius = 5e-4;
    rope(scene).bending_stiffness = 0.02;
    rope(scene).torsional_stiffness = torsional_stiffness;
    add_body(scene, "body", 1, {inertia, 0.001, 0.0015}, {0, 0, -length, 0, M_PI / 2, 0}).angular_velocity = {0, 0, 0.5};
    add_cable(scene, "wire", length, n, {0, 0, 0}, {0, 0, -length},
              {"", Vector3::Zero(), AttachmentType::clamp, {0, M_PI / 2, 0}}, {"body", Vector3::Zero(), AttachmentType::clamp});
    return period_error(scene, exact, spin(2));
  });
  report("body on a torsion wire: period", samples, 2e-3, Order::none);
}

/// Two threads of length d, 2 b apart (Routh, Elementary Rigid Dynamics, section 135). The body's center is below its frame.
TEST(Body, OnTwoThreadsTurning) {
  constexpr double mass = 1, inertia = 0.01, d = 0.5, b = 0.1;
  const double exact = 2 * M_PI * std::sqrt(inertia * d / (mass * gravity * b * b));
  const auto samples = sample({1, 5, 20}, [&](int n) {
    SceneDesc scene = no_cables();
    rope(scene).linear_density = 1e-4;
    rope(scene).radius = 5e-4;
    BodyDesc& body = add_body(scene, "body", mass, {0.005, 0.006, inertia}, {0, 0, -d, 0, 0, 0});
    body.center_of_mass = Vector3(0, 0, -0.05);
    body.angular_velocity = {0, 0, small_spin};
    for (const double side : {-b, b})
      add_cable(scene, side < 0 ? "left" : "right", d, n, {side, 0, 0}, {side, 0, -d}, {"", {side, 0, 0}},
                {"body", {side, 0, 0}});
    return period_error(scene, exact, spin(2));
  });
  report("body on two threads, turning: period", samples, 2e-3, Order::none);
}

/// [s] Of a rigid body of that mass and moment about its center of mass, `arm` below its axis.
double pendulum_period(double mass, double inertia, double arm) {
  return 2 * M_PI * std::sqrt((inertia + mass * arm * arm) / (mass * gravity * arm));
}

/// A body clamped to a rope that hardly bends, hinged on top; its center is not where the rope ends.
TEST(Pendulum, OfABodyOnAShortStiffRope) {
  constexpr double mass = 0.5, inertia = 1e-3, length = 0.1, arm = 0.13, density = 0.2;
  // With the rope, a uniform rod about its end
  const double turning = inertia + mass * arm * arm + density * length * length * length / 3;
  const double exact = 2 * M_PI * std::sqrt(turning / (gravity * (mass * arm + density * length * length / 2)));
  const auto samples = sample({5, 20}, [&](int n) {
    SceneDesc scene = no_cables();
    rope(scene).linear_density = density;
    rope(scene).bending_stiffness = 200;
    rope(scene).torsional_stiffness = 200;
    BodyDesc& body = add_body(scene, "body", mass, {2e-3, inertia, 1.5e-3}, {0, 0, -length, 0, M_PI / 2, 0});
    body.center_of_mass = Vector3(arm - length, 0, 0);
    body.angular_velocity = {0, small_spin, 0};
    body.velocity = {-arm * small_spin, 0, 0};
    CableDesc& cable = add_cable(scene, "rope", length, n, {0, 0, 0}, {0, 0, -length}, {"", Vector3::Zero()},
                                 {"body", Vector3::Zero(), AttachmentType::clamp});
    cable.initial.velocities = {Vector3::Zero(), {-length * small_spin, 0, 0}};
    return period_error(scene, exact, spin(1));
  });
  report("physical pendulum on a stiff rope: period", samples, 1e-3, Order::none);
}

class HeldPendulum : public testing::TestWithParam<AttachmentType> {};

TEST_P(HeldPendulum, SwingsAboutItsHolder) {
  constexpr double mass = 0.5, arm = 0.15;
  const bool is_axle = GetParam() == AttachmentType::axle;
  SceneDesc scene = no_cables();
  // Held 0.1 m above its frame, the center 0.05 m below that; it swings about y, which is the axle's z.
  BodyDesc& body = add_body(scene, "body", mass, {2e-3, 1e-3, 1.5e-3}, {0, 0, -0.1, 0, 0, 0});
  body.center_of_mass = Vector3(0, 0, -0.05);
  BodyAttachmentDesc& holder = hold(body, GetParam(), {0, 0, 0.1});
  if (is_axle) {
    holder.rotation = {M_PI / 2, 0, 0};
    holder.at[3] = M_PI / 2;
  }
  body.angular_velocity = {0, small_spin, 0};
  body.velocity = {-arm * small_spin, 0, 0};
  const double error = period_error(scene, pendulum_period(mass, 1e-3, arm), spin(1));
  report(std::string("physical pendulum on ") + (is_axle ? "an axle" : "a hinge") + ": period", {{1, std::abs(error)}}, 1e-4,
         Order::none);
}

INSTANTIATE_TEST_SUITE_P(Holders, HeldPendulum, testing::Values(AttachmentType::hinge, AttachmentType::axle));

/// An axle that leans by an angle from the vertical: of gravity, the part across it drives the swing.
TEST(Pendulum, OnALeaningAxle) {
  constexpr double mass = 0.5, inertia = 1e-3, arm = 0.15, lean = 0.3;
  SceneDesc scene = no_cables();
  BodyDesc& body = add_body(scene, "body", mass, {2e-3, 1.5e-3, inertia});
  body.center_of_mass = Vector3(arm, 0, 0);
  body.pose.reset();
  // The axle's z leans from the vertical towards -x; the body's x then points downhill.
  hold(body, AttachmentType::axle, Vector3::Zero()).rotation = {0, lean, 0};
  body.angular_velocity = small_spin * Vector3(std::sin(lean), 0, std::cos(lean));
  body.velocity = {0, arm * small_spin, 0};
  const double exact = 2 * M_PI * std::sqrt((inertia + mass * arm * arm) / (mass * gravity * std::sin(lean) * arm));
  report("pendulum on a leaning axle: period", {{1, std::abs(period_error(scene, exact, spin(2)))}}, 1e-4, Order::none);
}

/// A body on four upright elastic ropes on the corners of a square, one of them longer by `longer`: that is shared so that it and
/// the one across are relieved by k longer / 4, and the others pull as much more.
TEST(Body, OnFourRopesOfWhichOneIsLonger) {
  constexpr double mass = 10, side = 0.3, length = 1, longer = 1e-3, stiffness = 1e4;
  SceneDesc scene = no_cables();
  rope(scene).linear_density = 1e-3;
  rope(scene).axial_stiffness = stiffness;
  rope(scene).axial_damping = 100;
  BodyDesc& body = add_body(scene, "load", mass, {0.3, 0.4, 0.6}, {0, 0, -length, 0, 0, 0});
  body.linear_damping = 100;
  body.angular_damping = 10;
  for (int i = 0; i < 4; ++i) {
    const Vector3 corner(i % 3 == 0 ? side : -side, i < 2 ? side : -side, 0);
    add_cable(scene, "rope" + std::to_string(i), length + (i == 0 ? longer : 0), 5, corner, corner - Vector3(0, 0, length),
              {"", corner}, {"load", corner});
  }
  Simulation run(scene);
  run.run(20);
  EXPECT_LT(run.world.energy().kinetic, 1e-12);
  double error = 0;
  for (int i = 0; i < 4; ++i) {
    const double share = (mass * gravity + (i % 2 == 0 ? -1 : 1) * stiffness / length * longer) / 4;
    error = std::max(error, std::abs(run.force("rope" + std::to_string(i) + "_end").norm() / share - 1));
  }
  report("load on four ropes, one 1 mm longer: tensions", {{4, error}}, 5e-3, Order::none);
}

}  // namespace
}  // namespace verlet_cable::validation
