#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "../support/nets.h"
#include "../support/scenes.h"
#include "body/rigid_body_stepper.h"
#include "fluid/waves.h"

// What water does to bodies: buoyancy, drag, added mass, current and waves.

namespace verlet_cable {
namespace {

constexpr double gravity = 9.81, density = 1000;

SceneDesc in_water() {
  SceneDesc scene = scenes::one_cable(1);
  scene.cables.clear();
  scene.fluid.density = density;
  scene.fluid.normal_drag = scene.fluid.tangential_drag = 0;
  MaterialDesc& rope = scene.materials[0].material;  // weighs nothing in water
  rope.linear_density = density * M_PI * rope.radius * rope.radius;
  return scene;
}

BodyDesc& add_body(SceneDesc& scene, double mass, double volume, const Vector3& place = Vector3::Zero()) {
  BodyDesc& body = scene.bodies.emplace_back();
  body.name = "body";
  body.mass = mass;
  body.inertia = mass * Vector3(0.04, 0.06, 0.07);
  body.pose = InitialPose{place.x(), place.y(), place.z(), 0, 0, 0};
  body.fluid.volume = volume;
  return body;
}

/// A tether from a point to the body.
CableDesc& add_tether(SceneDesc& scene, double length, const Vector3& from, const Vector3& on_body = Vector3::Zero()) {
  CableDesc& tether = scene.cables.emplace_back(scenes::one_cable(20, length).cables[0]);
  tether.attachments = {scenes::attachment("anchor", PlaceDesc::At::start, from),
                        scenes::attachment("shackle", PlaceDesc::At::end, on_body)};
  tether.attachments[1].body = "body";
  return tether;
}

/// Of no symmetry, spinning.
SceneDesc tumbling() {
  SceneDesc scene = in_water();
  scene.gravity.acceleration.setZero();
  scene.numerical_damping = false;
  scene.time_step = 0.005;
  scene.tolerance = 1e-6;
  BodyDesc& body = add_body(scene, 3, 0.003);
  body.center_of_mass = Vector3(0.05, -0.02, 0.03);
  body.fluid.center = {-0.04, 0.06, 0.02};
  body.fluid.added_mass = {1, 5, 2};
  body.velocity = {0.3, -0.2, 0.5};
  body.angular_velocity = {1, 2, -1.5};
  return scene;
}

const SimulatedBody& body_of(const World& world) {
  return world.bodies()[0];
}

/// Momentum with that of the water that moves with the body [N s], and its moment about the origin [N m s].
std::array<Vector3, 2> momenta_of(const SimulatedBody& body) {
  const Eigen::Matrix3d axes = body.pose.orientation.toRotationMatrix();
  const Vector3 center = (body.pose * Pose{body.center_of_mass}).position, place = (body.pose * Pose{body.fluid.center}).position;
  const Vector3 velocity = body.velocity + body.angular_velocity.cross(place - center);
  const Vector3 added = axes * body.fluid.added_mass.cwiseProduct(axes.transpose() * velocity);
  const Vector3 spin = axes * (body.inertia * (axes.transpose() * body.angular_velocity));
  return {body.mass * body.velocity + added, center.cross(body.mass * body.velocity) + spin + place.cross(added)};
}

TEST(BodyInWater, BeginsToRiseWithItsAddedMass) {
  SceneDesc scene = in_water();
  BodyDesc& body = add_body(scene, 5, 0.02);
  body.fluid.added_mass = Vector3::Constant(10);
  World world(scene, initial_frames(scene));
  scenes::run(world, 1);
  const double exact = (density * 0.02 - 5) * gravity / (5 + 10);
  EXPECT_NEAR(body_of(world).velocity.z() / (scene.time_step * exact), 1, 1e-9);
  EXPECT_NEAR(body_of(world).pose.position.z() / (0.5 * scene.time_step * scene.time_step * exact), 1, 1e-9);
}

/// Along each axis of a body that is turned.
TEST(BodyInWater, SinksAtItsTerminalVelocity) {
  for (int axis = 0; axis < 3; ++axis) {
    SceneDesc scene = in_water();
    scene.time_step = 0.01;
    BodyDesc& body = add_body(scene, 30, 0.02);
    body.fluid.drag_area = {0.1, 0.2, 0.3};
    body.fluid.added_mass = {10, 10, 10};
    body.pose = InitialPose{0, 0, 0, axis == 1 ? M_PI / 2 : 0, axis == 0 ? M_PI / 2 : 0, 0};
    World world(scene, initial_frames(scene));
    scenes::run(world, 2000);
    const double exact = std::sqrt(2 * (30 - density * 0.02) * gravity / (density * body.fluid.drag_area[axis]));
    EXPECT_NEAR(-body_of(world).velocity.z() / exact, 1, 1e-6) << axis;
  }
}

/// Of what is alike along all axes, however it is turned.
TEST(BodyInWater, FeelsTheSameDragInAnyPose) {
  std::vector<Vector3> velocities, spins;
  for (const InitialPose& pose : {InitialPose{0, 0, 0, 0, 0, 0}, InitialPose{0, 0, 0, 0.5, 0.7, 1.1}}) {
    SceneDesc scene = in_water();
    BodyDesc& body = add_body(scene, 30, 0.02);
    body.inertia = Vector3::Constant(0.5);
    body.fluid.drag_area = Vector3::Constant(0.1);
    body.fluid.angular_drag = Vector3::Constant(0.3);
    body.velocity = {1, -2, 0.5};
    body.angular_velocity = {2, 1, -3};
    body.pose = pose;
    World world(scene, initial_frames(scene));
    scenes::run(world, 300);
    velocities.push_back(body_of(world).velocity);
    spins.push_back(body_of(world).angular_velocity);
  }
  EXPECT_LT((velocities[0] - velocities[1]).norm(), 1e-9);
  EXPECT_LT((spins[0] - spins[1]).norm(), 1e-9);
}

/// v = V tanh(a t / V).
TEST(BodyInWater, IsOfSecondOrderInTheStep) {
  constexpr double mass = 30, volume = 0.02, added = 10, area = 0.1, time = 0.8;
  const auto error = [&](int refinement) {
    SceneDesc scene = in_water();
    scene.time_step = 0.04 / refinement;
    scene.tolerance = 1e-6;
    BodyDesc& body = add_body(scene, mass, volume);
    body.fluid.added_mass = Vector3::Constant(added);
    body.fluid.drag_area = Vector3::Constant(area);
    World world(scene, initial_frames(scene));
    scenes::run(world, 20 * refinement);
    const double force = (mass - density * volume) * gravity, fastest = std::sqrt(2 * force / (density * area));
    return std::abs(-body_of(world).velocity.z() - fastest * std::tanh(force / (mass + added) * time / fastest));
  };
  EXPECT_NEAR(error(1) / error(2), 4, 0.2);
  EXPECT_NEAR(error(2) / error(4), 4, 0.1);
}

/// dw/dt = -c w |w| / J.
TEST(BodyInWater, IsSlowedByAngularDrag) {
  SceneDesc scene = in_water();
  BodyDesc& body = add_body(scene, 10, 0.01);
  body.fluid.angular_drag = {0, 0, 0.3};
  body.angular_velocity = {0, 0, 4};
  World world(scene, initial_frames(scene));
  scenes::run(world, 2000);
  const double inertia = body.inertia->z();
  EXPECT_NEAR(body_of(world).angular_velocity.z(), 4 / (1 + 0.3 / inertia * 4 * 2), 1e-6);
  EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-9);
  EXPECT_NEAR(world.ledger().balance.dissipated.drag, 0.5 * inertia * (16 - std::pow(body_of(world).angular_velocity.z(), 2)),
              1e-9);
}

TEST(AddedMass, KeepsEnergyAndMomentaInStillWater) {
  const SceneDesc scene = tumbling();
  World world(scene, initial_frames(scene));
  const double energy = world.energy().total();
  const auto before = momenta_of(body_of(world));
  double furthest = 0;
  for (int i = 0; i < 4000; ++i) {
    scenes::run(world, 1);
    furthest = std::max(furthest, std::abs(world.energy().total() / energy - 1));
  }
  const auto after = momenta_of(body_of(world));
  EXPECT_LT(furthest, 1e-9);
  EXPECT_LT((after[0] - before[0]).norm() / before[0].norm(), 1e-9);
  EXPECT_LT((after[1] - before[1]).norm() / before[1].norm(), 1e-9);
}

TEST(AddedMass, IsOfSecondOrderInTheStep) {
  const auto end = [](int refinement) {
    SceneDesc scene = tumbling();
    scene.time_step /= refinement;
    World world(scene, initial_frames(scene));
    scenes::run(world, 400 * refinement);
    return body_of(world).pose.position;
  };
  const Vector3 coarse = end(1), middle = end(2), fine = end(4);
  EXPECT_GT((coarse - middle).norm(), 1e-7);
  EXPECT_NEAR((coarse - middle).norm() / (middle - fine).norm(), 4, 0.2);
}

/// Turning long bodies broadside is what added mass does (Munk 1924): against Euler's equations of Kirchhoff's momenta, for small
/// angles, angle'' = (b - a) v^2 angle / J, if the body glides along its axis of less added mass a.
TEST(AddedMass, TurnsWhatGlidesBroadside) {
  SceneDesc scene = in_water();
  scene.gravity.acceleration.setZero();
  scene.numerical_damping = false;
  BodyDesc& body = add_body(scene, 10, 0.01);
  body.fluid.added_mass = {1, 6, 6};
  body.velocity = {1, 0, 0};
  body.angular_velocity = {0, 0, 1e-5};
  World world(scene, initial_frames(scene));
  constexpr int steps = 1000;
  scenes::run(world, steps);
  // The direction of the momentum stays: the velocity across follows the angle, v y-wards = -(b - a) / (m + b) v angle.
  const double stiffness = 5.0 * (10 + 1) / (10 + 6), rate = std::sqrt(stiffness / body.inertia->z()),
               time = steps * scene.time_step;
  EXPECT_NEAR(body_of(world).angular_velocity.z() / (1e-5 * std::cosh(rate * time)), 1, 1e-4);
}

/// A current carries it all along: nothing else is different.
TEST(AddedMass, KnowsOnlyTheWaterAroundIt) {
  SceneDesc scene = tumbling();
  scene.bodies[0].fluid.drag_area = {0.001, 0.002, 0.003};
  scene.bodies[0].fluid.angular_drag = {0.001, 0, 0.002};
  World still(scene, initial_frames(scene));
  const Vector3 current(0.7, -0.4, 0.2);
  scene.fluid.velocity = current;
  scene.bodies[0].velocity += current;
  World carried(scene, initial_frames(scene));
  scenes::run(still, 1000);
  scenes::run(carried, 1000);
  EXPECT_LT((body_of(carried).pose.position - body_of(still).pose.position - carried.time() * current).norm(), 1e-8);
  EXPECT_LT((body_of(carried).velocity - body_of(still).velocity - current).norm(), 1e-8);
  EXPECT_NEAR(carried.ledger().unaccounted(), 0, 1e-9);
}

/// Its potential is that of the part of a sphere below the surface: with the kinetic energy the sum stays, in and out of water.
TEST(Buoyancy, HasAPotential) {
  constexpr double radius = 0.3, volume = 4.0 / 3 * M_PI * radius * radius * radius, mass = 0.5 * density * volume;
  SceneDesc scene = in_water();
  scene.fluid.surface = 0;
  scene.time_step = 0.005;
  scene.numerical_damping = false;
  scene.tolerance = 1e-6;
  BodyDesc& body = add_body(scene, mass, volume, {0, 0, 0.28});
  body.fluid.added_mass = Vector3::Constant(0.25 * density * volume);
  World world(scene, initial_frames(scene));
  // The work of lifting what it displaces: the integral over depth of the cap's volume.
  const auto potential = [&](double z) {
    const double h = std::clamp(radius - z, 0.0, 2 * radius);
    return density * gravity * M_PI / 3 * (radius * h * h * h - 0.25 * h * h * h * h) +
           density * gravity * volume * std::max(0.0, -z - radius);
  };
  const double whole = world.energy().total() + potential(0.28);
  double lowest = 0, furthest = 0;
  for (int i = 0; i < 4000; ++i) {
    scenes::run(world, 1);
    const double z = body_of(world).pose.position.z();
    lowest = std::min(lowest, z);
    furthest = std::max(furthest, std::abs(world.energy().total() + potential(z) - whole));
  }
  EXPECT_LT(lowest, -0.2);
  EXPECT_LT(furthest / whole, 1e-8);
  EXPECT_NEAR(world.ledger().unaccounted() / whole, 0, 1e-9);
}

/// w^2 = density g pi r^2 / (m + added mass), for small heave.
TEST(Buoyancy, LetsASphereHeaveAtItsFrequency) {
  constexpr double radius = 0.4, volume = 4.0 / 3 * M_PI * radius * radius * radius, mass = 0.5 * density * volume,
                   added = 0.5 * mass;
  SceneDesc scene = in_water();
  scene.fluid.surface = 1.5;
  BodyDesc& body = add_body(scene, mass, volume, {0, 0, 1.5 + 1e-4});
  body.fluid.added_mass = Vector3::Constant(added);
  World world(scene, initial_frames(scene));
  const double frequency = std::sqrt(density * gravity * M_PI * radius * radius / (mass + added));
  double largest = 0;
  for (int i = 0; i < 5000; ++i) {
    scenes::run(world, 1);
    largest = std::max(largest, std::abs(body_of(world).pose.position.z() - 1.5 - 1e-4 * std::cos(frequency * world.time())));
  }
  EXPECT_LT(largest, 1e-6);
}

/// A small floating body moves with the surface of a long wave: buoyancy, the water's acceleration on what it displaces and on
/// its added mass are to those of the surface what its own are to its motion.
TEST(Buoyancy, CarriesABuoyOnALongWave) {
  constexpr double radius = 0.3, volume = 4.0 / 3 * M_PI * radius * radius * radius, mass = 0.5 * density * volume,
                   amplitude = 0.5, period = 9;
  SceneDesc scene = in_water();
  scene.fluid.surface = 0;
  scene.fluid.waves = {{amplitude, period, 0, 0}};
  scene.time_step = 0.01;
  BodyDesc& body = add_body(scene, mass, volume, {0, 0, amplitude});
  body.fluid.added_mass = Vector3::Constant(0.5 * mass);
  body.velocity = {2 * M_PI / period * amplitude, 0, 0};
  World world(scene, initial_frames(scene));
  double highest = -1, lowest = 1, behind = 0;
  for (int i = 0; i < 4500; ++i) {
    scenes::run(world, 1);
    const Vector3& place = body_of(world).pose.position;
    const double k = std::pow(2 * M_PI / period, 2) / gravity;
    behind = std::max(behind, std::abs(place.z() - amplitude * std::cos(k * place.x() - 2 * M_PI / period * world.time())));
    highest = std::max(highest, place.z());
    lowest = std::min(lowest, place.z());
  }
  EXPECT_NEAR(0.5 * (highest - lowest) / amplitude, 1, 0.01);
  EXPECT_LT(behind, 0.02 * amplitude);
}

/// It moves as the water does, and drifts with it: at any depth, in a current, whatever water moves with it.
TEST(BodyInWater, ThatWeighsNothingThereGoesWithTheWaves) {
  for (const double current : {0.0, 0.7}) {
    for (const double added : {0.0, 5.0}) {
      SceneDesc scene = in_water();
      scene.fluid.surface = 0;
      scene.fluid.velocity = {current, 0, 0};
      scene.fluid.waves = {WaveDesc{0.5, 5, 0.3, 0.2}};
      scene.time_step = 0.01;
      BodyDesc& body = add_body(scene, 10, 10 / density);
      body.fluid.added_mass = Vector3::Constant(added);
      body.pose = InitialPose{0, 0, -3, 0, 0, 0};
      const std::vector<Wave> waves = waves_of(scene);
      Vector3 x(0, 0, -3);
      const auto flow = [&](const Vector3& place, double t) { return water_at(scene.fluid, waves, place, t).velocity; };
      body.velocity = flow(x, 0);
      World world(scene, initial_frames(scene));
      for (int i = 0; i < 2000; ++i) {
        const double h = scene.time_step, t = i * h;
        const Vector3 a = flow(x, t), b = flow(x + h / 2 * a, t + h / 2), c = flow(x + h / 2 * b, t + h / 2),
                      d = flow(x + h * c, t + h);
        x += h / 6 * (a + 2 * b + 2 * c + d);
        world.step(initial_frames(scene));
      }
      EXPECT_LT((body_of(world).pose.position - x).norm(), 5e-3) << current << " " << added;
    }
  }
}

/// Fully below the surface and without drag, a neutral body of any added mass goes with the water.
TEST(BodyInWaves, GoesWithTheWaterWhereItWeighsNothing) {
  SceneDesc scene = in_water();
  scene.fluid.surface = 0;
  scene.fluid.depth = 20;
  scene.fluid.waves = {{1e-3, 4, 0.5, 0.2}};  // small: what convection makes is left out
  BodyDesc& body = add_body(scene, density * 0.02, 0.02, {0, 0, -3});
  body.fluid.added_mass = Vector3::Constant(35);
  World first(scene, initial_frames(scene));
  const double w = 2 * M_PI / 4;
  double k = w * w / gravity;
  for (int i = 0; i < 100; ++i) k = w * w / (gravity * std::tanh(20 * k));
  const auto velocity = [&](double t) {
    const double c = std::cosh(17 * k) / std::sinh(20 * k), s = std::sinh(17 * k) / std::sinh(20 * k), angle = 0.2 - w * t;
    return Vector3(1e-3 * w *
                   Vector3(std::cos(0.5) * c * std::cos(angle), std::sin(0.5) * c * std::cos(angle), s * std::sin(angle)));
  };
  scene.bodies[0].velocity = velocity(0);
  World world(scene, initial_frames(scene));
  double furthest = 0;
  for (int i = 0; i < 6000; ++i) {
    scenes::run(world, 1);
    furthest = std::max(furthest, (body_of(world).velocity - velocity(world.time())).norm());
  }
  EXPECT_LT(furthest / velocity(0).norm(), 5e-3);
}

TEST(BodyInWaves, ClosesTheLedger) {
  for (const bool damping : {false, true}) {
    SceneDesc scene = in_water();
    scene.fluid.surface = 0;
    scene.fluid.velocity = {0.3, 0.1, 0};
    scene.fluid.waves = {{0.4, 4, 0.3, 0}, {0.1, 2, -1, 1}};
    scene.numerical_damping = damping;
    scene.tolerance = 1e-6;
    scene.time_step = 0.005;
    scene.materials[0].material.axial_stiffness = 1e4;
    BodyDesc& body = add_body(scene, 20, 0.05, {0, 0, 0.1});
    body.fluid.center = {0, 0.02, 0.1};
    body.fluid.drag_area = {0.05, 0.1, 0.1};
    body.fluid.angular_drag = {1, 1, 1};
    body.fluid.added_mass = {5, 15, 25};
    add_tether(scene, 4, {0, 0, -4}, {0, 0, -0.1});
    World world(scene, initial_frames(scene));
    double largest = 0;
    for (int i = 0; i < 4000; ++i) {
      ASSERT_EQ(world.step(initial_frames(scene)).status, StepResult::Status::ok) << i;
      largest = std::max(largest, std::abs(world.ledger().unaccounted()));
    }
    const Ledger ledger = world.ledger();
    EXPECT_GT(ledger.balance.dissipated.drag, 1);
    EXPECT_LT(largest, 1e-9 * ledger.balance.dissipated.drag) << damping;
    EXPECT_EQ(ledger.unaccounted_steps, 0);
  }
}

SceneDesc buoys_in_waves(int count) {
  SceneDesc scene = in_water();
  scene.fluid.surface = 0;
  scene.fluid.waves = {{0.4, 4, 0.3, 0}};
  scene.time_step = 0.005;
  const SceneDesc one = [&] {
    SceneDesc first = scene;
    BodyDesc& body = add_body(first, 20, 0.05, {0, 0, 0});
    body.fluid.drag_area = {0.05, 0.1, 0.1};
    body.fluid.added_mass = {5, 15, 25};
    body.shapes.emplace_back().type = ShapeType::sphere;
    body.shapes.back().radius = 0.2;
    add_tether(first, 3.8, {0, 0, -4}, {0, 0, -0.2});
    return first;
  }();
  for (int i = 0; i < count; ++i) {
    const std::string suffix = std::to_string(i);
    BodyDesc& body = scene.bodies.emplace_back(one.bodies[0]);
    body.name += suffix;
    (*body.pose)[0] = i;
    CableDesc& tether = scene.cables.emplace_back(one.cables[0]);
    tether.name += suffix;
    for (AttachmentDesc& attachment : tether.attachments) attachment.name += suffix;
    tether.attachments[0].offset.x() = i;
    tether.attachments[1].body = body.name;
  }
  return scene;
}

TEST(BodyInWaves, IsTheSameOnAnyPath) {
  const SceneDesc scene = buoys_in_waves(60), alone = buoys_in_waves(1);
  World all(scene, initial_frames(scene)), one_by_one = all, copied = all, single(alone, initial_frames(alone));
  one_by_one.step_one_by_one(true);
  for (int i = 0; i < 60; ++i) {
    for (World* world : {&all, &one_by_one, &copied, &single}) scenes::run(*world, 1);
    if (i == 30) copied = World(all);
  }
  EXPECT_EQ(all.hash(), one_by_one.hash());
  EXPECT_EQ(all.hash(), copied.hash());
  EXPECT_EQ(all.bodies()[0].pose.position, single.bodies()[0].pose.position);
  EXPECT_EQ(all.bodies()[0].angular_velocity, single.bodies()[0].angular_velocity);
}

TEST(BodyInWaves, IsHashed) {
  SceneDesc scene = buoys_in_waves(1);
  const std::uint64_t hash = World(scene, initial_frames(scene)).hash();
  for (double* number : {&scene.bodies[0].fluid.volume, &scene.bodies[0].fluid.center.y(), &scene.bodies[0].fluid.drag_area.x(),
                         &scene.bodies[0].fluid.angular_drag.x(), &scene.bodies[0].fluid.added_mass.x(),
                         &scene.fluid.waves[0].amplitude, &scene.fluid.waves[0].phase}) {
    const double before = *number;
    *number += 1e-3;
    EXPECT_NE(World(scene, initial_frames(scene)).hash(), hash);
    *number = before;
  }
}

/// tan(angle) = drag / weight in water, at any place of a tether that weighs nothing and has no drag.
TEST(TowedFish, TrailsAtTheAngleOfItsDrag) {
  constexpr double speed = 1.2, area = 0.05, length = 10;
  SceneDesc scene = in_water();
  scene.fluid.velocity = {speed, 0, 0};
  BodyDesc& fish = add_body(scene, 30, 0.02);
  fish.pose.reset();
  fish.fluid.drag_area = Vector3::Constant(area);
  fish.fluid.added_mass = Vector3::Constant(10);
  add_tether(scene, length, {0, 0, 0});
  World world(scene, initial_frames(scene));
  EXPECT_NEAR(body_of(world).pose.position.z(), -length, 1e-9);
  ASSERT_TRUE(world.settle());
  const double drag = 0.5 * density * area * speed * speed, weight = (30 - density * 0.02) * gravity;
  const Vector3& place = body_of(world).pose.position;
  EXPECT_NEAR(std::atan2(place.x(), -place.z()), std::atan2(drag, weight), 1e-6);
  EXPECT_NEAR(world.attachments()[0].force.norm(), std::hypot(drag, weight), 1e-3);
  scenes::run(world, 200);
  EXPECT_LT(body_of(world).velocity.norm(), 1e-5);
}

/// Towed by its nose, with a center of its own for mass and for what the water does: it pitches by its weight, drag and Munk
/// moment.
TEST(TowedFish, StaysAsItIsSettled) {
  SceneDesc scene = in_water();
  scene.fluid.velocity = {1.2, 0, 0};
  scene.time_step = 0.005;
  BodyDesc& fish = add_body(scene, 30, 0.02);
  fish.pose.reset();
  fish.center_of_mass = Vector3(0, 0, -0.05);
  fish.fluid.center = {0.1, 0, 0.02};
  fish.fluid.drag_area = {0.02, 0.15, 0.2};
  fish.fluid.angular_drag = {5, 5, 5};
  fish.fluid.added_mass = {2, 20, 20};
  add_tether(scene, 10, Vector3::Zero(), {-0.4, 0, 0.1});
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.settle());
  const Pose settled = body_of(world).pose;
  EXPECT_GT(settled.orientation.y(), 0.1);
  scenes::run(world, 2000);
  EXPECT_LT((body_of(world).pose.position - settled.position).norm(), 1e-6);
  EXPECT_LT(body_of(world).pose.orientation.angularDistance(settled.orientation), 1e-6);
  EXPECT_LT(body_of(world).angular_velocity.norm(), 1e-6);
}

