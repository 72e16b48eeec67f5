#include <gtest/gtest.h>

#include <cmath>

#include "bodies.h"
#include "validation.h"

/// What moving bodies keep: energy, momenta; and how accurately they move.
namespace verlet_cable::validation {
namespace {

MaterialDesc& rope(SceneDesc& scene) {
  return scene.materials[0].material;
}

double relative_change(const Vector3& after, const Vector3& before) {
  return (after - before).norm() / before.norm();
}

/// Euler's equations in the body's axes, by the classical Runge-Kutta method: the spin after a time.
Vector3 euler_spin(const Vector3& inertia, Vector3 spin, double time, int steps) {
  const auto rate = [&](const Vector3& w) {
    return Vector3((inertia.y() - inertia.z()) * w.y() * w.z() / inertia.x(),
                   (inertia.z() - inertia.x()) * w.z() * w.x() / inertia.y(),
                   (inertia.x() - inertia.y()) * w.x() * w.y() / inertia.z());
  };
  const double h = time / steps;
  for (int i = 0; i < steps; ++i) {
    const Vector3 a = rate(spin), b = rate(spin + h / 2 * a), c = rate(spin + h / 2 * b), d = rate(spin + h * c);
    spin += h / 6 * (a + 2 * b + 2 * c + d);
  }
  return spin;
}

constexpr double flips_duration = 30;

SceneDesc tumbling_body() {
  SceneDesc scene = no_cables();
  scene.gravity.acceleration.setZero();
  BodyDesc& body = add_body(scene, "body", 2, {1, 2, 2.8});
  body.center_of_mass = Vector3(0.1, -0.2, 0.3);
  body.velocity = {0.1, 0.2, 0.3};
  body.angular_velocity = {0.01, 3, 0.02};
  return scene;
}

TEST(FreeBody, KeepsEnergyAndMomenta) {
  Simulation run(tumbling_body());
  const Momenta before = momenta_of(run.world);
  const double energy = energy_error(run, 60);
  const Momenta after = momenta_of(run.world);
  report("free body: energy", {{1, energy}}, 1e-9, Order::none);
  report("free body: linear momentum", {{1, relative_change(after.linear, before.linear)}}, 1e-11, Order::none);
  report("free body: angular momentum", {{1, relative_change(after.angular, before.angular)}}, 1e-9, Order::none);
  EXPECT_NEAR(body_of(run, "body").pose.orientation.norm(), 1, 1e-14);
}

/// Turning about its middle axis, it turns over again and again (Dzhanibekov; Euler 1765). The errors are those of the times at
/// which it does, in parts of the time.
TEST(FreeBody, TurnsOverWhenItShould) {
  const auto samples = sample({1, 2, 4}, [](int refinement) {
    SceneDesc scene = tumbling_body();
    scene.time_step = 0.004 / refinement;
    Simulation run(scene);
    const BodyDesc& desc = scene.bodies[0];
    const auto spin_of = [&] {
      const SimulatedBody& body = run.world.bodies()[0];
      return Vector3(body.pose.orientation.conjugate() * body.angular_velocity);
    };
    Vector3 exact = desc.angular_velocity;
    double before = exact.y(), exact_before = exact.y(), last = 0, exact_last = 0, error = 0;
    int turned = 0, exact_turned = 0;
    while (run.world.time() < flips_duration && !testing::Test::HasFatalFailure()) {
      run.step();
      exact = euler_spin(*desc.inertia, exact, scene.time_step, 4);
      const auto crossing = [&](double from, double to) { return run.world.time() - scene.time_step * to / (to - from); };
      if ((before < 0) != (spin_of().y() < 0)) last = crossing(before, spin_of().y()), ++turned;
      if ((exact_before < 0) != (exact.y() < 0)) exact_last = crossing(exact_before, exact.y()), ++exact_turned;
      before = spin_of().y();
      exact_before = exact.y();
    }
    EXPECT_GE(turned, 3);
    EXPECT_EQ(turned, exact_turned);
    error = last / exact_last - 1;
    return error;
  });
  report("free body: time of its last turn over", samples, 1e-4, Order::second);
}

/// Two bodies, each hanging on a point of the one above it, that swing and turn in space.
TEST(DoublePendulum, OfTwoBodiesKeepsItsEnergy) {
  SceneDesc scene = no_cables();
  BodyDesc& upper = add_body(scene, "upper", 1, {0.01, 0.02, 0.025}, {0, 0.2, 0, 0, 0, 0});
  hold(upper, AttachmentType::hinge, {0, -0.2, 0});
  BodyDesc& lower = add_body(scene, "lower", 0.5, {0.005, 0.01, 0.012}, {0, 0.6, 0, 0, 0, 0});
  hold(lower, AttachmentType::hinge, {0, -0.2, 0}, "upper", {0, 0.2, 0});
  lower.angular_velocity = {0, 2, 0};
  Simulation run(scene);
  report("double pendulum of two bodies: energy over 60 s", {{1, energy_error(run, 60)}}, 1e-5, Order::none);
}

/// The same with a short rope between them, and another to the ceiling.
TEST(DoublePendulum, OfTwoBodiesOnRopesKeepsItsEnergy) {
  SceneDesc scene = no_cables();
  rope(scene).linear_density = 0.01;
  add_body(scene, "upper", 1, {0.01, 0.02, 0.025}, {0.3, 0, 0, 0, 0, 0});
  add_body(scene, "lower", 0.5, {0.005, 0.01, 0.012}, {0.6, 0, 0, 0, 0, 0});
  add_cable(scene, "first", 0.2, 1, {0, 0, 0}, {0.2, 0, 0}, {}, {"upper", {-0.1, 0, 0}});
  add_cable(scene, "second", 0.1, 1, {0.4, 0, 0}, {0.5, 0, 0}, {"upper", {0.1, 0, 0}}, {"lower", {-0.1, 0, 0}});
  Simulation run(scene);
  report("double pendulum of two bodies on ropes: energy over 60 s", {{1, energy_error(run, 60)}}, 1e-5, Order::none);
}

/// Two bodies that fly, spin, and pull at each other.
SceneDesc two_free_bodies(AttachmentType type) {
  SceneDesc scene = no_cables();
  scene.numerical_damping = false;  // which keeps momenta to second order only
  scene.gravity.acceleration.setZero();
  BodyDesc& left = add_body(scene, "left", 0.3, {1e-3, 2e-3, 2.5e-3}, {-0.4, 0, 0, 0, 0, 0});
  left.velocity = {0.2, -1, 0.1};
  left.angular_velocity = {1, 3, -2};
  BodyDesc& right = add_body(scene, "right", 0.2, {1e-3, 1.5e-3, 2e-3}, {0.4, 0, 0, 0, 0, 0});
  right.velocity = {0.1, 1.5, 0.3};
  right.angular_velocity = {-1, 2, 1};
  add_cable(scene, "rope", 0.6, 12, {-0.3, 0, 0}, {0.3, 0, 0}, {"left", {0.1, 0, 0}, type}, {"right", {-0.1, 0, 0}, type});
  return scene;
}

void expect_momenta(const std::string& name, const SceneDesc& scene, double duration) {
  Simulation run(scene);
  const Momenta before = momenta_of(run.world);
  run.run(duration);
  const Momenta after = momenta_of(run.world);
  report(name + ": linear momentum", {{12, relative_change(after.linear, before.linear)}}, 1e-9, Order::none);
  report(name + ": angular momentum", {{12, relative_change(after.angular, before.angular)}}, 1e-9, Order::none);
}

TEST(TwoFreeBodies, OnAnElasticRopeKeepTheirMomenta) {
  SceneDesc scene = two_free_bodies(AttachmentType::hinge);
  rope(scene).axial_stiffness = 300;
  expect_momenta("two bodies on an elastic rope", scene, 10);
}

TEST(TwoFreeBodies, OnARodKeepTheirMomenta) {
  for (const double second : {1.0, 3.0}) {
    SceneDesc scene = two_free_bodies(AttachmentType::clamp);
    rope(scene).bending_stiffness = {0.1, second * 0.1};
    rope(scene).torsional_stiffness = 0.08;
    rope(scene).bending_damping = 1e-4;
    expect_momenta(second == 1 ? "two bodies on a rod" : "two bodies on a flat rod", scene, 10);
  }
}

/// A load that swings on a rope, hooked beside its center, so that it turns. Against steps that are eight times as fine as the
/// finest.
TEST(SwingingLoad, ConvergesWithTheSquareOfTheTimeStep) {
  const auto place_after = [](double axial_stiffness, double time_step) {
    SceneDesc scene = no_cables();
    scene.time_step = time_step;
    scene.numerical_damping = false;  // it begins at other times with other steps
    rope(scene).axial_stiffness = axial_stiffness;
    add_body(scene, "load", 1, {0.01, 0.02, 0.015}, {0.6, 0, 0, 0, 0, 0}).angular_velocity = {1, 0, 0};
    const Vector3 hook(0.5, 0.02, 0.03);
    add_cable(scene, "rope", hook.norm(), 3, {0, 0, 0}, hook, {}, {"load", {-0.1, 0.02, 0.03}});
    Simulation run(scene);
    run.run(0.8);
    return body_of(run, "load").pose.position;
  };
  for (const double axial_stiffness : {infinity, 200.0}) {
    const Vector3 fine = place_after(axial_stiffness, 0.001 / 64);
    const auto samples =
        sample({2, 4, 8}, [&](int n) { return (place_after(axial_stiffness, 0.001 / n) - fine).norm() / fine.norm(); });
    report(std::string("load swinging on ") + (axial_stiffness < infinity ? "an elastic" : "a") + " rope, against fine steps",
           samples, 1e-5, Order::second);
  }
}

}  // namespace
}  // namespace verlet_cable::validation
