#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "../support/nets.h"
#include "../support/scenes.h"

// Forces and torques from outside.

namespace verlet_cable {
namespace {

using Status = StepResult::Status;

constexpr double gravity = 9.81;

edit::ApplyLoad on_node(const std::string& name, int cable, int node, const Vector3& force, double duration = 0) {
  edit::ApplyLoad load;
  load.name = name;
  load.body = cable_id(cable);
  load.node = node;
  load.force = force;
  load.duration = duration;
  return load;
}

edit::ApplyLoad on_body(const std::string& name, const Vector3& force, const Vector3& torque = Vector3::Zero()) {
  edit::ApplyLoad load;
  load.name = name;
  load.body = rigid_body_id(0);
  load.force = force;
  load.torque = torque;
  return load;
}

/// A body that nothing holds, without gravity; its center of mass is beside its origin.
SceneDesc free_body() {
  SceneDesc scene;
  scene.gravity.acceleration.setZero();
  BodyDesc& body = scene.bodies.emplace_back();
  body.name = "body";
  body.mass = 2;
  body.inertia = Vector3(0.1, 0.2, 0.25);
  body.center_of_mass = Vector3(0.1, -0.2, 0.3);
  body.pose = InitialPose{0.3, 0.2, 0.1, 0.4, -0.3, 0.2};
  return scene;
}

double mass_of(const SimulatedCable& cable) {
  return std::accumulate(cable.state.masses.begin(), cable.state.masses.end(), 0.0);
}

const Load* find_load(const World& world, const std::string& name) {
  for (const Load& load : world.loads())
    if (load.name == name) return &load;
  return nullptr;
}

/// Half of the cable is a catenary whose vertical tension begins with half of the load: with p = P / 2 and w the weight of a
/// metre, V = p + w s, x = H / w (asinh(V / H) - asinh(p / H)), z = (hypot(H, V) - hypot(H, p)) / w.
double sag_of_loaded_catenary(double span, double length, double weight, double load) {
  const double w = weight / length, p = 0.5 * load, end = p + 0.5 * weight;
  double low = 1e-6, high = 1e4;
  for (int i = 0; i < 200; ++i) {
    const double h = std::sqrt(low * high);
    (h / w * (std::asinh(end / h) - std::asinh(p / h)) < 0.5 * span ? low : high) = h;
  }
  return (std::hypot(low, end) - std::hypot(low, p)) / w;
}

TEST(Loads, HangAsACatenaryWithAWeight) {
  constexpr int n = 200;
  const SceneDesc scene = scenes::between_two_points(n, 0.8);
  World world(scene, initial_frames(scene));
  for (const double load : {0.2, 2.0}) {
    ASSERT_TRUE(world.apply(on_node("weight", 0, n / 2, {0, 0, -load})).ok);
    ASSERT_TRUE(world.settle());
    const double sag = sag_of_loaded_catenary(0.8, 1, 0.1 * gravity, load);
    EXPECT_NEAR(-world.cables()[0].state.positions[n / 2].z(), sag, 1e-4 * sag) << load << " N";
    EXPECT_NEAR(world.attachments()[0].force.z() + world.attachments()[1].force.z(), -load - 0.1 * gravity, 1e-6);
    // It stands: what settles and what moves have one law.
    for (int i = 0; i < 100; ++i) ASSERT_EQ(world.step({}).status, Status::ok);
    EXPECT_NEAR(-world.cables()[0].state.positions[n / 2].z(), sag, 1e-4 * sag) << load << " N";
  }
}

TEST(Loads, ABodyBeginsToMoveAsNewtonAndEulerSay) {
  const SceneDesc scene = free_body();
  const double h = scene.time_step, mass = scene.bodies[0].mass;
  const Vector3 force(3, -2, 5), torque(0.3, 0.1, -0.2);
  const Vector3 inertia = *scene.bodies[0].inertia;
  for (const bool is_local : {false, true}) {
    World world(scene, initial_frames(scene));
    const Quaternion axes = world.bodies()[0].pose.orientation;
    edit::ApplyLoad load = on_body("push", force, torque);
    load.is_local = is_local;
    ASSERT_TRUE(world.apply(load).ok);
    ASSERT_EQ(world.step({}).status, Status::ok);
    const Vector3 f = is_local ? Vector3(axes * force) : force;
    const Vector3 t = is_local ? torque : Vector3(axes.conjugate() * torque);
    const SimulatedBody& body = world.bodies()[0];
    // It turns by some 1e-6 rad meanwhile, and what is in its axes with it.
    const double turned = 1e-5;
    EXPECT_LT((body.velocity - h / mass * f).norm(), (is_local ? turned : 1e-9) * h / mass * f.norm()) << is_local;
    const Vector3 spin = h * t.cwiseQuotient(inertia);
    EXPECT_LT((axes.conjugate() * body.angular_velocity - spin).norm(), turned * spin.norm()) << is_local;
  }
  World thrust(scene, initial_frames(scene));
  edit::ApplyLoad forward = on_body("forward", force);
  forward.is_local = true;
  ASSERT_TRUE(thrust.apply(forward).ok);
  thrust.step({});
  const Vector3 gained = h / mass * (thrust.bodies()[0].pose.orientation * force);
  EXPECT_LT((thrust.bodies()[0].velocity - gained).norm(), 1e-9 * gained.norm());
  // A torque about an axis of inertia.
  World world(scene, initial_frames(scene));
  const Quaternion axes = world.bodies()[0].pose.orientation;
  edit::ApplyLoad turn = on_body("turn", Vector3::Zero(), {0, 0, 0.7});
  turn.is_local = true;
  ASSERT_TRUE(world.apply(turn).ok);
  world.step({});
  const Vector3 spin = axes.conjugate() * world.bodies()[0].angular_velocity;
  EXPECT_LT((spin - Vector3(0, 0, h * 0.7 / inertia.z())).norm(), 1e-9 * spin.norm());
  EXPECT_EQ(world.bodies()[0].velocity.norm(), 0);
}

TEST(Loads, AForceAtAPointTurnsItsBody) {
  const SceneDesc scene = free_body();
  World world(scene, initial_frames(scene));
  const Pose pose = world.bodies()[0].pose;
  const Vector3 point(0.4, 0.1, -0.2), force(3, -2, 5);
  edit::ApplyLoad load = on_body("push", force);
  load.point = point;
  ASSERT_TRUE(world.apply(load).ok);
  world.step({});
  const Vector3 arm = pose.orientation * (point - scene.bodies[0].center_of_mass.value());
  const Vector3 torque = pose.orientation.conjugate() * arm.cross(force);
  const Vector3 spin = scene.time_step * torque.cwiseQuotient(*scene.bodies[0].inertia);
  EXPECT_LT((pose.orientation.conjugate() * world.bodies()[0].angular_velocity - spin).norm(), 1e-4 * spin.norm());
  EXPECT_LT((world.bodies()[0].velocity - scene.time_step / 2 * force).norm(), 1e-12);
}

/// A cable that nothing holds moves off with what pushes it, whatever it is made of.
TEST(Loads, AFreeCableGainsTheImpulse) {
  for (const double bending : {0.0, 0.01})
    for (const double stiffness : {infinity, 1e3}) {
      SceneDesc scene = scenes::one_cable(20);
      scene.gravity.acceleration.setZero();
      scene.materials[0].material.bending_stiffness = bending;
      scene.materials[0].material.axial_stiffness = stiffness;
      World world(scene, initial_frames(scene));
      const Vector3 force(0.1, 0.3, -0.2);
      ASSERT_TRUE(world.apply(on_node("push", 0, 7, force)).ok);
      for (int i = 1; i <= 50; ++i) {
        ASSERT_EQ(world.step({}).status, Status::ok);
        Vector3 momentum = Vector3::Zero();
        const CableState& state = world.cables()[0].state;
        for (int k = 0; k < state.nodes(); ++k) momentum += state.masses[k] * state.velocities[k];
        ASSERT_LT((momentum - i * scene.time_step * force).norm(), 1e-9 * i * scene.time_step * force.norm()) << i;
      }
    }
}

/// Where a load acts, in the world now.
Vector3 place_of(const World& world, const Load& load) {
  if (load.body.is_cable()) return world.cables()[load.body.index].state.positions[load.node];
  return (world.bodies()[load.body.index].pose * Pose{load.point}).position;
}

TEST(Loads, WorkIsForceTimesWay) {
  SceneDesc scene = free_body();
  CableDesc& cable = scene.cables.emplace_back(scenes::one_cable(20).cables[0]);
  scene.materials = scenes::one_cable(1).materials;
  scene.materials[0].material.bending_stiffness = 1e-3;
  cable.attachments = {scenes::attachment("top", PlaceDesc::At::start, {3, 0, 0})};
  scene.gravity.acceleration = {0, 0, -gravity};
  scene.bodies[0].angular_velocity = Vector3(1, 2, 3);
  World world(scene, initial_frames(scene));
  edit::ApplyLoad push = on_body("push", {3, -2, 25});
  push.point = Vector3(0.12, -0.2, 0.3);
  ASSERT_TRUE(world.apply(push).ok);
  ASSERT_TRUE(world.apply(on_node("pull", 0, 9, {0.2, 0.1, 0.05})).ok);
  const Vector3 pushed = place_of(world, *find_load(world, "push")), pulled = place_of(world, *find_load(world, "pull"));
  for (int i = 0; i < 1000; ++i) ASSERT_EQ(world.step({}).status, Status::ok);
  const double work = push.force.dot(place_of(world, *find_load(world, "push")) - pushed) +
                      Vector3(0.2, 0.1, 0.05).dot(place_of(world, *find_load(world, "pull")) - pulled);
  const Ledger ledger = world.ledger();
  EXPECT_GT(std::abs(work), 1);
  EXPECT_NEAR(ledger.balance.work.applied, work, 1e-9 * std::abs(work));
  EXPECT_NEAR(ledger.unaccounted(), 0, 1e-6 * std::abs(work));
  EXPECT_EQ(ledger.unaccounted_steps, 0);
}

/// About an axis of inertia: torque times angle, but for what an angle is less than its Cayley vector, (spin h)^2 / 12.
TEST(Loads, WorkIsTorqueTimesTurn) {
  const SceneDesc scene = free_body();
  World world(scene, initial_frames(scene));
  const Vector3 axis = world.bodies()[0].pose.orientation * Vector3::UnitY();
  ASSERT_TRUE(world.apply(on_body("turn", Vector3::Zero(), 0.5 * axis)).ok);
  const double inertia = 0.2, time = 1;
  scenes::run(world, 1000);
  const double spin = 0.5 / inertia * time;
  EXPECT_NEAR(world.bodies()[0].angular_velocity.dot(axis), spin, 1e-5 * spin);
  EXPECT_NEAR(world.ledger().balance.work.applied, 0.5 * 0.5 * spin * time, 1e-5);
  EXPECT_NEAR(world.ledger().unaccounted(), 0, 1e-9);
}

/// In the axes of a body that spins at w a force F turns: v = F / (m w) (sin w t, 1 - cos w t).
TEST(Loads, LocalAxesTurnWithTheirBody) {
  constexpr double spin = 4, force = 3, time = 1;
  std::vector<double> errors;
  for (const double h : {2e-3, 1e-3}) {
    SceneDesc scene = free_body();
    scene.time_step = h;
    scene.bodies[0].pose = InitialPose{};
    scene.bodies[0].angular_velocity = Vector3(0, 0, spin);
    World world(scene, initial_frames(scene));
    const Vector3 start = world.bodies()[0].velocity;
    edit::ApplyLoad thrust = on_body("thrust", {force, 0, 0});
    thrust.is_local = true;
    ASSERT_TRUE(world.apply(thrust).ok);
    scenes::run(world, static_cast<int>(std::lround(time / h)));
    const double scale = force / (2 * spin);
    const Vector3 expected(scale * std::sin(spin * time), scale * (1 - std::cos(spin * time)), 0);
    errors.push_back((world.bodies()[0].velocity - start - expected).norm() / scale);
    const SimulatedBody& body = world.bodies()[0];
    const double gained = 0.5 * 2 * body.velocity.squaredNorm();
    EXPECT_NEAR(world.ledger().balance.work.applied, gained, 1e-9);
  }
  EXPECT_LT(errors[1], 2e-5);
  EXPECT_NEAR(errors[0] / errors[1], 4, 0.2);
}

/// A body on a cable that bends, a force at a point beside it, in its own axes or not: whatever the scheme, the ledger closes,
/// and a step that its solver takes converges at once.
TEST(Loads, BodiesOnCablesKeepTheLedger) {
  for (const bool is_local : {false, true}) {
    SceneDesc scene = free_body();
    scene.materials = scenes::one_cable(1).materials;
    scene.materials[0].material.bending_stiffness = 0.01;
    scene.materials[0].material.torsional_stiffness = 0.01;
    scene.gravity.acceleration = {0, 0, -gravity};
    scene.bodies[0].mass = 0.3;
    scene.bodies[0].inertia = Vector3(1e-3, 2e-3, 2.5e-3);
    scene.bodies[0].center_of_mass = Vector3(0, 0, 0.02);
    scene.bodies[0].pose.reset();
    CableDesc& cable = scene.cables.emplace_back(scenes::one_cable(20).cables[0]);
    cable.attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 0}),
                         scenes::attachment("plug", PlaceDesc::At::end, {0, 0, 0}, "", AttachmentType::clamp)};
    cable.attachments[1].body = "body";
    World world(scene, initial_frames(scene));
    edit::ApplyLoad push = on_body("push", {0.4, 0.2, 0.3}, {0.01, 0.005, 0});
    push.point = Vector3(0.01, 0.02, 0.03);
    push.is_local = is_local;
    ASSERT_TRUE(world.apply(push).ok);
    int iterations = 0;
    for (int i = 0; i < 1000; ++i) {
      const StepResult result = world.step({});
      ASSERT_EQ(result.status, Status::ok) << i;
      iterations = std::max(iterations, result.iterations);
      // Thrust that is switched on and off.
      if (i % 100 == 99) {
        push.force = -push.force;
        ASSERT_TRUE(world.apply(push).ok);
      }
    }
    EXPECT_LE(iterations, 12);
    EXPECT_GT(std::abs(world.ledger().balance.work.applied), 1e-3);
    EXPECT_LT(std::abs(world.ledger().unaccounted()), 1e-5 * world.energy().kinetic + 1e-5);
    EXPECT_EQ(world.ledger().unaccounted_steps, 0) << is_local;
  }
}

