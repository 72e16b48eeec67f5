#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/scenes.h"
#include "contact/law.h"
#include "geometry/segment_geometry.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

constexpr double pi = 3.14159265358979323846;
constexpr double radius = 0.005;

/// A straight rope of 5 mm.
SceneDesc straight_rope(double length, int segments, double linear_density = 0.1) {
  SceneDesc scene = scenes::one_cable(segments, length);
  scene.materials[0].material.linear_density = linear_density;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  return scene;
}

void add_obstacle(const std::string& name, ShapeType type, const InitialPose& pose, SceneDesc& scene) {
  ObstacleDesc obstacle;
  obstacle.name = name;
  obstacle.type = type;
  obstacle.pose = pose;
  obstacle.radius = 0.05;
  obstacle.length = 1.0;
  obstacle.size = {0.4, 0.4, 0.1};
  scene.obstacles.push_back(obstacle);
}

/// Steps for a duration [s] and returns the largest total energy on the way [J].
double run(World& world, double duration) {
  const BoundaryInputs inputs(world.frames().size());
  double most = world.energy().total();
  for (const double end = world.time() + duration - 0.5 * world.time_step(); world.time() < end;) {
    const StepResult result = world.step(inputs);
    EXPECT_EQ(result.status, StepResult::Status::ok);
    most = std::max(most, world.energy().total());
  }
  return most;
}

double lowest(const World& world) {
  double z = infinity;
  for (const SimulatedCable& cable : world.cables())
    for (const Vector3& x : cable.state.positions) z = std::min(z, x.z());
  return z;
}

double fastest(const World& world) {
  double v = 0;
  for (const SimulatedCable& cable : world.cables())
    for (const Vector3& velocity : cable.state.velocities) v = std::max(v, velocity.norm());
  return v;
}

/// A rope along the fall line of a plane inclined by `slope` [rad].
SceneDesc incline(double slope, double friction) {
  SceneDesc scene = straight_rope(1.0, 50);
  add_obstacle("ramp", ShapeType::plane, {0, 0, 0, 0, slope, 0}, scene);
  scene.obstacles.back().friction = friction;
  const Vector3 normal{std::sin(slope), 0, std::cos(slope)}, down{std::cos(slope), 0, -std::sin(slope)};
  scene.cables[0].initial.from = radius * normal;
  scene.cables[0].initial.to = radius * normal + down;
  return scene;
}

/// Far stretches of a rope are passed over at once: no segment that is close to a ball may be, not even a single one.
TEST(Contact, ObstaclesAreFoundAllAlongARope) {
  constexpr int segments = 100;
  for (int half = 0; half <= 2 * segments; ++half) {
    SceneDesc scene = straight_rope(1.0, segments);
    scene.gravity.acceleration = Vector3::Zero();
    scene.cables[0].initial.from = Vector3::Zero();
    scene.cables[0].initial.to = Vector3::UnitX();
    const double x = 0.5 * half / segments;
    add_obstacle("ball", ShapeType::sphere, {x, 0, -0.003 - 0.9 * radius, 0, 0, 0}, scene);
    scene.obstacles.back().radius = 0.003;
    World world(scene, BoundaryInputs(1));
    ASSERT_EQ(world.step(BoundaryInputs(1)).status, StepResult::Status::ok);
    const std::vector<Vector3>& velocities = world.cables()[0].state.velocities;
    EXPECT_GT(velocities[half / 2].z(), 10 * velocities[half < segments ? segments : 0].norm()) << "at " << x << " m";
    EXPECT_GT(velocities[half / 2].z(), 1e-2) << "at " << x << " m";
  }
}

TEST(Contact, RopeSlidesDownAnInclineAsCoulombSays) {
  const double slope = 0.5, friction = 0.3, duration = 1.0;
  World world(incline(slope, friction), BoundaryInputs(1));
  run(world, duration);
  const double expected = 9.81 * (std::sin(slope) - friction * std::cos(slope)) * duration;
  // At first it sinks in by a thousandth of its radius, which takes some steps.
  EXPECT_NEAR(world.cables()[0].state.velocities[25].norm(), expected, 0.01 * expected);
}

TEST(Contact, RopeSticksToAnInclineBelowTheAngleOfFriction) {
  const double slope = std::atan(0.97 * 0.3);
  World world(incline(slope, 0.3), BoundaryInputs(1));
  run(world, 0.5);
  const Vector3 before = world.cables()[0].state.positions[0];
  run(world, 1.0);
  // What sticks does not creep: the limit is far below what viscous friction would let pass, g h per step.
  EXPECT_LT((world.cables()[0].state.positions[0] - before).norm(), 1e-6);
}

