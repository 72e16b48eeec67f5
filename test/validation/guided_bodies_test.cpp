#include <cmath>

#include "bodies.h"

namespace verlet_cable::validation {
namespace {

GuideDesc& add_guide(SceneDesc& scene, const std::string& name, double at, const Vector3& offset) {
  GuideDesc& guide = scene.guides.emplace_back();
  guide.name = name;
  guide.cable = "rope";
  guide.place = PlaceDesc{PlaceDesc::At::arc_length, at};
  guide.offset = offset;
  return guide;
}

GuideDesc& add_sheave(SceneDesc& scene, const std::string& name, double at, const Vector3& offset, double radius) {
  GuideDesc& wheel = add_guide(scene, name, at, offset);
  wheel.type = GuideDesc::Type::sheave;
  wheel.rotation = {0.5 * M_PI, 0, 0};
  wheel.radius = radius;
  return wheel;
}

/// Two bodies on a rope over what is in the middle.
SceneDesc two_bodies(double m1, double m2, int segments) {
  SceneDesc scene = no_cables();
  scene.materials[0].material.linear_density = 0.01;
  for (const auto& [name, mass, x] : {std::tuple{"light", m1, -0.05}, {"heavy", m2, 0.05}})
    add_body(scene, name, mass, Vector3::Constant(1e-3), {x, 0, -1, 0, 0, 0});
  CableDesc& rope = add_cable(scene, "rope", 2 + 0.05 * M_PI, segments, {}, {}, {"light"}, {"heavy"});
  rope.initial.type = InitialShapeDesc::Type::automatic;
  return scene;
}

/// x'' = a + k^2 x from rest, as the rope's weight follows.
double way_of_atwood(double drive, double mass, double density, double time) {
  const double k = std::sqrt(2 * density * gravity / mass);
  return drive / mass / (k * k) * (std::cosh(k * time) - 1);
}

TEST(GuidedBodies, AtwoodsMachine) {
  constexpr double m1 = 1, m2 = 1.2, radius = 0.05, inertia = 1e-3, time = 0.4;
  const auto samples = sample({43, 86}, [&](int n) {
    SceneDesc scene = two_bodies(m1, m2, n);
    add_sheave(scene, "wheel", 0.5 * scene.cables[0].length, Vector3::Zero(), radius).inertia = inertia;
    Simulation run(scene);
    const double start = run.world.bodies()[1].pose.position.z(), energy = run.world.energy().total();
    run.run(time);
    const double mass = m1 + m2 + 0.01 * scene.cables[0].length + inertia / (radius * radius);
    const double way = way_of_atwood((m2 - m1) * gravity, mass, 0.01, time);
    EXPECT_NEAR(run.world.energy().total(), energy, 1e-5 * run.world.energy().kinetic);
    return std::abs((start - run.world.bodies()[1].pose.position.z()) / way - 1);
  });
  report("Atwood's machine of bodies, wheel with inertia", samples, 2e-3, Order::none);
}

}  // namespace
}  // namespace verlet_cable::validation