/// Noise, another force in every step: none of it comes from nowhere, though it sets motion going that steps do not resolve.
TEST(Loads, ThatChangeInEveryStepMakeNoEnergy) {
  for (const double bending : {0.0, 0.02}) {
    SceneDesc scene = free_body();
    scene.time_step = 2e-3;
    scene.materials = scenes::one_cable(1).materials;
    scene.materials[0].material.bending_stiffness = scene.materials[0].material.torsional_stiffness = bending;
    scene.gravity.acceleration = {0, 0, -gravity};
    scene.bodies[0].mass = 0.3;
    scene.bodies[0].inertia = Vector3(1e-3, 1e-3, 1.5e-3);
    scene.bodies[0].center_of_mass.reset();
    scene.bodies[0].pose.reset();
    CableDesc& cable = scene.cables.emplace_back(scenes::one_cable(20).cables[0]);
    const AttachmentType type = bending > 0 ? AttachmentType::clamp : AttachmentType::hinge;
    cable.attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 0}),
                         scenes::attachment("plug", PlaceDesc::At::end, {0, 0, 0}, "", type)};
    cable.attachments[1].body = "body";
    World world(scene, initial_frames(scene));
    std::mt19937 random(1);
    std::uniform_real_distribution<double> number(-1.5, 1.5);
    const auto force = [&] { return Vector3(number(random), number(random), number(random)); };
    for (int i = 0; i < 1000; ++i) {
      edit::ApplyLoad push = on_body("push", force(), 0.01 * force());
      push.is_local = i % 3 == 0;
      ASSERT_TRUE(world.apply(push).ok);
      ASSERT_TRUE(world.apply(on_node("pull", 0, 10, 0.3 * force())).ok);
      ASSERT_EQ(world.step({}).status, Status::ok) << i;
    }
    EXPECT_GT(world.ledger().balance.dissipated.unresolved, 0.01);
    EXPECT_EQ(world.ledger().unaccounted_steps, 0) << bending;
    EXPECT_LT(std::abs(world.ledger().unaccounted()), 1e-6) << bending;
  }
}