/// A rope across the fall line of a plane, after a second: how fast it comes down [m/s].
double speed_across_an_incline(const MaterialDesc& changed, double slope, double friction) {
  SceneDesc scene = incline(slope, friction);
  MaterialDesc& material = scene.materials[0].material;
  material.rolling_friction = changed.rolling_friction;
  material.torsional_stiffness = changed.torsional_stiffness;
  const Vector3 normal{std::sin(slope), 0, std::cos(slope)};
  scene.cables[0].initial.from = radius * normal;
  scene.cables[0].initial.to = radius * normal + Vector3::UnitY();
  World world(scene, BoundaryInputs(1));
  run(world, 1.0);
  return world.cables()[0].state.velocities[25].norm();
}

TEST(Contact, RopeRollsDownAnInclineAgainstItsRollingFriction) {
  const double slope = 0.4, friction = 0.5;
  MaterialDesc material;
  for (const double part : {0.0, 0.4, 0.8}) {
    material.rolling_friction = part;
    // Without the inertia of its spin; at first it sinks in by a thousandth of its radius.
    const double expected = 9.81 * (std::sin(slope) - part * friction * std::cos(slope));
    EXPECT_NEAR(speed_across_an_incline(material, slope, friction), expected, 0.01 * expected) << part;
  }
  // What does not roll sticks, and friction along the cable is what it is.
  material.rolling_friction = 1;
  EXPECT_LT(speed_across_an_incline(material, slope, friction), 1e-6);
  material.rolling_friction = 0;
  material.torsional_stiffness = 1e-3;
  EXPECT_LT(speed_across_an_incline(material, slope, friction), 1e-6);
  SceneDesc along = incline(slope, friction);
  along.materials[0].material.rolling_friction = 0;
  World world(along, BoundaryInputs(1));
  run(world, 1.0);
  EXPECT_LT(fastest(world), 1e-6);
}

TEST(Contact, FrictionAlongWhatRollsIsTheOtherLegOfTheCone) {
  // It slips in a direction of 60 degrees to the axis of a cable that rolls against 0.6 of the friction: across it there are 0.6
  // of what there can be, and along it sqrt(1 - 0.6^2).
  Touch touch;
  touch.friction = 0.5;
  touch.radius = 1;
  touch.base_stiffness = 100;
  touch.gap = -0.01;
  touch.yields = true;  // it is linear
  touch.rolling = {Rolling{Vector3::UnitY(), 0.6}, {}};
  touch.rolling_count = 1;
  start_touch(touch);
  const Vector3 slip = 10 * Vector3(0.5, std::sqrt(0.75), 0);
  evaluate_touch(slip, touch);
  const double normal_force = 1, limit = touch.friction * normal_force;
  EXPECT_NEAR((touch.force - Vector3(-0.8 * limit, -0.6 * limit, normal_force)).norm(), 0, 1e-12);
  // The matrix is a secant of the force.
  EXPECT_NEAR((slope(touch) * slip + touch.force - normal_force * Vector3::UnitZ()).norm(), 0, 1e-9);
  // What slips along it rolls not.
  evaluate_touch({10, 0.01, 0}, touch);
  EXPECT_NEAR(touch.force.x(), -limit, 1e-5);
}

TEST(Contact, StiffRodWithoutDampingDoesNotRingItselfDownAnIncline) {
  const double slope = std::atan(0.8 * 0.5);
  for (const double stiffness : {0.1, 10.0}) {
    SceneDesc scene = incline(slope, 0.5);
    scene.materials[0].material.bending_stiffness = stiffness;
    const Vector3 normal{std::sin(slope), 0, std::cos(slope)};
    scene.cables[0].initial.from += 1e-3 * normal;
    scene.cables[0].initial.to += 1e-3 * normal;
    World world(scene, BoundaryInputs(1));
    run(world, 1.0);
    const Vector3 before = world.cables()[0].state.positions[0];
    run(world, 2.0);
    EXPECT_LT((world.cables()[0].state.positions[0] - before).norm(), 1e-6);
    EXPECT_LT(fastest(world), 1e-6);
  }
}