/// On a slack tether, in a current, with the tether tight at last: half below the surface.
TEST(MooredBuoy, SettlesAtTheSurface) {
  SceneDesc scene = in_water();
  scene.fluid.surface = 0;
  scene.fluid.velocity = {0.5, 0, 0};
  BodyDesc& buoy = add_body(scene, 40, 0.1, {1, 0, 0.2});
  buoy.fluid.drag_area = {0.2, 0.2, 0.2};
  buoy.fluid.added_mass = {50, 50, 50};
  buoy.fluid.center = {0, 0, 0.05};
  add_tether(scene, 6, {0, 0, -5}, {0, 0, -0.3});
  scene.cables[0].initial.type = InitialShapeDesc::Type::settled;
  World world(scene, initial_frames(scene));
  EXPECT_TRUE(world.findings().unsettled.empty());
  const Vector3 settled = body_of(world).pose.position;
  EXPECT_LT(std::abs(settled.z()), 0.1);
  scenes::run(world, 5000);
  EXPECT_LT((body_of(world).pose.position - settled).norm(), 1e-6);
}

/// It starts above its anchor, and settles to where drag and buoyancy pull along the tether, which holds it in its middle: its
/// axes stay.
TEST(MooredBuoy, StandsOnItsWatchCircle) {
  constexpr double speed = 0.8, area = 0.2, length = 15, depth = 20;
  SceneDesc scene = in_water();
  scene.fluid.surface = 0;
  BodyDesc& buoy = add_body(scene, 40, 0.1);
  buoy.pose.reset();
  buoy.fluid.drag_area = Vector3::Constant(area);
  buoy.fluid.added_mass = Vector3::Constant(50);
  add_tether(scene, length, {0, 0, -depth}, {0, 0, -0.3});
  World still(scene, initial_frames(scene));
  EXPECT_NEAR(body_of(still).pose.position.z(), -depth + length + 0.3, 1e-9);
  scenes::run(still, 100);
  EXPECT_LT(body_of(still).velocity.norm(), 1e-6);
  scene.fluid.velocity = {speed, 0, 0};
  scene.cables[0].attachments[1].offset.setZero();
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.settle());
  const double drag = 0.5 * density * area * speed * speed, lift = (density * 0.1 - 40) * gravity, angle = std::atan2(drag, lift);
  const Vector3& place = body_of(world).pose.position;
  EXPECT_NEAR(place.x() / (length * std::sin(angle)), 1, 1e-6);
  EXPECT_NEAR((place.z() + depth) / (length * std::cos(angle)), 1, 1e-6);
}

