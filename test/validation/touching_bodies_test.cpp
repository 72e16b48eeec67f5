#include <gtest/gtest.h>

#include <cmath>

#include "bodies.h"
#include "validation.h"

/// Bodies' shapes touch obstacles and cables.
namespace verlet_cable::validation {
namespace {

ShapeDesc shape(ShapeType type) {
  ShapeDesc desc;
  desc.type = type;
  return desc;
}

ShapeDesc box(const Vector3& size) {
  ShapeDesc desc = shape(ShapeType::box);
  desc.size = size;
  return desc;
}

ShapeDesc sphere(double radius) {
  ShapeDesc desc = shape(ShapeType::sphere);
  desc.radius = radius;
  return desc;
}

ShapeDesc cylinder(double radius, double length) {
  ShapeDesc desc = shape(ShapeType::cylinder);
  desc.radius = radius;
  desc.length = length;
  return desc;
}

/// Its inertia is that of the shape.
BodyDesc& add_solid(SceneDesc& scene, const std::string& name, double mass, const ShapeDesc& solid, const InitialPose& pose) {
  BodyDesc& body = scene.bodies.emplace_back();
  body.name = name;
  body.mass = mass;
  body.pose = pose;
  body.shapes = {solid};
  return body;
}

/// Through the origin, falling along +x.
void add_incline(SceneDesc& scene, double angle, double friction) {
  ObstacleDesc plane;
  plane.name = "incline";
  plane.type = ShapeType::plane;
  plane.pose = {0, 0, 0, 0, angle, 0};
  plane.friction = friction;
  scene.obstacles.push_back(plane);
}

InitialPose above_incline(double angle, double height) {
  return {height * std::sin(angle), 0, height * std::cos(angle), 0, angle, 0};
}

double speed_down(const Simulation& run, double angle) {
  return run.world.bodies()[0].velocity.dot(Vector3(std::cos(angle), 0, -std::sin(angle)));
}

TEST(TouchingBodies, BoxRestsWithoutCreeping) {
  for (const double angle : {0.0, 0.3}) {
    SceneDesc scene = no_cables();
    add_incline(scene, angle, 0.5);
    add_solid(scene, "box", 1, box({0.2, 0.1, 0.06}), above_incline(angle, 0.032));
    Simulation run(scene);
    run.run(1);
    const Vector3 place = body_of(run, "box").pose.position;
    run.run(5);
    const SimulatedBody& body = body_of(run, "box");
    EXPECT_LT(body.velocity.norm(), 1e-6) << angle;
    EXPECT_LT(body.angular_velocity.norm(), 1e-5) << angle;
    EXPECT_LT((body.pose.position - place).norm(), 1e-7) << angle;
    EXPECT_NEAR(body.pose.position.dot(Vector3(std::sin(angle), 0, std::cos(angle))), 0.03, 2e-5) << angle;
  }
}

/// Down an incline that is steeper than friction holds; without sliding below that.
TEST(TouchingBodies, BoxSlidesWithTheFrictionOfCoulomb) {
  const double friction = 0.3, angle = 0.5;
  SceneDesc scene = no_cables();
  add_incline(scene, angle, friction);
  add_solid(scene, "box", 1, box({0.2, 0.1, 0.02}), above_incline(angle, 0.01));
  Simulation run(scene);
  run.run(0.1);
  const double before = speed_down(run, angle);
  run.run(0.5);
  const double expected = gravity * (std::sin(angle) - friction * std::cos(angle));
  report("box slides down an incline: acceleration", {{1, std::abs((speed_down(run, angle) - before) / 0.5 / expected - 1)}},
         1e-3, Order::none);
}

TEST(TouchingBodies, BoxIsSlowedDownByFriction) {
  const double friction = 0.4;
  SceneDesc scene = no_cables();
  add_incline(scene, 0, friction);
  add_solid(scene, "box", 1, box({0.2, 0.2, 0.02}), above_incline(0, 0.01)).velocity = {3, 0, 0};
  Simulation run(scene);
  run.run(0.1);
  const double before = speed_down(run, 0);
  run.run(0.4);
  report("box slides to rest: deceleration", {{1, std::abs((before - speed_down(run, 0)) / 0.4 / (friction * gravity) - 1)}},
         1e-3, Order::none);
  run.run(1);
  EXPECT_LT(speed_down(run, 0), 1e-6);
}

TEST(TouchingBodies, SphereAndCylinderRollDownAnIncline) {
  const double angle = 0.3;
  struct Case {
    std::string name;
    ShapeDesc solid;
    InitialPose pose;
    double part;
  };
  InitialPose lying = above_incline(angle, 0.05);
  const InitialPose upright = lying;
  lying[3] = M_PI / 2;
  lying[4] = 0;
  for (const Case& c : {Case{"sphere", sphere(0.05), upright, 5.0 / 7}, Case{"cylinder", cylinder(0.05, 0.2), lying, 2.0 / 3}}) {
    SceneDesc scene = no_cables();
    add_incline(scene, angle, 0.8);
    add_solid(scene, "body", 1, c.solid, c.pose);
    Simulation run(scene);
    run.run(0.1);
    const double before = speed_down(run, angle);
    run.run(0.5);
    const double expected = c.part * gravity * std::sin(angle);
    report(c.name + " rolls down an incline: acceleration",
           {{1, std::abs((speed_down(run, angle) - before) / 0.5 / expected - 1)}}, 5e-3, Order::none);
  }
}

/// A tall box on an incline stands while its center is above its foot.
TEST(TouchingBodies, TallBoxTipsWhereItShould) {
  const double width = 0.1, height = 0.3;
  for (const double part : {0.99, 1.01}) {
    const double angle = std::atan(part * width / height);
    SceneDesc scene = no_cables();
    add_incline(scene, angle, 2);
    add_solid(scene, "box", 1, box({width, width, height}), above_incline(angle, 0.5 * height));
    Simulation run(scene);
    run.run(3);
    const Vector3 up = body_of(run, "box").pose.orientation * Vector3::UnitZ();
    const double turned = std::acos(up.dot(Vector3(std::sin(angle), 0, std::cos(angle))));
    EXPECT_EQ(turned > 0.5, part > 1) << part << " " << turned;
  }
}

/// In one system, so that none of it is lost: a cable strikes a sphere that is free.
TEST(TouchingBodies, CableThatStrikesASphereKeepsMomenta) {
  for (const bool damped : {false, true}) {
    SceneDesc scene = scenes::one_cable(20);
    scene.gravity.acceleration.setZero();
    scene.numerical_damping = damped;
    CableDesc& cable = scene.cables[0];
    cable.initial.type = InitialShapeDesc::Type::points;
    cable.initial.points = {{-0.5, 0, 0.08}, {0.5, 0, 0.08}};
    cable.initial.velocities = {{0, 0.2, -1}, {0, 0.2, -1}};
    add_solid(scene, "ball", 0.2, sphere(0.05), {0.1, 0, 0, 0, 0, 0}).angular_velocity = {0, 0, 5};
    Simulation run(scene);
    const Momenta before = momenta_of(run.world);
    run.run(0.5);
    const Momenta after = momenta_of(run.world);
    EXPECT_LT(body_of(run, "ball").velocity.z(), -0.1);
    const std::string name = std::string("cable strikes a sphere") + (damped ? ", damped" : "");
    report(name + ": linear momentum", {{20, (after.linear - before.linear).norm() / before.linear.norm()}}, 1e-11, Order::none);
    report(name + ": angular momentum", {{20, (after.angular - before.angular).norm() / before.angular.norm()}}, 5e-7,
           Order::none);
  }
}

/// Capstan: a cable over a cylinder that an axle holds and a stiff damper slows; between its sides' tensions exp(mu pi) at most.
TEST(TouchingBodies, CapstanAroundABody) {
  const double friction = 0.3, radius = 0.1;
  SceneDesc scene = no_cables();
  scene.materials[0].material.linear_density = 0.02;
  scene.materials[0].material.radius = 0.002;
  BodyDesc& drum = add_solid(scene, "drum", 1, cylinder(radius, 0.2), {0, 0, 0, M_PI / 2, 0, 0});
  drum.friction = friction;
  drum.angular_damping = 1e4;
  BodyAttachmentDesc& axle = drum.attachments.emplace_back();
  axle.name = "axle";
  axle.type = AttachmentType::axle;
  axle.rotation = {M_PI / 2, 0, 0};
  const double over = radius + 0.002;
  CableDesc& cable = scene.cables.emplace_back();
  cable.name = "cable";
  cable.segments = 120;
  cable.material = "rope";
  cable.initial.type = InitialShapeDesc::Type::points;
  for (int i = 0; i <= 4; ++i) cable.initial.points.push_back({-over, 0, -0.3 + 0.075 * i});
  for (int i = 1; i < 40; ++i)
    cable.initial.points.push_back({-over * std::cos(M_PI * i / 40), 0, over * std::sin(M_PI * i / 40)});
  for (int i = 0; i <= 4; ++i) cable.initial.points.push_back({over, 0, -0.3 * i / 4.0});
  cable.length = 0.6 + M_PI * over;
  cable.point_masses = {scenes::payload(2)};
  cable.attachments = {scenes::attachment("hand", PlaceDesc::At::start, {0, 0, 0}, "hand")};
  cable.attachments[0].initial_pose = InitialPose{-over, 0, -0.3, 0, 0, 0};
  Simulation run(scene);
  run.run(0.5);
  // The hand lets it slide slowly.
  double sum = 0;
  int count = 0;
  for (int i = 0; i < 400; ++i) {
    run.inputs[1].pose.position.z() += 5e-5;
    run.step();
    if (i < 200) continue;
    sum += run.world.cables()[0].state.tension.front();
    ++count;
  }
  const double held = sum / count, load = 2 * gravity;
  report("capstan around a body", {{120, std::abs(load / held / std::exp(friction * M_PI) - 1)}}, 0.03, Order::none);
}

}  // namespace
}  // namespace verlet_cable::validation