TEST(Contact, RopeDroppedOnAFloorComesToRestAtItsRadius) {
  SceneDesc scene = straight_rope(1.0, 100);
  add_obstacle("floor", ShapeType::plane, {0, 0, 0, 0, 0, 0}, scene);
  scene.cables[0].initial.from = {0, 0, 0.3};
  scene.cables[0].initial.to = {1, 0, 0.5};
  World world(scene, BoundaryInputs(1));
  const double before = world.energy().total();
  EXPECT_LE(run(world, 2.0), before * (1 + 1e-9));
  EXPECT_NEAR(lowest(world), radius, 0.01 * radius);
  EXPECT_LT(fastest(world), 1e-3);
}

TEST(Contact, PileTouchesItselfAndComesToRest) {
  SceneDesc scene = straight_rope(0.5, 50);
  scene.contact = ContactDesc{};
  add_obstacle("floor", ShapeType::plane, {0, 0, 0, 0, 0, 0}, scene);
  scene.cables[0].initial.from = {0, 0, 0.02};
  scene.cables[0].initial.to = {0.01, 0.005, 1};
  World world(scene, BoundaryInputs(1));
  const double before = world.energy().total();
  EXPECT_LE(run(world, 3.0), before * (1 + 1e-3));
  EXPECT_GT(lowest(world), 0.8 * radius);
  EXPECT_LT(fastest(world), 0.01);
  const std::vector<SimulatedContact> contacts = world.findings().contacts;
  EXPECT_TRUE(std::any_of(contacts.begin(), contacts.end(), [](const SimulatedContact& c) { return c.other_cable == 0; }));
  const std::vector<Vector3>& x = world.cables()[0].state.positions;
  double closest = infinity;
  for (int i = 0; i < 50; ++i)
    for (int j = i + 3; j < 50; ++j)
      closest = std::min(closest, closest_points(x[i], x[i + 1] - x[i], x[j], x[j + 1] - x[j]).between.norm());
  EXPECT_GT(closest, 1.8 * radius);
}

/// A light cable over a cylinder, wrapped by half a turn and any number of whole ones.
SceneDesc capstan(double friction, double angle) {
  const double cylinder = 0.05, arm = 0.2;
  const double wrap = cylinder + radius;
  SceneDesc scene = straight_rope(angle * wrap + 2 * arm, 100, 0.002);
  CableDesc& cable = scene.cables[0];
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points.push_back({-wrap, 0, -arm});
  for (int i = 0; i <= 200; ++i) {
    const double turned = angle * i / 200;
    cable.initial.points.push_back({-wrap * std::cos(turned), 0, wrap * std::sin(turned)});
  }
  cable.initial.points.push_back(cable.initial.points.back() + Vector3(0, 0, -arm));
  add_obstacle("capstan", ShapeType::cylinder, {0, 0, 0, pi / 2, 0, 0}, scene);
  scene.obstacles.back().friction = friction;
  return scene;
}

/// With payloads at both ends of a capstan's cable whose weights are in the ratio exp(friction * angle) * factor: how far the
/// heavy one has sunk after half a second, after a time for it to settle [m].
double capstan_slip(double friction, double angle, double factor) {
  const double light = 1.0;
  SceneDesc scene = capstan(friction, angle);
  CableDesc& cable = scene.cables[0];
  cable.point_masses.push_back({{PlaceDesc::At::start, 0}, light / 9.81});
  cable.point_masses.push_back({{PlaceDesc::At::end, 0}, light * factor * std::exp(friction * angle) / 9.81});
  World world(scene, BoundaryInputs(1));
  run(world, 0.5);
  const double before = world.cables()[0].state.positions.back().z();
  run(world, 0.5);
  return before - world.cables()[0].state.positions.back().z();
}

TEST(Contact, CapstanHoldsAndSlipsAsEulerSays) {
  for (const double angle : {pi, 3 * pi})
    for (const double friction : {0.1, 0.3, 0.5}) {
      EXPECT_LT(capstan_slip(friction, angle, 0.97), 2e-4) << "friction " << friction << ", angle " << angle;
      EXPECT_GT(capstan_slip(friction, angle, 1.03), 2e-3) << "friction " << friction << ", angle " << angle;
    }
}