TEST(MooredBuoy, StartsUprightOnSeveralTethers) {
  SceneDesc scene = in_water();
  scene.fluid.surface = 0;
  BodyDesc& buoy = add_body(scene, 40, 0.1);
  buoy.pose.reset();
  for (int i = 0; i < 3; ++i) {
    CableDesc& tether = add_tether(scene, 6, {4 * std::cos(2.1 * i), 4 * std::sin(2.1 * i), -20}, {0, 0, -0.3});
    tether.name += std::to_string(i);
    for (AttachmentDesc& attachment : tether.attachments) attachment.name += std::to_string(i);
  }
  World world(scene, initial_frames(scene));
  const double height = body_of(world).pose.position.z();
  EXPECT_NEAR(height, -20 + std::sqrt(36 - 16) + 0.3, 0.1);
  scenes::run(world, 500);
  EXPECT_NEAR(body_of(world).pose.position.z(), height, 0.02);
}

/// A buoy on a short tether is a pendulum upside down: w^2 = (density volume - m) g / ((m + added mass) length).
TEST(MooredBuoy, SwingsWithItsAddedMass) {
  constexpr double mass = 40, volume = 0.1, added = 50, length = 5;
  SceneDesc scene = in_water();
  scene.time_step = 0.005;
  BodyDesc& buoy = add_body(scene, mass, volume, {length * std::sin(0.01), 0, length * std::cos(0.01)});
  buoy.fluid.added_mass = Vector3::Constant(added);
  scene.materials[0].material.radius *= 0.1;  // hardly any mass, too
  scene.materials[0].material.linear_density *= 0.01;
  CableDesc& tether = add_tether(scene, length, {0, 0, 0});
  tether.segments = 1;
  World world(scene, initial_frames(scene));
  const double frequency = std::sqrt((density * volume - mass) * gravity / ((mass + added) * length));
  for (int i = 0; i < 4000; ++i) scenes::run(world, 1);
  EXPECT_NEAR(body_of(world).pose.position.x(), length * std::sin(0.01) * std::cos(frequency * world.time()), 5e-5);
}

