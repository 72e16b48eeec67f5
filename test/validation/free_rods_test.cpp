#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "rods.h"
#include "validation.h"

/// Curved rods without gravity: what is free of stress stays where it is, what is thrown keeps its momenta and its energy.
namespace verlet_cable::validation {
namespace {

enum class Ends { free, clamped, clamped_at_both, clamped_inside };

struct RestCase {
  const char* name;
  bool helix;
  Ends ends;
  bool by_numbers;  ///< rest curvature and twist are numbers; otherwise they are those of the shape
};

class AtRest : public testing::TestWithParam<RestCase> {};

/// Three quarters of a circle of 0.1 m, or a turn and a half of a helix: the direction of its start is x.
Vector3 stress_free(bool helix, double arc_length) {
  constexpr double radius = 0.1;
  const double angle = arc_length / radius;
  if (!helix) return radius * Vector3(std::sin(angle), 1 - std::cos(angle), 0);
  return {radius * std::sin(0.8 * angle), radius * (1 - std::cos(0.8 * angle)), 0.6 * arc_length};
}

TEST_P(AtRest, StaysWhereItIs) {
  const auto& [name, helix, ends, by_numbers] = GetParam();
  constexpr int n = 30;
  const double length = (helix ? 3.0 : 1.5) * M_PI * 0.1;
  SceneDesc scene = scenes::one_cable(n, length);
  scene.time_step = 0.002;
  scene.gravity.acceleration.setZero();
  material(scene).bending_stiffness = {0.02, helix ? 0.01 : 0.02};
  material(scene).torsional_stiffness = 0.015;
  if (by_numbers) {
    bend_at_rest(scene, 0, helix ? 6.4 : 10);  // of the helix: cos^2 / radius', sin cos / radius'
    scene.cables[0].rest_twist = helix ? 4.8 : 0;
  } else {
    scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::initial;
  }
  // A clamp at an arc length, along the rod.
  std::vector<Pose> poses;
  const auto clamp_at = [&](double arc_length) {
    const double d = 1e-6;
    const Vector3 along = stress_free(helix, arc_length + d) - stress_free(helix, arc_length - d);
    const std::string name = "clamp" + std::to_string(poses.size());
    AttachmentDesc clamp = scenes::attachment(name, PlaceDesc::At::arc_length, Vector3::Zero(), name, AttachmentType::clamp);
    clamp.place.arc_length = arc_length;
    scene.cables[0].attachments.push_back(clamp);
    poses.push_back({stress_free(helix, arc_length), Quaternion::FromTwoVectors(Vector3::UnitX(), along)});
  };
  if (ends == Ends::clamped || ends == Ends::clamped_at_both) clamp_at(0);
  if (ends == Ends::clamped_at_both) clamp_at(length);
  if (ends == Ends::clamped_inside) clamp_at(length / 2);
  start_at(scene, [&](double s) { return stress_free(helix, s * length); });
  BoundaryInputs frames = initial_frames(scene);
  for (std::size_t i = 0; i < poses.size(); ++i) frames[i + 1] = {poses[i]};
  Simulation run(scene, frames);
  // Numbers are those of the smooth curve: the polygon's own rest is next to where it starts.
  if (by_numbers) {
    EXPECT_TRUE(run.world.settle());
  }
  const std::vector<Vector3> before = run.positions();
  double moved = 0;
  for (int second = 0; second < 20; ++second) {
    run.run(1);
    for (int i = 0; i <= n; ++i) moved = std::max(moved, (run.positions()[i] - before[i]).norm());
  }
  report(std::string("at rest for 20 s, ") + name, {{n, moved}}, 1e-9, Order::none);
  EXPECT_LT(run.world.energy().kinetic, 1e-15);
}

INSTANTIATE_TEST_SUITE_P(
    Shapes, AtRest,
    testing::Values(RestCase{"arc, free", false, Ends::free, false}, RestCase{"arc, clamped", false, Ends::clamped, false},
                    RestCase{"arc, clamped at both ends", false, Ends::clamped_at_both, false},
                    RestCase{"arc, clamped inside", false, Ends::clamped_inside, false},
                    RestCase{"arc by its curvature, clamped", false, Ends::clamped, true},
                    RestCase{"helix, free", true, Ends::free, false}, RestCase{"helix, clamped", true, Ends::clamped, false},
                    RestCase{"helix, clamped at both ends", true, Ends::clamped_at_both, false},
                    RestCase{"helix by its curvature and twist, clamped", true, Ends::clamped, true},
                    RestCase{"helix by its curvature and twist, clamped at both ends", true, Ends::clamped_at_both, true}));

struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

/// Of the nodes, and of the segments' spin: a section of radius r has r^2 / 2 of polar inertia a mass.
Momenta momenta(const Simulation& run) {
  Momenta sum;
  const MaterialDesc& material = run.cable().model->material;
  const CableState& state = run.cable().state;
  for (int i = 0; i < state.nodes(); ++i) {
    const Vector3 momentum = state.masses[i] * state.velocities[i];
    sum.linear += momentum;
    sum.angular += state.positions[i].cross(momentum);
  }
  const double polar_inertia = 0.5 * material.linear_density * material.radius * material.radius;
  for (std::size_t i = 0; i < state.spin.size(); ++i)
    sum.angular +=
        polar_inertia * state.rest_lengths[i] * state.spin[i] * (state.positions[i + 1] - state.positions[i]).normalized();
  return sum;
}

struct ThrownCase {
  const char* name;
  double axial_stiffness;
  bool numerical_damping;
  double damping;  ///< [N m^2 s] of bending and twist
};

class Thrown : public testing::TestWithParam<ThrownCase> {};

/// A flat rod, curved and twisted at rest, that is thrown, turns head over heels and swings as it flies. Damping inside it takes
/// its energy, and not its momenta.
TEST_P(Thrown, KeepsItsMomentaAndItsEnergy) {
  const ThrownCase& thrown = GetParam();
  constexpr int n = 40;
  SceneDesc scene = scenes::one_cable(n);
  scene.gravity.acceleration.setZero();
  scene.numerical_damping = thrown.numerical_damping;
  material(scene).axial_stiffness = thrown.axial_stiffness;
  material(scene).bending_stiffness = {0.01, 0.03};
  material(scene).torsional_stiffness = 0.0075;
  material(scene).bending_damping = material(scene).torsional_damping = thrown.damping;
  bend_at_rest(scene, 3, 2);
  scene.cables[0].rest_twist = 2;
  // Its shape at rest: with a clamp to find it.
  clamp_start(scene);
  start_at(scene, [](double s) { return Vector3(s, 0, 0); });
  Simulation held(scene);
  EXPECT_TRUE(held.world.settle());
  scene.cables[0].attachments.clear();
  scene.cables[0].initial.points = held.positions();
  Vector3 center = Vector3::Zero();
  for (const Vector3& p : held.positions()) center += p / (n + 1);
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n;
    scene.cables[0].initial.velocities.push_back(Vector3(0.5, -1, 2).cross(held.positions()[i] - center) + Vector3(0.1, 0, 0.2) +
                                                 0.2 * std::sin(M_PI * s) * Vector3(0, 1, 1));
  }
  Simulation run(scene);
  const Momenta before = momenta(run);
  const double energy = run.world.energy().total();
  run.run(10);
  const Momenta after = momenta(run);
  const std::string name = std::string("thrown rod, ") + thrown.name;
  report(name + ": linear momentum", {{n, (after.linear - before.linear).norm() / before.linear.norm()}}, 1e-9, Order::none);
  report(name + ": angular momentum", {{n, (after.angular - before.angular).norm() / before.angular.norm()}}, 1e-9, Order::none);
  if (thrown.damping == 0)
    report(name + ": energy", {{n, std::abs(run.world.energy().total() / energy - 1)}}, 1e-4, Order::none);
  else
    EXPECT_LT(run.world.energy().total(), 0.99 * energy);
}

INSTANTIATE_TEST_SUITE_P(Rods, Thrown,
                         testing::Values(ThrownCase{"inextensible", infinity, true, 0},
                                         ThrownCase{"inextensible, nothing damped", infinity, false, 0},
                                         ThrownCase{"elastic, nothing damped", 1e4, false, 0},
                                         ThrownCase{"inextensible, damped", infinity, true, 1e-4},
                                         ThrownCase{"elastic, damped", 1e4, true, 1e-4}));

/// A straight rod that is thrown bent, spins and swings, about two axes at once. `second`: of its bending stiffnesses, to the
/// first.
SceneDesc thrown_straight_rod(double second, double torsional_stiffness, double axial_stiffness) {
  constexpr int n = 40;
  SceneDesc scene = scenes::one_cable(n);
  scene.gravity.acceleration.setZero();
  material(scene).bending_stiffness = {0.01, second * 0.01};
  material(scene).torsional_stiffness = torsional_stiffness;
  material(scene).bending_damping = 1e-4;
  material(scene).axial_stiffness = axial_stiffness;
  InitialShapeDesc& initial = scene.cables[0].initial;
  initial.type = InitialShapeDesc::Type::points;
  for (int i = 0; i <= n; ++i) {
    const double s = static_cast<double>(i) / n, angle = 1.5 * (s - 0.5);
    initial.points.push_back({std::sin(angle) / 1.5, (1 - std::cos(angle)) / 1.5, 0.01 * std::sin(2 * M_PI * s)});
    initial.velocities.push_back(Vector3(6, -1, 2).cross(initial.points.back()) + Vector3(0.1, 0, 0.2) +
                                 0.2 * std::cos(3 * M_PI * s) * Vector3(0, 1, 1));
  }
  return scene;
}

TEST(ThrownStraight, DampingKeepsItsMomenta) {
  for (const double axial_stiffness : {infinity, 1e4}) {
    for (const double torsional_stiffness : {0.0, 0.0075}) {
      Simulation run(thrown_straight_rod(1, torsional_stiffness, axial_stiffness));
      const Momenta before = momenta(run);
      const double energy = run.world.energy().total();
      run.run(10);
      const Momenta after = momenta(run);
      const std::string name = std::string("thrown straight rod, damped") + (axial_stiffness < infinity ? ", elastic" : "") +
                               (torsional_stiffness > 0 ? "" : ", without torsional stiffness");
      report(name + ": linear momentum", {{40, (after.linear - before.linear).norm() / before.linear.norm()}}, 1e-9, Order::none);
      report(name + ": angular momentum", {{40, (after.angular - before.angular).norm() / before.angular.norm()}}, 1e-9,
             Order::none);
      EXPECT_LT(run.world.energy().total(), 0.99 * energy);
    }
  }
}

/// Damping acts in the material: the cheap law of straight rods loses as much as that of material frames does.
TEST(ThrownStraight, IsDampedLikeARodOfMaterialFrames) {
  Simulation straight(thrown_straight_rod(1, 0.0075, infinity)), whole(thrown_straight_rod(1 + 1e-12, 0.0075, infinity));
  const double energy = straight.world.energy().total();
  straight.run(3);
  whole.run(3);
  const double lost = energy - straight.world.energy().total();
  report("thrown straight rod: energy lost to damping, against a rod of material frames",
         {{40, std::abs(lost / (energy - whole.world.energy().total()) - 1)}}, 0.01, Order::none);
}

}  // namespace
}  // namespace verlet_cable::validation