/// A rope of 3 m that hangs from a drum of 3 cm with a load of 5 N, as it is wound up at half a turn a second, turn upon turn.
class WoundRope {
 public:
  explicit WoundRope(int segments) {
    SceneDesc scene = scenes::one_cable(segments, 3);
    MaterialDesc& material = scene.materials[0].material;
    material.linear_density = 0.04;
    material.radius = 0.004;
    material.bending_stiffness = 1e-3;
    material.bending_damping = 2e-5;
    material.axial_stiffness = 2e4;
    material.axial_damping = 100;
    material.drag = 0.01;
    CableDesc& cable = scene.cables[0];
    cable.initial.type = InitialShapeDesc::Type::points;
    cable.initial.points = {{0.034, 0, 0}, {0.034, 0, -3}};
    cable.point_masses.push_back({{PlaceDesc::At::end, 0}, 5 / 9.81});
    AttachmentDesc clamp = scenes::attachment("clamp", PlaceDesc::At::start, {0.034, 0, 0}, "axle");
    clamp.type = AttachmentType::clamp;
    clamp.rotation = {0, 0.5 * pi, 0};
    clamp.initial_pose = InitialPose{};
    cable.attachments = {clamp};
    add_obstacle("drum", ShapeType::cylinder, {0, 0, 0, 0.5 * pi, 0, 0}, scene);
    scene.obstacles[0].radius = 0.03;
    scene.obstacles[0].frame = "drum";
    scene.obstacles[0].initial_pose = InitialPose{};
    scene.obstacles[0].friction = 0.3;
    scene.contact = ContactDesc();
    scene.contact->friction = 0.3;
    inputs_ = initial_frames(scene);
    world_ = World(scene, inputs_);
  }
  void wind(double duration) {
    for (const double end = world_.time() + duration - 1e-9; world_.time() < end;) {
      const double time = world_.time() + world_.time_step();
      const double angle = pi * (time < 0.4 ? time * time / 0.8 : time - 0.2);
      for (std::size_t frame : {1, 2})
        inputs_[frame].pose.orientation = Quaternion(std::cos(0.5 * angle), 0, -std::sin(0.5 * angle), 0);
      EXPECT_EQ(world_.step(inputs_).status, StepResult::Status::ok);
    }
  }
  const std::vector<double>& tension() const { return world_.cables()[0].state.tension; }

 private:
  BoundaryInputs inputs_{1};
  World world_{SceneDesc(), BoundaryInputs(1)};
};

TEST(Contact, ARopeOnADrumKeepsTheTensionWithWhichItWasWound) {
  constexpr double weight = 5 + 3 * 0.04 * 9.81;
  WoundRope rope(400);
  rope.wind(1.1);
  for (int segment = 0; segment < 12; ++segment) EXPECT_NEAR(rope.tension()[segment], weight, 0.1 * weight) << segment;
}

TEST(Contact, LayersOnADrumDoNotTightenTheRopeUnderThem) {
  // Segments of half the drum's radius: with 800 of them it is 8 N at most.
  WoundRope rope(200);
  for (int second = 1; second <= 8; ++second) {
    rope.wind(1);
    EXPECT_LT(*std::max_element(rope.tension().begin(), rope.tension().end()), 8) << second;
  }
}

TEST(Contact, FrictionFollowsTheTensionWithinAnIteration) {
  const double friction = 0.5, angle = 3 * pi;
  SceneDesc scene = capstan(friction, angle);
  scene.gravity.acceleration.setZero();
  scene.materials[0].material.axial_stiffness = 2000;
  scene.materials[0].material.axial_damping = 2;
  CableDesc& cable = scene.cables[0];
  cable.length *= 0.998;  // tight from the start
  const std::vector<Vector3>& points = cable.initial.points;
  for (const bool first : {true, false}) {
    const Vector3& end = first ? points.front() : points.back();
    const char* frame = first ? "first" : "second";
    AttachmentDesc held = scenes::attachment(frame, first ? PlaceDesc::At::start : PlaceDesc::At::end, Vector3::Zero(), frame);
    held.initial_pose = InitialPose{end.x(), end.y(), end.z(), 0, 0, 0};
    cable.attachments.push_back(held);
  }
  BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  int iterations = 0;
  for (int i = 0; i < 300; ++i) {
    frames[1].pose.position.z() += 1e-4;
    frames[2].pose.position.z() -= 1e-4;
    const StepResult result = world.step(frames);
    if (i >= 100) iterations += result.iterations;
  }
  const std::vector<Attachment>& ends = world.attachments();
  EXPECT_NEAR(ends[1].force.norm() / ends[0].force.norm() / std::exp(friction * angle), 1, 0.02);
  // Where iterations hand it on along the cable, they are seven a step.
  EXPECT_LT(iterations, 3 * 200);
}