/// What Newton's method goes by is what the loads change by.
TEST(BodyInWater, ResistsAsItsLoadsChange) {
  SceneDesc scene = tumbling();
  scene.gravity.acceleration = {0, 0, -gravity};
  scene.fluid.surface = 0.05;
  scene.fluid.velocity = {0.8, -0.3, 0.1};
  scene.bodies[0].fluid.drag_area = {0.02, 0.05, 0.03};
  scene.bodies[0].fluid.angular_drag = {0.02, 0.01, 0.03};
  World world(scene, initial_frames(scene));
  const SimulatedBody& body = body_of(world);
  const Environment environment{scene.gravity, scene.fluid, no_waves};
  BodyProgress progress;
  progress.acceleration = {0.1, 0.5, -1};
  progress.angular_acceleration = {1, -0.4, 0.7};
  for (const auto& [statics, scheme] : {std::pair(false, Scheme::conserving), std::pair(false, Scheme::dissipative),
                                        std::pair(false, Scheme::damped), std::pair(true, Scheme::conserving)}) {
    RigidBodyStepper stepper;
    const double h = statics ? 0.5 : 0.01;
    stepper.begin(body, progress, {body.mass, body.center_of_mass, body.inertia}, environment, {h, statics, scheme});
    const Matrix6 stiffness = stepper.stiffness();
    Matrix6 found;
    for (int k = 0; k < 6; ++k) {
      constexpr double way = 1e-6;
      RigidBodyStepper before = stepper, after = stepper;
      before.correct(-way * Vector6::Unit(k));
      after.correct(way * Vector6::Unit(k));
      found.col(k) = (before.load() - after.load()) / (2 * way);
    }
    EXPECT_LT((stiffness - found).norm() / found.norm(), 1e-3) << statics << static_cast<int>(scheme) << "\n"
                                                               << stiffness << "\n\n"
                                                               << found;
  }
}

}  // namespace
}  // namespace verlet_cable