/// What holds a node feels what is applied to it.
TEST(Loads, HeldNodesPassTheirsOn) {
  for (const double stiffness : {infinity, 1e4}) {
    SceneDesc scene = scenes::between_two_points(20, 0.8);
    scene.materials[0].material.axial_stiffness = stiffness;
    World plain(scene, initial_frames(scene)), loaded = plain;
    const Vector3 force(1, 2, 3);
    ASSERT_TRUE(loaded.apply(on_node("push", 0, 20, force)).ok);
    for (int i = 0; i < 20; ++i) {
      plain.step({});
      loaded.step({});
      const Vector3 more = loaded.attachments()[1].force - plain.attachments()[1].force;
      ASSERT_LT((more - force).norm(), 1e-6 * force.norm()) << i;
      ASSERT_LT((loaded.attachments()[0].force - plain.attachments()[0].force).norm(), 1e-6) << i;
    }
    EXPECT_EQ(loaded.ledger().balance.work.applied, 0);
  }
}

TEST(Loads, OfOneNameReplaceEachOtherAndEndWithNothing) {
  const SceneDesc scene = free_body();
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(on_body("push", {1, 0, 0})).ok);
  ASSERT_TRUE(world.apply(on_body("other", {0, 1, 0})).ok);
  ASSERT_TRUE(world.apply(on_body("push", {0, 0, 2})).ok);
  ASSERT_EQ(world.loads().size(), 2u);
  world.step({});
  EXPECT_LT((world.bodies()[0].velocity - 1e-3 / 2 * Vector3(0, 1, 2)).norm(), 1e-12);
  ASSERT_TRUE(world.apply(on_body("push", Vector3::Zero())).ok);
  ASSERT_EQ(world.loads().size(), 1u);
  EXPECT_EQ(world.loads()[0].name, "other");
  EXPECT_TRUE(world.apply(on_body("push", Vector3::Zero())).ok);
  EXPECT_EQ(world.apply(on_body("", {1, 0, 0})).name, "load1");
  EXPECT_EQ(world.apply(on_body("", {1, 0, 0})).name, "load2");
  EXPECT_TRUE(world.findings().ended_loads.empty());
}