TEST(Contact, CableSettlesOnAFloor) {
  SceneDesc scene = scenes::between_two_points(100, 0.6);
  scene.materials[0].material.bending_stiffness = 1e-3;
  add_obstacle("floor", ShapeType::plane, {0, 0, -0.2, 0, 0, 0}, scene);
  World world(scene, BoundaryInputs(1));
  EXPECT_TRUE(world.settle());
  EXPECT_NEAR(lowest(world), -0.2 + radius, 0.02 * radius);
  // It is an equilibrium: nothing moves when time goes on.
  const std::vector<Vector3> before = world.cables()[0].state.positions;
  run(world, 0.2);
  double moved = 0;
  for (std::size_t i = 0; i < before.size(); ++i)
    moved = std::max(moved, (world.cables()[0].state.positions[i] - before[i]).norm());
  EXPECT_LT(moved, 0.01 * radius);
}

TEST(Contact, SettlingForgetsWhatWasFoundInTheLastStep) {
  SceneDesc scene = straight_rope(1, 20);
  add_obstacle("table", ShapeType::box, {0.5, 0, -0.045, 0, 0, 0}, scene);
  World world(scene, BoundaryInputs(frame_names(scene).size()));
  world.step(BoundaryInputs(world.frames().size()));
  ASSERT_FALSE(world.findings().contacts.empty());
  ASSERT_FALSE(world.findings().intrusions.empty());
  world.settle();
  EXPECT_TRUE(world.findings().contacts.empty());
  EXPECT_TRUE(world.findings().intrusions.empty());
}

TEST(Contact, CableInsideAnObstacleIsFoundAndPushedOutGently) {
  SceneDesc scene = straight_rope(0.3, 30);
  scene.cables[0].initial.from = {-0.15, 0, 0.03};
  scene.cables[0].initial.to = {0.15, 0, 0.03};
  add_obstacle("block", ShapeType::box, {0, 0, 0, 0, 0, 0}, scene);
  World world(scene, BoundaryInputs(1));
  const BoundaryInputs inputs(1);
  world.step(inputs);
  ASSERT_EQ(world.findings().intrusions.size(), 1u);
  EXPECT_EQ(world.findings().intrusions[0].cable, 0);
  EXPECT_EQ(world.findings().intrusions[0].obstacle, 0);
  EXPECT_NEAR(world.findings().intrusions[0].depth, 0.05 - 0.03 + radius, 0.01 * radius);
  double speed = 0;
  bool inside = true;
  for (int i = 0; i < 3000; ++i) {
    // It is said until the cable is out, and then no more.
    const StepResult::Status status = world.step(inputs).status;
    ASSERT_EQ(status,
              inside && !world.findings().intrusions.empty() ? StepResult::Status::inside_obstacle : StepResult::Status::ok)
        << i;
    inside = inside && status != StepResult::Status::ok;
    ASSERT_EQ(world.findings().intrusions.empty(), !inside) << i;
    speed = std::max(speed, fastest(world));
  }
  EXPECT_FALSE(inside);
  EXPECT_LT(speed, 0.5);
  EXPECT_NEAR(lowest(world), 0.05 + radius, 0.02 * radius);
  EXPECT_LT(fastest(world), 1e-3);
}

TEST(Contact, CableThatHangsThroughAnObstacleSettlesOnIt) {
  for (const ShapeType type : {ShapeType::cylinder, ShapeType::sphere}) {
    SceneDesc scene = scenes::between_two_points(40, 0.8);
    scene.cables[0].initial.type = InitialShapeDesc::Type::catenary;
    add_obstacle("ball", type, {0.4, 0, -0.25, pi / 2, 0, 0}, scene);
    scene.obstacles[0].radius = 0.1;
    World world(scene, BoundaryInputs(1));
    EXPECT_LT(lowest(world), -0.25);
    EXPECT_TRUE(world.settle());
    for (const Vector3& place : world.cables()[0].state.positions) {
      const Vector3 out = place - Vector3(0.4, 0, -0.25);
      EXPECT_GT(std::hypot(out.x(), out.z()), type == ShapeType::cylinder ? 0.1 + 0.98 * radius : 0);
      EXPECT_GT(out.norm(), 0.1 + 0.98 * radius);
    }
    run(world, 0.2);
    EXPECT_LT(fastest(world), 1e-3);
  }
}

/// Around the ball it is longer than the cable: twice sqrt(0.49^2 - 0.1^2) and an arc of 0.04 m are more than 1 m.
TEST(Contact, CableThatIsStuckInAnObstacleIsNotSettled) {
  for (const ShapeType type : {ShapeType::cylinder, ShapeType::sphere}) {
    SceneDesc scene = scenes::between_two_points(40, 0.98);
    add_obstacle("ball", type, {0.49, 0, 0, pi / 2, 0, 0}, scene);
    scene.obstacles[0].radius = 0.1;
    World world(scene, BoundaryInputs(1));
    EXPECT_EQ(world.findings().unsettled.size(), 1u);
    EXPECT_FALSE(world.settle());
  }
}

