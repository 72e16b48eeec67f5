#include <gtest/gtest.h>

#include <cmath>

#include "../support/meshes.h"
#include "../support/nets.h"

namespace verlet_cable {
namespace {

using scenes::run;

double length(const SimulatedNet& net, int link) {
  return (1 + strain(net, link)) * net.model.rest_lengths[link];
}

Vector3 momentum(const SimulatedNet& net) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < net.model.nodes(); ++i) sum += net.model.masses[i] * net.state.velocities[i];
  return sum;
}

Vector3 angular_momentum(const SimulatedNet& net) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < net.model.nodes(); ++i) sum += net.model.masses[i] * net.state.positions[i].cross(net.state.velocities[i]);
  return sum;
}

/// A wall, and a mass on a spring that is let go 10 cm too long.
SceneDesc oscillator(double stiffness, double damping) {
  SceneDesc scene = scenes::weightless();
  NetDesc net = scenes::chain({{0, 0, 0}, {1, 0, 0}}, LinkType::spring);
  net.stiffness = stiffness;
  net.damping = damping;
  net.masses = {1, 1};
  net.mass = 0;
  net.velocity = {0.5, 0, 0};
  net.attachments = {scenes::net_attachment("wall", 0, {0, 0, 0})};
  scene.nets = {net};
  return scene;
}

TEST(Net, DampedOscillatorFollowsItsClosedForm) {
  const double k = 100, c = 2, decay = c / 2, omega = std::sqrt(k - decay * decay);
  const SceneDesc scene = oscillator(k, c);
  World world(scene, initial_frames(scene));
  for (int i = 1; i <= 3000; ++i) {
    ASSERT_EQ(world.step({FrameInput{}}).status, StepResult::Status::ok);
    const double t = world.time();
    const double x = 1 + 0.5 / omega * std::exp(-decay * t) * std::sin(omega * t);
    // Second order: (omega h)^2 / 24 of the phase a radian, 4e-6 after 30 of them, of 5 cm.
    ASSERT_NEAR(world.nets()[0].state.positions[1].x(), x, 1e-5) << t;
  }
}

TEST(Net, SpringsHangAsHookeSays) {
  for (const LinkType type : {LinkType::spring, LinkType::limited}) {
    SceneDesc scene;
    NetDesc net = scenes::chain({{0, 0, 0}, {0, 0, -0.5}}, type);
    net.stiffness = 200;
    net.damping = 20;
    net.mass = 2;
    net.tolerance = 0.5;
    net.attachments = {scenes::net_attachment("top", 0, {0, 0, 0})};
    scene.nets = {net};
    World world(scene, initial_frames(scene));
    run(world, 3000);
    EXPECT_NEAR(world.nets()[0].state.positions[1].z(), -0.5 - 9.81 / 200, 1e-6);
    EXPECT_NEAR(world.nets()[0].state.tension[0], 9.81, 1e-5);
    // What holds it carries the held node, too.
    EXPECT_NEAR(world.attachments()[0].force.z(), -2 * 9.81, 1e-4);
    EXPECT_TRUE(world.attachments()[0].body == net_id(0));
  }
}

TEST(Net, RigidAndLimitedLinksKeepMomentum) {
  for (const LinkType type : {LinkType::limited, LinkType::rigid}) {
    SceneDesc scene = scenes::weightless();
    NetDesc net = scenes::grid(5, 6, 0.1, type);
    net.tolerance = 0.02;
    net.stiffness = 10;
    net.damping = 0;
    scene.nets = {net};
    World world(scene, initial_frames(scene));
    // One node is pulled away and let go: links run into their limits on all sides.
    ASSERT_TRUE(world.apply(edit::Pin{"hand", net_id(0), 29, 0, {{0.7, 0.2, -0.2}, Quaternion::Identity()}}).ok);
    run(world, 200);
    ASSERT_TRUE(world.apply(edit::Unpin{"hand"}).ok);
    run(world, 1);
    const Vector3 before = momentum(world.nets()[0]), spin = angular_momentum(world.nets()[0]);
    ASSERT_GT(before.norm(), 0.01);
    run(world, 500);
    EXPECT_NEAR((momentum(world.nets()[0]) - before).norm(), 0, 1e-12 * 500);
    EXPECT_NEAR((angular_momentum(world.nets()[0]) - spin).norm(), 0, 2e-2 * spin.norm() + 1e-9);
  }
}