/// In each step that begins before its time has run out, and in at least one.
TEST(Loads, EndWithTheirTime) {
  for (const auto& [duration, steps] : {std::pair{0.01, 10}, std::pair{0.0101, 11}, std::pair{1e-6, 1}, std::pair{0.3, 300}}) {
    const SceneDesc scene = free_body();
    World world(scene, initial_frames(scene));
    scenes::run(world, 7);
    edit::ApplyLoad push = on_body("push", {1, 0, 0});
    push.duration = duration;
    ASSERT_TRUE(world.apply(push).ok);
    for (int i = 1; i <= steps + 3; ++i) {
      world.step({});
      EXPECT_EQ(world.loads().size(), i < steps ? 1u : 0u) << duration << " s, step " << i;
      ASSERT_EQ(world.findings().ended_loads.size(), i == steps ? 1u : 0u);
      if (i != steps) continue;
      EXPECT_EQ(world.findings().ended_loads[0].name, "push");
      EXPECT_EQ(world.findings().ended_loads[0].on, "body");
      EXPECT_TRUE(world.findings().ended_loads[0].ran_out);
    }
    EXPECT_NEAR(world.bodies()[0].velocity.x(), steps * 1e-3 / 2, 1e-12);
  }
}

TEST(Loads, AreState) {
  SceneDesc scene = scenes::between_two_points(20, 0.8);
  scene.materials[0].material.bending_stiffness = 1e-3;
  World world(scene, initial_frames(scene));
  const World before = world;
  ASSERT_TRUE(world.apply(on_node("push", 0, 5, {0.1, 0.2, 0}, 0.05)).ok);
  EXPECT_NE(world.hash(), before.hash());
  scenes::run(world, 20);
  World copy = world;
  EXPECT_EQ(copy.hash(), world.hash());
  scenes::run(world, 60);
  scenes::run(copy, 60);
  EXPECT_EQ(copy.hash(), world.hash());
  EXPECT_TRUE(world.loads().empty());
}