/// A rope of 1 m through a block whose faces press it to opposite sides: what they exert means nothing, and is told once it has
/// had time to get out.
TEST(Contact, CableThatFindsNoWayOutOfAnObstacleIsTold) {
  SceneDesc scene = scenes::between_two_points(40, 0.8);
  scene.cables[0].initial.type = InitialShapeDesc::Type::catenary;
  add_obstacle("block", ShapeType::box, {0.4, 0, -0.25, 0, 0, 0}, scene);
  World world(scene, BoundaryInputs(1));
  const BoundaryInputs inputs(1);
  int pressed = 0, told = 0;
  for (int i = 0; i < 2000; ++i) {
    const StepResult result = world.step(inputs);
    const bool degraded = result.status == StepResult::Status::degraded;
    if (degraded) {
      ASSERT_EQ(result.cause, DegradedCause::no_room) << i;
    }
    double pressure = 0;
    for (const SimulatedContact& contact : world.findings().contacts) pressure = std::max(pressure, contact.force.norm());
    if (i < 100 || pressure < 100) continue;
    ++pressed;
    told += degraded;
  }
  EXPECT_GT(pressed, 1000);
  EXPECT_GT(told, 0.98 * pressed);
}

TEST(Contact, CopiesOfAWorldWithContactsGoOnWithTheSameBytes) {
  SceneDesc scene = straight_rope(0.5, 50);
  scene.contact = ContactDesc{};
  add_obstacle("floor", ShapeType::plane, {0, 0, 0, 0, 0, 0}, scene);
  scene.cables[0].initial.from = {0, 0, 0.02};
  scene.cables[0].initial.to = {0.01, 0.005, 1};
  World world(scene, BoundaryInputs(1));
  run(world, 0.3);
  World copy = world;
  run(world, 0.2);
  run(copy, 0.2);
  EXPECT_EQ(world.hash(), copy.hash());
}

TEST(Contact, CablesSteppedAtOnceAreThoseSteppedOneByOne) {
  SceneDesc scene = straight_rope(0.5, 50);
  scene.materials[0].material.bending_stiffness = 1e-4;
  scene.materials[0].material.breaking_tension = 3;
  add_obstacle("block", ShapeType::box, {0, 0, 0, 0, 0, 0}, scene);
  const CableDesc cable = scene.cables[0];
  scene.cables.clear();
  for (int i = 0; i < 40; ++i) {
    // Some begin inside of the block, some fall on it, some are thrown about by a hand and break.
    CableDesc other = cable;
    other.name = "cable" + std::to_string(i);
    other.initial.from = {-0.25 + 0.01 * i, 0.002 * i, 0.03 + 0.01 * i};
    other.initial.to = {0.25 + 0.01 * i, 0.004 * i, 0.03 + 0.01 * i};
    if (i % 3 == 0)
      other.attachments = {scenes::attachment("held" + std::to_string(i), PlaceDesc::At::start, {0, 0, 0.01 * i}, "hand")};
    scene.cables.push_back(other);
  }
  const auto hand = [](int i) { return scenes::hand_at({0.2 * std::sin(0.05 * i), 0, 0.1}); };
  World at_once(scene, hand(0)), one_by_one(scene, hand(0));
  one_by_one.step_one_by_one(true);
  bool intruded = false, broke = false;
  for (int i = 1; i <= 400; ++i) {
    const StepResult a = at_once.step(hand(i)), b = one_by_one.step(hand(i));
    ASSERT_EQ(at_once.hash(), one_by_one.hash()) << "step " << i;
    ASSERT_EQ(a.status, b.status);
    ASSERT_TRUE(a.body == b.body);
    ASSERT_EQ(a.iterations, b.iterations);
    ASSERT_EQ(a.max_strain, b.max_strain);
    ASSERT_EQ(at_once.findings().intrusions.size(), one_by_one.findings().intrusions.size());
    for (std::size_t k = 0; k < at_once.findings().intrusions.size(); ++k) {
      ASSERT_EQ(at_once.findings().intrusions[k].cable, one_by_one.findings().intrusions[k].cable);
      ASSERT_EQ(at_once.findings().intrusions[k].depth, one_by_one.findings().intrusions[k].depth);
    }
    intruded = intruded || at_once.findings().intrusions.size() > 1;
    broke = broke || !at_once.findings().breaks.empty();
  }
  EXPECT_TRUE(intruded);
  EXPECT_TRUE(broke);
}