TEST(Net, NothingIsStretchedBeyondItsTolerance) {
  for (const double stiffness : {1.0, 500.0}) {
    SceneDesc scene = scenes::flag(16, 24, 0.05, LinkType::limited);
    scene.nets[0].stiffness = stiffness;
    World world(scene, initial_frames(scene));
    double largest = 0;
    for (int i = 0; i < 2000; ++i) {
      const StepResult result = world.step({FrameInput{}});
      ASSERT_EQ(result.status, StepResult::Status::ok) << i;
      largest = std::max(largest, result.max_strain);
    }
    EXPECT_LE(largest, 0.1);
    EXPECT_GT(largest, stiffness < 2 ? 0.09 : 0.001);
    for (int link = 0; link < static_cast<int>(world.nets()[0].model.links.size()); ++link)
      ASSERT_LE(std::abs(strain(world.nets()[0], link)), 0.1 + 1e-12);
  }
}

TEST(Net, LargeFlagStaysCalmAndWithinItsTolerance) {
  // So stiff that explicit springs would need steps of 0.1 ms, and far larger than its load travels in a step's sweeps.
  SceneDesc scene = scenes::flag(100, 100, 0.01, LinkType::limited);
  scene.nets[0].stiffness = 500;
  scene.nets[0].damping = 0.5;
  scene.fluid.velocity.setZero();
  World world(scene, initial_frames(scene));
  double weight = 0;
  const int steps = 400;
  for (int i = 0; i < steps; ++i) {
    const StepResult result = world.step({FrameInput{}});
    ASSERT_EQ(result.status, StepResult::Status::ok) << i;
    EXPECT_LE(result.max_strain, 0.1);
    for (const Attachment& attachment : world.attachments()) weight -= attachment.force.z() / steps;
  }
  // What holds it has taken its weight and its momentum.
  double momentum = 0, fastest = 0;
  for (const Vector3& v : world.nets()[0].state.velocities) {
    momentum += 0.2 / 10000 * v.z();
    fastest = std::max(fastest, v.norm());
  }
  EXPECT_NEAR(weight, -0.2 * -9.81 + momentum / (steps * scene.time_step), 0.05 * 0.2 * 9.81);
  EXPECT_LT(fastest, 2.0);
}

TEST(Net, ElasticFlagSagsFarBeyondTheTolerance) {
  SceneDesc scene = scenes::flag(16, 24, 0.05, LinkType::spring);
  scene.nets[0].stiffness = 3;
  scene.nets[0].damping = 0.02;
  World world(scene, initial_frames(scene));
  double largest = 0;
  for (int i = 0; i < 2000; ++i) largest = std::max(largest, world.step({FrameInput{}}).max_strain);
  EXPECT_GT(largest, 0.5);
}

TEST(Net, WindPushesAGridByItsTriangles) {
  SceneDesc scene = scenes::weightless();
  scene.fluid.density = 1.2;
  scene.fluid.velocity = {3, 4, 0};
  NetDesc net = scenes::grid(3, 4, 0.1, LinkType::limited);
  net.mass = 100;
  scene.nets = {net};
  World world(scene, initial_frames(scene));
  run(world, 1);
  // 1/2 density normal_drag A v^2 with the wind across it, along y: the grid is in the plane of x and z.
  const double force = 0.5 * 1.2 * 1.2 * (0.3 * 0.2) * 16;
  EXPECT_NEAR(momentum(world.nets()[0]).y() / world.time(), force, 1e-3 * force);
  EXPECT_NEAR(momentum(world.nets()[0]).x(), 0, 1e-12);
}

TEST(Net, FigureKeepsItsStickLengthsDownTheStairs) {
  const SceneDesc scene = scenes::figure_on_stairs();
  World world(scene, initial_frames(scene));
  double lowest = infinity;
  for (int i = 0; i < 4000; ++i) {
    const StepResult result = world.step({FrameInput{}});
    ASSERT_EQ(result.status, StepResult::Status::ok) << i;
    ASSERT_LT(result.max_strain, 1e-3) << i;
    for (const Vector3& x : world.nets()[0].state.positions) lowest = std::min(lowest, x.z());
  }
  EXPECT_GT(lowest, -0.02);
  EXPECT_LT(world.nets()[0].state.positions[0].z(), 1.0);
  EXPECT_LT(world.energy().kinetic, 5);
}