TEST(Loads, FollowTheirNodesThroughCutsAndJoins) {
  SceneDesc scene = scenes::one_cable(20);
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(on_node("near", 0, 4, {0, 1, 0})).ok);
  ASSERT_TRUE(world.apply(on_node("far", 0, 15, {0, 0, 1})).ok);
  ASSERT_TRUE(world.apply(edit::Cut{cable_id(0), 9}).ok);
  EXPECT_EQ(find_load(world, "near")->body, cable_id(0));
  EXPECT_EQ(find_load(world, "near")->node, 4);
  EXPECT_EQ(find_load(world, "far")->body, cable_id(1));
  EXPECT_EQ(find_load(world, "far")->node, 5);
  scenes::run(world, 10);
  const Vector3 place = place_of(world, *find_load(world, "far"));
  // The second piece turns round to be joined by its end.
  ASSERT_TRUE(world.apply(edit::Join{0, true, 1, true}).ok);
  EXPECT_EQ(find_load(world, "far")->body, cable_id(0));
  EXPECT_LT((place_of(world, *find_load(world, "far")) - place).norm(), 1e-12);
  for (int i = 0; i < 2000 && world.cables()[0].state.segments() != 19; ++i) world.step({});
  EXPECT_EQ(find_load(world, "near")->node, 4);
  EXPECT_EQ(find_load(world, "far")->node, 19 - 5 - 1 + 1);
}