TEST(Contact, StiffCableThatIsPushedBetweenPlatesStaysThereInLongSteps) {
  for (const double time_step : {0.001, 0.004, 0.005}) {
    constexpr double thickness = 0.003, half_gap = 0.006, length = 0.7, speed = 0.2, duration = 1.25, rise = 0.1;
    SceneDesc scene = scenes::one_cable(60, length);
    scene.time_step = time_step;
    MaterialDesc& material = scene.materials[0].material;
    material.linear_density = 0.05;
    material.radius = thickness;
    material.bending_stiffness = 0.5;
    material.bending_damping = 0.01;
    scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
    scene.cables[0].initial.from = {-0.65, 0, 0};
    scene.cables[0].initial.to = {1, 0, 0};
    scene.cables[0].attachments = {scenes::attachment("h", PlaceDesc::At::start, Vector3::Zero(), "hand", AttachmentType::clamp)};
    scene.cables[0].attachments[0].initial_pose = InitialPose{-0.65, 0, 0, 0, 0, 0};
    for (const double side : {-1.0, 1.0}) {
      add_obstacle(side < 0 ? "below" : "above", ShapeType::box, {0.15, 0, side * (half_gap + 0.025), 0, 0, 0}, scene);
      scene.obstacles.back().size = {0.3, 0.4, 0.05};
      scene.obstacles.back().friction = 0.2;
    }
    BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    double deepest = 0;
    const long steps = std::lround(duration / time_step);
    for (long i = 0; i < steps; ++i) {
      inputs[1].pose.position = {-0.65 + speed * time_step * (i + 1), 0, rise * i / steps};
      EXPECT_EQ(world.step(inputs).status, StepResult::Status::ok) << world.time();
      for (const Vector3& x : world.cables()[0].state.positions)
        if (x.x() > 0) deepest = std::max(deepest, std::abs(x.z()) + thickness - half_gap);
    }
    EXPECT_LT(deepest, 0.1 * thickness) << time_step;
  }
}

/// A hand draws an elastic cable below the floor by mistake, and comes back. The next node stays on the floor, which pushes it up
/// and not along: it has no edge there. So nothing is thrown, and contact takes energy.
TEST(Contact, FloorDoesNotThrowACableThatAHandHoldsBelowIt) {
  for (const double friction : {0.0, 0.1, 0.5})
    for (const bool yields : {false, true}) {
      SceneDesc scene = scenes::one_cable(10, 0.7);
      MaterialDesc& material = scene.materials[0].material;
      material.linear_density = 0.14;
      material.radius = 0.003;
      material.bending_stiffness = 0.04;
      material.torsional_stiffness = 0.015;
      material.bending_damping = 1.3e-4;
      material.axial_stiffness = 2e4;
      material.drag = 0.05;
      if (yields) {
        material.yield_curvature = 3;
        material.hardening = 0.05;
      }
      add_obstacle("floor", ShapeType::plane, {}, scene);
      scene.obstacles[0].friction = friction;
      scene.cables[0].attachments = {scenes::attachment("hand", PlaceDesc::At::start, {0, 0, 0}, "hand"),
                                     scenes::attachment("end", PlaceDesc::At::end, {0.42, 0, 0.1})};
      scene.cables[0].attachments[0].initial_pose = InitialPose{0, 0, 0.1, 0, 0, 0};
      World world(scene, initial_frames(scene));
      BoundaryInputs inputs = initial_frames(scene);
      double most = 0;
      for (int i = 1; i <= 1200; ++i) {
        const double sine = std::sin(pi * std::min(0.001 * i, 1.0));
        inputs[1] = {Pose{{0, 0, 0.1 - 0.2 * sine * sine}, Quaternion::Identity()}, true};
        ASSERT_NE(world.step(inputs).status, StepResult::Status::fault) << i;
        most = std::max(most, fastest(world));
        ASSERT_GT(world.ledger().balance.dissipated.contact, -1e-3) << i;
      }
      EXPECT_LT(most, 6) << friction << yields;
      EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-3) << friction << yields;
    }
}