TEST(Net, MinimumDistanceKeepsNodesApart) {
  SceneDesc scene;
  NetDesc net = scenes::chain({{-0.5, 0, 0}, {0, 0, 0.01}, {0.5, 0, 0}}, LinkType::rigid);
  net.minimum_distances = {{{0, 2}, 0.6}};
  net.attachments = {scenes::net_attachment("middle", 1, {0, 0, 0.01})};
  scene.nets = {net};
  World world(scene, initial_frames(scene));
  double least = infinity;
  for (int i = 0; i < 2000; ++i) {
    world.step({FrameInput{}});
    const std::vector<Vector3>& x = world.nets()[0].state.positions;
    least = std::min(least, (x[2] - x[0]).norm());
  }
  EXPECT_GT(least, 0.6 * (1 - 1e-3));
  EXPECT_LT(least, 0.61);
}

TEST(Net, WhatBlowsUpIsReportedAndStaysFinite) {
  SceneDesc scene = scenes::flag(6, 8, 0.05, LinkType::spring);
  scene.nets[0].mass = 1e-4;
  scene.nets[0].stiffness = 1e6;
  World world(scene, initial_frames(scene));
  bool degraded = false;
  for (int i = 0; i < 1000; ++i) {
    const StepResult result = world.step({FrameInput{}});
    degraded = degraded || (result.status == StepResult::Status::degraded && result.body == net_id(0));
    for (const Vector3& x : world.nets()[0].state.positions) ASSERT_TRUE(x.allFinite());
  }
  EXPECT_TRUE(degraded);
}

/// 0.1 kg, 0.4 m by 0.4 m, level, 5 cm above what it falls on.
SceneDesc cloth_above(const ObstacleDesc& obstacle, double stiffness, double damping) {
  SceneDesc scene;
  NetDesc net = scenes::grid(9, 9, 0.05, LinkType::spring);
  net.mass = 0.1;
  net.stiffness = stiffness;
  net.damping = damping;
  net.grid->origin = {-0.2, -0.2, 0.2};
  net.grid->x_axis = {1, 0, 0};
  net.grid->y_axis = {0, 1, 0};
  scene.nets = {net};
  scene.obstacles = {obstacle};
  return scene;
}

TEST(Net, OfSpringsLiesOnAMeshAsOnABox) {
  ObstacleDesc box;
  box.name = "box";
  box.type = ShapeType::box;
  box.size = {0.6, 0.6, 0.3};
  ObstacleDesc mesh = box;
  mesh.type = ShapeType::mesh;
  mesh.mesh = box_triangles(box.size).mesh();
  const SceneDesc on_box = cloth_above(box, 200, 0.1), on_mesh = cloth_above(mesh, 200, 0.1);
  World one(on_box, initial_frames(on_box)), other(on_mesh, initial_frames(on_mesh));
  run(one, 500);
  run(other, 500);
  for (int i = 0; i < 81; ++i) {
    EXPECT_GT(other.nets()[0].state.positions[i].z(), 0.15 - 1e-9);
    EXPECT_LT((other.nets()[0].state.positions[i] - one.nets()[0].state.positions[i]).norm(), 1e-9);
  }
}

TEST(Net, ThatIsStiffOrDampedIsCalmOnABall) {
  ObstacleDesc ball;
  ball.name = "ball";
  ball.type = ShapeType::sphere;
  ball.radius = 0.15;
  for (const auto& [stiffness, damping] : {std::pair{200.0, 0.5}, {200.0, 3.0}, {5e3, 0.5}, {5e4, 0.1}, {5e4, 2.0}}) {
    const SceneDesc scene = cloth_above(ball, stiffness, damping);
    World world(scene, initial_frames(scene));
    const double energy = world.energy().total();
    for (int i = 0; i < 1000; ++i) {
      const StepResult result = world.step({FrameInput{}});
      ASSERT_EQ(result.status, StepResult::Status::ok) << stiffness << " " << damping;
      ASSERT_LT(result.max_strain, 0.3) << stiffness << " " << damping << " " << i;
    }
    EXPECT_LT(world.energy().total(), energy);
  }
}