/// Loads draw two cables to and fro that are joined meanwhile: what their ends lose as they meet is in the ledger.
TEST(Loads, OnCablesThatAreJoinedKeepTheLedger) {
  for (const double stiffness : {infinity, 1e4}) {
    SceneDesc scene = scenes::one_cable(20);
    scene.time_step = 2e-3;
    scene.materials[0].material.axial_stiffness = stiffness;
    scene.cables[0].attachments = {scenes::attachment("left", PlaceDesc::At::start, {0, 0, 0})};
    scene.cables.push_back(scene.cables[0]);
    scene.cables[1].name = "other";
    scene.cables[1].attachments = {scenes::attachment("right", PlaceDesc::At::start, {0.3, 0, 0})};
    World world(scene, initial_frames(scene));
    ASSERT_TRUE(world.apply(on_node("x", 0, 20, {0.1, 0.2, 0})).ok);
    ASSERT_TRUE(world.apply(on_node("y", 1, 20, {0.1, -0.2, 0})).ok);
    ASSERT_TRUE(world.apply(on_node("z", 1, 5, {0, -0.2, 0})).ok);
    scenes::run(world, 200);
    ASSERT_TRUE(world.apply(edit::Join{0, true, 1, true}).ok);
    scenes::run(world, 1000);
    ASSERT_EQ(world.cables()[0].state.segments(), 40);
    EXPECT_EQ(world.ledger().unaccounted_steps, 0) << stiffness;
    EXPECT_LT(std::abs(world.ledger().unaccounted()), 1e-5) << stiffness;
  }
}

/// A break in a step renumbers what it still pulls.
TEST(Loads, StayWithTheirPieceWhenACableBreaks) {
  SceneDesc scene = scenes::one_cable(20);
  scene.materials[0].material.breaking_tension = 3;
  scene.cables[0].attachments = {scenes::attachment("top", PlaceDesc::At::start, {0, 0, 0})};
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(on_node("pull", 0, 4, {0, 0, -5})).ok);
  for (int i = 0; i < 200 && world.cables().size() == 1; ++i) world.step({});
  ASSERT_EQ(world.cables().size(), 2u);
  const Load& pull = *find_load(world, "pull");
  EXPECT_EQ(pull.body, cable_id(1));
  EXPECT_EQ(pull.node, 4 - (world.cables()[0].state.segments() + 1));
  scenes::run(world, 50);
  const SimulatedCable& piece = world.cables()[1];
  Vector3 momentum = Vector3::Zero();
  for (int k = 0; k < piece.state.nodes(); ++k) momentum += piece.state.masses[k] * piece.state.velocities[k];
  ASSERT_EQ(world.cables().size(), 2u);
  EXPECT_LT(momentum.z(), -0.05 * (5 + mass_of(piece) * gravity));
}