TEST(ContactLaw, StiffensWithDepthAndKeepsFrictionInItsCone) {
  Touch touch;
  touch.radius = radius;
  touch.friction = 0.4;
  touch.base_stiffness = 100;
  touch.gap = 0;
  anticipate(Scheme::conserving, 1e-3, contact_time(1e-3), Vector3::Zero(), touch);
  start_touch(touch);
  double last = 0, last_slope = 0;
  for (double depth = 1e-5; depth < 1e-3; depth += 1e-5) {
    evaluate_touch(Vector3(depth / touch.rate, 0, -depth / touch.rate), touch);
    EXPECT_GT(touch.normal_force, last);
    EXPECT_GE(touch.normal_force - last, last_slope * (1 - 1e-9));
    EXPECT_LE(std::hypot(touch.force.x(), touch.force.y()), touch.friction * touch.normal_force * (1 + 1e-12));
    last_slope = touch.normal_force - last;
    last = touch.normal_force;
  }
  evaluate_touch(Vector3(0, 0, 1e-6), touch);
  EXPECT_EQ(touch.mode, Touch::Mode::open);
  EXPECT_EQ(touch.force, Vector3::Zero());
}

TEST(ContactLaw, DeepContactIsLedToTheDepthOfItsForceInOneIteration) {
  for (const double force : {0.1, 1.0, 10.0, 100.0}) {
    Touch touch;
    touch.radius = radius;
    touch.base_stiffness = 100;
    anticipate(Scheme::conserving, 1e-3, contact_time(1e-3), Vector3::Zero(), touch);
    start_touch(touch);
    touch.stiffness = force / (0.3 * radius);  // by which the cables have come so deep with this force
    evaluate_touch(Vector3(0, 0, -0.3 * radius / touch.rate), touch);
    EXPECT_GT(touch.normal_force, 5 * force);
    const double next = touch.depth - (touch.normal_force - force) / touch.stiffness;
    evaluate_touch(Vector3(0, 0, -next / touch.rate), touch);
    // The depth of a force is found to some percent; the tangent would leave twenty times the force, and more.
    EXPECT_NEAR(touch.normal_force, force, 0.2 * force);
  }
}

TEST(ContactLaw, FrictionWithinAHeldBoundHasAPotential) {
  for (const double slip : {1e-7, 1e-5, 1e-4}) {
    Touch touch;
    touch.radius = radius;
    touch.friction = 0.4;
    touch.base_stiffness = 100;
    touch.gap = -2e-5;
    anticipate(Scheme::dissipative, 1e-3, contact_time(1e-3), Vector3::Zero(), touch);
    start_touch(touch);
    hold_bound(3e-3, touch);
    const Vector3 way = Vector3(slip, -0.7 * slip, -1e-6) / touch.rate;
    evaluate_touch(way, touch);
    EXPECT_EQ(touch.mode, slip > 1e-6 ? Touch::Mode::slides : Touch::Mode::sticks);
    EXPECT_LE(std::hypot(touch.force.x(), touch.force.y()), touch.friction * touch.bound * (1 + 1e-12));
    const Eigen::Matrix3d matrix = slope(touch);
    EXPECT_LT((matrix - matrix.transpose()).norm(), 1e-12 * matrix.norm());
    EXPECT_EQ(full_slope(touch), matrix);
    Eigen::Matrix3d differences;
    const double step = 1e-9;
    for (int k = 0; k < 3; ++k) {
      const auto force_at = [&](double along) {
        Touch moved = touch;
        evaluate_touch(way + along * Vector3::Unit(k), moved);
        return moved.force;
      };
      differences.col(k) = -(force_at(step) - force_at(-step)) / (2 * step);
    }
    EXPECT_LT((matrix - differences).norm(), 1e-3 * matrix.norm()) << slip;
  }
}

TEST(SegmentDistance, AgreesWithASearch) {
  unsigned seed = 1;
  const auto random = [&] { return (seed = seed * 1664525u + 1013904223u) / 4294967296.0 - 0.5; };
  const auto vector = [&] { return Vector3(random(), random(), random()); };
  for (int k = 0; k < 200; ++k) {
    const Vector3 a = vector(), b = vector(), along_a = vector(), along_b = vector();
    double least = infinity;
    for (int i = 0; i <= 100; ++i)
      for (int j = 0; j <= 100; ++j) least = std::min(least, (a + 0.01 * i * along_a - b - 0.01 * j * along_b).norm());
    const ClosestPoints points = closest_points(a, along_a, b, along_b);
    EXPECT_LT((a + points.first * along_a - b - points.second * along_b - points.between).norm(), 1e-12);
    // Drawing the points to the middles may cost a tenth of a segment where segments are nearly parallel.
    EXPECT_LT(points.between.norm(), least + 0.1 * std::max(along_a.norm(), along_b.norm()));
    EXPECT_GT(points.between.norm(), least - 0.02);
  }
}

}  // namespace
}  // namespace verlet_cable