TEST(Net, ThatIsTooStiffForItsStepIsSoftenedAndReported) {
  SceneDesc scene = scenes::flag(6, 8, 0.05, LinkType::spring);
  scene.nets[0].mass = 1e-4;
  scene.nets[0].stiffness = 1e6;
  scene.nets[0].damping = 10;
  World world(scene, initial_frames(scene));
  for (int i = 0; i < 1000; ++i) {
    const StepResult result = world.step({FrameInput{}});
    ASSERT_EQ(result.status, StepResult::Status::degraded);
    ASSERT_EQ(result.cause, DegradedCause::too_stiff);
    ASSERT_TRUE(result.body == net_id(0));
    for (const Vector3& x : world.nets()[0].state.positions) ASSERT_LT(x.norm(), 2);
  }
}

TEST(Net, CopyGoesOnAlikeAfterEdits) {
  for (const LinkType type : {LinkType::spring, LinkType::limited}) {
    SceneDesc scene = scenes::flag(6, 8, 0.05, type);
    World world(scene, initial_frames(scene));
    run(world, 100);
    const EditResult pin = world.apply(edit::Pin{"", net_id(0), 44, 0, {{0.1, 0, -0.2}, Quaternion::Identity()}});
    ASSERT_TRUE(pin.ok) << pin.message;
    EXPECT_FALSE(world.apply(edit::Pin{"", net_id(0), 44, 0, {{0, 0, 0}, Quaternion::Identity()}}).ok);
    EXPECT_FALSE(world.apply(edit::Pin{"", net_id(0), 48, 0, {{0, 0, 0}, Quaternion::Identity()}}).ok);
    EXPECT_FALSE(world.apply(edit::Pin{"", net_id(1), 0, 0, {{0, 0, 0}, Quaternion::Identity()}}).ok);
    const std::size_t links = world.nets()[0].model.links.size();
    ASSERT_TRUE(world.apply(edit::Cut{net_id(0), 3}).ok);
    EXPECT_FALSE(world.apply(edit::Cut{net_id(0), static_cast<int>(links) - 1}).ok);
    EXPECT_FALSE(world.apply(edit::Cut{net_id(0), -1}).ok);
    EXPECT_EQ(world.nets()[0].model.links.size(), links - 1);
    run(world, 100);
    World copy = world;
    EXPECT_EQ(copy.hash(), world.hash());
    run(world, 300);
    EXPECT_NE(copy.hash(), world.hash());
    run(copy, 300);
    EXPECT_EQ(copy.hash(), world.hash());
    EXPECT_NEAR((world.nets()[0].state.positions[44] - Vector3(0.1, 0, -0.2)).norm(), 0, 1e-12);
    ASSERT_TRUE(world.apply(edit::Unpin{pin.name}).ok);
    run(world, 100);
  }
}

TEST(Net, WaitsForItsFrames) {
  SceneDesc scene = scenes::flag(3, 3, 0.05, LinkType::limited);
  scene.nets[0].attachments[0].frame = "pole";
  BoundaryInputs inputs(2);
  inputs[1].known = false;
  World world(scene, inputs);
  EXPECT_TRUE(world.nets().empty());
  EXPECT_EQ(world.findings().waiting, std::vector<std::string>{"flag"});
  inputs[1].known = true;
  EXPECT_EQ(world.start_waiting(inputs), 1);
  ASSERT_EQ(world.nets().size(), 1u);
  inputs[1].pose.position = {0.1, 0, 0};
  for (int i = 0; i < 500; ++i) world.step(inputs);
  EXPECT_NEAR(world.nets()[0].state.positions[0].x(), 0.1, 1e-12);
}

TEST(Net, RigidPendulumKeepsItsEnergy) {
  SceneDesc scene;
  NetDesc net = scenes::chain({{0, 0, 0}, {0.5, 0, 0}, {1, 0, 0}}, LinkType::rigid);
  net.attachments = {scenes::net_attachment("top", 0, {0, 0, 0})};
  scene.nets = {net};
  World world(scene, initial_frames(scene));
  const double energy = world.energy().total();
  double largest = 0;
  for (int i = 0; i < 5000; ++i) {
    world.step({FrameInput{}});
    largest = std::max(largest, std::abs(world.energy().total() - energy));
    ASSERT_LT(length(world.nets()[0], 1), 0.5 * (1 + 1e-3));
  }
  // Of the weight times the length; lengths are free within a part in a thousand.
  EXPECT_LT(largest, 0.02 * 9.81);
}

}  // namespace
}  // namespace verlet_cable