TEST(Loads, FollowTheirNodesAtWinchesUntilTheseTakeThemIn) {
  for (const bool at_end : {false, true}) {
    SceneDesc scene = scenes::one_cable(20);
    scene.cables[0].attachments = {scenes::attachment("winch", at_end ? PlaceDesc::At::end : PlaceDesc::At::start, {0, 0, 0})};
    World world(scene, initial_frames(scene));
    const int node = at_end ? 12 : 8;
    ASSERT_TRUE(world.apply(on_node("push", 0, node, {0.01, 0, 0})).ok);
    const auto from_winch = [&] {
      const Load& load = *find_load(world, "push");
      const CableState& state = world.cables()[0].state;
      return at_end ? state.length(load.node, state.segments()) : state.length(0, load.node);
    };
    const double start = from_winch();
    ASSERT_TRUE(world.apply(edit::SetLength{0, at_end, 1.5, 1}).ok);
    scenes::run(world, 1500);
    EXPECT_NEAR(from_winch(), start + 0.5, 1e-6);
    EXPECT_EQ(find_load(world, "push")->node, at_end ? 12 : 18);
    ASSERT_TRUE(world.apply(edit::SetLength{0, at_end, 0.4, 1}).ok);
    std::vector<EndedLoad> ended;
    for (int i = 0; i < 2500; ++i) {
      world.step({});
      for (const EndedLoad& load : world.findings().ended_loads) ended.push_back(load);
    }
    EXPECT_NEAR(world.cables()[0].state.length(), 0.4, 1e-3);
    ASSERT_EQ(ended.size(), 1u);
    EXPECT_EQ(ended[0].name, "push");
    EXPECT_EQ(ended[0].on, "cable");
    EXPECT_FALSE(ended[0].ran_out);
    EXPECT_TRUE(world.loads().empty());
  }
}

/// What slides through an eyelet takes its loads along.
TEST(Loads, GoThroughGuidesWithTheMaterial) {
  SceneDesc scene = scenes::one_cable(50, 2);
  scene.cables[0].point_masses = {scenes::payload(0.1), scenes::payload(0.15)};
  scene.cables[0].point_masses[0].place.at = PlaceDesc::At::start;
  scene.cables[0].initial.type = InitialShapeDesc::Type::points;
  scene.cables[0].initial.points = {{-0.2, 0, -0.9}, {0, 0, 0}, {0.3, 0, -1}};
  GuideDesc& eye = scene.guides.emplace_back();
  eye.name = "eye";
  eye.cable = "cable";
  eye.place = PlaceDesc{PlaceDesc::At::arc_length, 1};
  World world(scene, {});
  ASSERT_TRUE(world.apply(on_node("push", 0, 20, {0, 1e-3, 0})).ok);
  // [m] From the end that goes down.
  const auto to_end = [&] {
    const CableState& state = world.cables()[0].state;
    return state.length(find_load(world, "push")->node, state.segments());
  };
  const double start = to_end();
  int guide_node = 0;
  for (int i = 0; i < 1500; ++i) {
    ASSERT_EQ(world.step({}).status, Status::ok);
    ASSERT_NE(find_load(world, "push"), nullptr);
    for (const Attachment& attachment : world.attachments())
      if (attachment.guide >= 0) guide_node = attachment.node;
    if (find_load(world, "push")->node > guide_node + 3) break;
  }
  EXPECT_GT(find_load(world, "push")->node, guide_node);
  // To within a segment: another node stands for the material.
  EXPECT_NEAR(to_end(), start, 0.04);
}

/// Those of cables that would be stepped in lanes, too.
TEST(Loads, GiveTheSameBytesOnAnyNumberOfLanesAndThreads) {
  SceneDesc scene = scenes::one_cable(20);
  scene.materials[0].material.bending_stiffness = 1e-3;
  const CableDesc cable = scene.cables[0];
  scene.cables.clear();
  for (int i = 0; i < 40; ++i) {
    CableDesc& copy = scene.cables.emplace_back(cable);
    copy.name = "cable_" + std::to_string(i);
    copy.attachments = {scenes::attachment("top_" + std::to_string(i), PlaceDesc::At::start, {0.0, 0.3 * i, 0})};
    copy.initial.type = InitialShapeDesc::Type::straight;
    copy.initial.from = {0, 0.3 * i, 0};
    copy.initial.to = {1, 0.3 * i, 0};
  }
  World world(scene, initial_frames(scene));
  for (int i = 0; i < 40; i += 3) ASSERT_TRUE(world.apply(on_node("push_" + std::to_string(i), i, 10, {0, 0.1, 0.2}, 0.05)).ok);
  World one_by_one = world, narrow = world, plain(scene, initial_frames(scene));
  one_by_one.step_one_by_one(true);
  narrow.limit_lanes(2);
  for (World* other : {&world, &one_by_one, &narrow, &plain}) scenes::run(*other, 100);
  EXPECT_EQ(one_by_one.hash(), world.hash());
  EXPECT_EQ(narrow.hash(), world.hash());
  // The others know nothing of them.
  for (int i = 0; i < 40; ++i) {
    const bool is_same = world.cables()[i].state.positions == plain.cables()[i].state.positions;
    EXPECT_EQ(is_same, i % 3 != 0) << i;
  }
}

TEST(Loads, WhatCannotBeAppliedChangesNothing) {
  SceneDesc scene = free_body();
  scene.materials = scenes::one_cable(1).materials;
  scene.cables = scenes::one_cable(10).cables;
  World world(scene, initial_frames(scene));
  ASSERT_TRUE(world.apply(on_node("push", 0, 5, {1, 0, 0})).ok);
  const std::uint64_t before = world.hash();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect_refused = [&](const edit::ApplyLoad& load, const std::string& reason) {
    const EditResult result = world.apply(load);
    EXPECT_FALSE(result.ok) << reason;
    EXPECT_NE(result.message.find(reason), std::string::npos) << result.message;
    EXPECT_EQ(world.hash(), before) << reason;
  };
  expect_refused(on_node("push", 0, 11, {1, 0, 0}), "node: 11; must be from 0 to 10");
  expect_refused(on_node("push", 1, 0, {1, 0, 0}), "cable: 1");
  expect_refused(on_node("push", 0, 1, {1, nan, 0}), "force.y: nan; allowed: finite numbers [N]");
  expect_refused(on_node("push", 0, 1, {1, 0, 2e9}), "force.z: 2e+09");
  expect_refused(on_node("push", 0, 1, {1, 0, 0}, -1), "duration: -1; allowed: 0 or more [s]");
  expect_refused(on_node("push", 0, 1, {1, 0, 0}, nan), "duration: nan");
  expect_refused(on_body("push", {0, 0, 0}, {0, 0, infinity}), "torque.z: inf; allowed: finite numbers [N m]");
  edit::ApplyLoad torque = on_node("push", 0, 1, {1, 0, 0});
  torque.torque = {0, 0, 1};
  expect_refused(torque, "torque: a node of a cable takes a force only");
  edit::ApplyLoad beside = on_body("push", {1, 0, 0});
  beside.point = Vector3(0, nan, 0);
  expect_refused(beside, "point.y: nan");
  beside.body = rigid_body_id(1);
  expect_refused(beside, "body: 1");
  beside.body = particle_id(0);
  expect_refused(beside, "body: must be a cable or a rigid body");
}

TEST(Loads, AreNotMoreThanThereMayBe) {
  const SceneDesc scene = free_body();
  World world(scene, initial_frames(scene));
  for (int i = 0; i < 10000; ++i) ASSERT_TRUE(world.apply(on_body("push_" + std::to_string(i), {1, 0, 0})).ok);
  EXPECT_FALSE(world.apply(on_body("one_more", {1, 0, 0})).ok);
  EXPECT_TRUE(world.apply(on_body("push_0", {2, 0, 0})).ok);
  EXPECT_EQ(world.loads().size(), 10000u);
}

}  // namespace
}  // namespace verlet_cable
