#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

#include "../support/meshes.h"
#include "../support/scenes.h"
#include "chain/point_motion.h"
#include "rod/block_elimination.h"
#include "verlet_cable/core/world.h"

// Friction acts where surfaces meet: points beside the centre line move with the cable as it turns.

namespace verlet_cable {
namespace {

constexpr double pi = 3.14159265358979323846;

CablePoint beside(int segment, double fraction, bool on_joint) {
  CablePoint point{0, segment, fraction};
  point.along = Vector3(0.9, 0.1, 0.2).normalized();
  point.across = Vector3(0.1, 0.3, 0.9).normalized();
  point.own = 0.3;
  if (on_joint) point.before = 0.2;
  return point;
}

/// What the point's displacement has of all nodes'.
Eigen::MatrixXd motion_of(const CablePoint& point, int nodes) {
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(3, 3 * nodes);
  for (int column = 0; column < 3 * nodes; ++column)
    motion.col(column) = at_point(
        point, [&](int i) -> Vector3 { return i == column / 3 ? Vector3(Vector3::Unit(column % 3)) : Vector3(Vector3::Zero()); });
  return motion;
}

Eigen::MatrixXd added_to(const KktSystem& system, int nodes) {
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(3 * nodes, 3 * nodes);
  for (int i = 0; i < nodes; ++i) {
    matrix.block<3, 3>(3 * i, 3 * i) = get(system.added, i);
    if (i + 1 == nodes) break;
    matrix.block<3, 3>(3 * i, 3 * i + 3) = get(system.added_next, i);
    matrix.block<3, 3>(3 * i + 3, 3 * i) = get(system.added_next, i).transpose();
  }
  return matrix;
}

TEST(ContactPoint, ForcesOnNodesDoTheWorkOfTheForceOnThePoint) {
  const int nodes = 5;
  for (const CablePoint& point : {beside(1, 0.3, false), beside(2, 0, true), CablePoint{0, 3, 0.7}}) {
    const Vector3 force(1, -2, 0.5);
    Eigen::VectorXd shared = Eigen::VectorXd::Zero(3 * nodes);
    share_force(point, force, [&](int i, const Vector3& part) { shared.segment<3>(3 * i) += part; });
    EXPECT_LT((shared - motion_of(point, nodes).transpose() * force).norm(), 1e-14);
  }
}

TEST(ContactPoint, StiffnessIsThatOfThePointsMotion) {
  const int nodes = 5;
  const Eigen::Matrix3d stiffness = Eigen::Vector3d(3, 5, 7).asDiagonal();
  for (const CablePoint& point : {beside(1, 0.3, false), CablePoint{0, 3, 0.7}}) {
    KktSystem system;
    system.resize(nodes - 1);
    system.add_stiffness(point, stiffness);
    const Eigen::MatrixXd motion = motion_of(point, nodes);
    EXPECT_LT((added_to(system, nodes) - motion.transpose() * stiffness * motion).norm(), 1e-13);
  }
  // At a joint, nodes two apart are not coupled: what is added is more.
  KktSystem system;
  system.resize(nodes - 1);
  const CablePoint point = beside(2, 0, true);
  system.add_stiffness(point, stiffness);
  const Eigen::MatrixXd motion = motion_of(point, nodes),
                        more = added_to(system, nodes) - motion.transpose() * stiffness * motion;
  const Eigen::VectorXd sizes = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(more).eigenvalues();
  EXPECT_GT(sizes.minCoeff(), -1e-12);
  EXPECT_LT(sizes.maxCoeff(), 1.2);
}

/// [m/s] At which two rollers of 20 mm that turn at 5 rad/s feed a straight cable of 4 mm, squeezed to a part of its radius.
double fed(double squeezed, int segments) {
  const double radius = 0.004, roller = 0.02, length = 0.6, rate = 5, start = 0.3;
  SceneDesc scene = scenes::one_cable(segments, length);
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.06;
  material.radius = radius;
  material.bending_stiffness = 2e-3;
  material.bending_damping = 2e-5;
  CableDesc& cable = scene.cables[0];
  cable.initial.type = InitialShapeDesc::Type::straight;
  cable.initial.from = {0.05 - length, 0, 0};
  cable.initial.to = {0.05, 0, 0};
  for (const double side : {1.0, -1.0}) {
    ObstacleDesc& desc = scene.obstacles.emplace_back();
    desc.name = desc.frame = side > 0 ? "upper" : "lower";
    desc.type = ShapeType::cylinder;
    desc.radius = roller;
    desc.length = 0.05;
    desc.pose = {0, 0, 0, pi / 2, 0, 0};
    desc.friction = 0.6;
    ObstacleDesc& guide = scene.obstacles.emplace_back();
    guide.name = side > 0 ? "in" : "out";
    guide.type = ShapeType::box;
    guide.size = {1, 0.2, 0.02};
    guide.pose = {-0.53 * side, 0, -radius - 0.01, 0, 0, 0};
    guide.friction = 0.05;
  }
  BoundaryInputs frames = initial_frames(scene);
  const auto place = [&](double time) {
    const double s = std::min(time / start, 1.0), closed = s * s * s * (10 - 15 * s + 6 * s * s);
    const double height = roller + radius * (squeezed + (1.3 - squeezed) * (1 - closed));
    const double angle = rate * std::max(0.0, time - start);
    for (std::size_t k = 1; k < frames.size(); ++k) {
      const double side = k == 1 ? 1 : -1;
      frames[k].known = true;
      frames[k].pose = {{0, 0, side * height}, Quaternion(Eigen::AngleAxisd(-side * angle, Vector3::UnitY()))};
    }
  };
  place(0);
  World world(scene, frames);
  const auto middle = [&] {
    double sum = 0;
    for (const Vector3& x : world.cables()[0].state.positions) sum += x.x() / (segments + 1);
    return sum;
  };
  double before = 0;
  for (int i = 1; i <= 1200; ++i) {
    place(i * scene.time_step);
    world.step(frames);
    if (i == 600) before = middle();
  }
  return (middle() - before) / 0.6;
}

TEST(ContactPoint, RollersFeedAtTheSpeedOfTheirSurfaces) {
  for (const double squeezed : {0.9, 0.95, 0.99})
    for (const int segments : {20, 60, 150}) EXPECT_NEAR(fed(squeezed, segments), 0.1, 1e-3) << squeezed << ", " << segments;
}

/// [N] The largest tension of two wires that are pressed together, all ends clamped in one frame that begins to turn smoothly.
double tension_turning_together(double friction, const Vector3& axis) {
  const double radius = 0.004, length = 0.3, rate = pi / 2, time = 0.4;
  SceneDesc scene = scenes::one_cable(30, length);
  scene.gravity.acceleration.setZero();
  scene.contact = ContactDesc{};
  scene.contact->friction = friction;
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.05;
  material.radius = radius;
  material.bending_stiffness = 0.01;
  material.bending_damping = 1e-5;
  material.axial_stiffness = 1e4;
  material.axial_damping = 1;
  scene.cables.push_back(scene.cables[0]);
  for (int k = 0; k < 2; ++k) {
    CableDesc& cable = scene.cables[k];
    const double z = k * 2 * radius * 0.97;
    cable.name = k == 0 ? "a" : "b";
    cable.initial.type = InitialShapeDesc::Type::straight;
    cable.initial.from = {-length / 2, 0, z};
    cable.initial.to = {length / 2, 0, z};
    for (const double end : {-1.0, 1.0}) {
      const PlaceDesc::At at = end < 0 ? PlaceDesc::At::start : PlaceDesc::At::end;
      AttachmentDesc clamp =
          scenes::attachment(cable.name + (end < 0 ? "l" : "r"), at, {end * length / 2, 0, z}, "f", AttachmentType::clamp);
      clamp.initial_pose = InitialPose{0, 0, 0, 0, 0, 0};
      cable.attachments.push_back(clamp);
    }
  }
  BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  for (int i = 0; i < 300; ++i) world.step(frames);
  double largest = 0;
  for (int i = 1; i <= 1000; ++i) {
    const double t = i * scene.time_step, s = std::min(t / time, 1.0);
    const double angle = rate * (t < time ? time * (2.5 * std::pow(s, 4) - 3 * std::pow(s, 5) + std::pow(s, 6)) : t - time / 2);
    frames[1].pose.orientation = Quaternion(Eigen::AngleAxisd(angle, axis));
    world.step(frames);
    for (const double tension : world.cables()[0].state.tension) largest = std::max(largest, std::abs(tension));
  }
  return largest;
}

TEST(ContactPoint, WiresThatTurnTogetherDoNotRub) {
  const double alone = tension_turning_together(0, Vector3::UnitY());
  EXPECT_NEAR(tension_turning_together(0.3, Vector3::UnitY()), alone, 0.03 * alone);
}

/// [N] The force of two smooth pads that squeeze a cable from both sides, as they slide along it by two segments.
struct Sliding {
  double least = infinity, most = 0, largest_change = 0;
};
Sliding sliding_pad(int segments, double width, ShapeType type) {
  const double radius = 0.004, length = 0.6, height = 0.01, squeeze = 0.02;
  SceneDesc scene = scenes::one_cable(segments, length);
  scene.gravity.acceleration.setZero();
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.06;
  material.radius = radius;
  material.bending_stiffness = 0.01;
  material.bending_damping = 1e-4;
  CableDesc& cable = scene.cables[0];
  cable.initial.type = InitialShapeDesc::Type::straight;
  cable.initial.from = {-length / 2, 0, radius};
  cable.initial.to = {length / 2, 0, radius};
  for (const double end : {-1.0, 1.0})
    cable.attachments.push_back(scenes::attachment(end < 0 ? "l" : "r", end < 0 ? PlaceDesc::At::start : PlaceDesc::At::end,
                                                   {end * length / 2, 0, radius}, "", AttachmentType::clamp));
  for (const double side : {1.0, -1.0}) {
    ObstacleDesc& pad = scene.obstacles.emplace_back();
    pad.name = side > 0 ? "above" : "below";
    pad.type = type;
    pad.frame = pad.name;
    pad.size = {width, 0.03, height};
    if (type == ShapeType::mesh) pad.mesh = box_triangles(pad.size).mesh();
    pad.friction = 0;
    pad.initial_pose = InitialPose{0, 0, radius + side * 0.02, 0, 0, 0};
  }
  BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  const double pressed = radius * (1 - squeeze) + height / 2, from = 0.1 * length / segments;
  Sliding sliding;
  double last = 0;
  // Slowly: what begins to touch is damped.
  const double way = 2 * length / segments, speed = 0.01;
  const int steps = 300 + static_cast<int>(way / speed / scene.time_step);
  for (int i = 1; i <= steps; ++i) {
    const double closed = std::min(i / 200.0, 1.0), slid = std::max(0, i - 300) * scene.time_step * speed;
    const double place = from + slid, apart = pressed + (1 - closed) * 0.01;
    for (std::size_t k = 1; k < frames.size(); ++k) {
      frames[k].known = true;
      frames[k].pose = {{place, 0, radius + (k == 1 ? apart : -apart)}, Quaternion::Identity()};
    }
    world.step(frames);
    double force = 0;
    for (const SimulatedContact& contact : world.findings().contacts)
      if (contact.obstacle == 0) force -= contact.force.z();
    if (i > 300) {
      sliding.least = std::min(sliding.least, force);
      sliding.most = std::max(sliding.most, force);
      if (i > 301) sliding.largest_change = std::max(sliding.largest_change, std::abs(force - last));
    }
    last = force;
  }
  return sliding;
}

TEST(ContactPoint, PadsPressAlikeWhereverNodesAre) {
  for (const ShapeType type : {ShapeType::box, ShapeType::mesh})
    for (const int segments : {10, 20, 30, 60})
      for (const double width : {0.02, 0.045}) {
        const Sliding s = sliding_pad(segments, width, type);
        EXPECT_GT(s.least, 0.1);
        // What is left: the rounded edge's damping as a node comes under it, by its segment's mass.
        EXPECT_LT(s.most - s.least, 0.08 * s.most) << segments << ", " << width;
        EXPECT_LT(s.largest_change, 0.01 * s.most) << segments << ", " << width;
      }
}

/// [m] How high two pads lift a cable that lies on a table by squeezing it 2 %, their middle a part of a segment behind a node.
double lifted(int segments, double shift, ShapeType type, double time_step) {
  const double radius = 0.004, length = 0.6, width = 0.02, height = 0.25, x = (segments / 2 + shift) * length / segments;
  SceneDesc scene = scenes::one_cable(segments, length);
  scene.time_step = time_step;
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 0.06;
  material.radius = radius;
  material.bending_stiffness = 1e-3;
  material.bending_damping = 1e-5;
  material.friction = 0.6;
  CableDesc& cable = scene.cables[0];
  cable.initial.type = InitialShapeDesc::Type::straight;
  cable.initial.from = {0, 0, radius};
  cable.initial.to = {length, 0, radius};
  for (const double side : {1.0, -1.0}) {
    ObstacleDesc& pad = scene.obstacles.emplace_back();
    pad.name = side > 0 ? "left" : "right";
    pad.type = type;
    pad.frame = pad.name;
    pad.size = {width, 0.01, 0.03};
    if (type == ShapeType::mesh) pad.mesh = box_triangles(pad.size).mesh();
    // A disc's flat end
    pad.radius = 0.015;
    pad.length = 0.01;
    if (type == ShapeType::cylinder) pad.pose = {0, 0, 0, pi / 2, 0, 0};
    pad.initial_pose = InitialPose{x, side * 0.03, 0.0155, 0, 0, 0};
  }
  scene.obstacles.emplace_back().name = "table";
  BoundaryInputs frames = initial_frames(scene);
  World world(scene, frames);
  const auto smooth = [](double part) {
    const double s = std::clamp(part, 0.0, 1.0);
    return s * s * s * (10 - 15 * s + 6 * s * s);
  };
  const double squeezed = radius * (1 - 0.02) + 0.005;
  for (int i = 1; i * time_step <= 3; ++i) {
    const double time = i * time_step, apart = 0.03 + (squeezed - 0.03) * smooth(time / 0.8);
    for (std::size_t k = 1; k < frames.size(); ++k) {
      frames[k].known = true;
      frames[k].pose = {{x, k == 1 ? apart : -apart, 0.0155 + height * smooth((time - 1) / 1.5)}, Quaternion::Identity()};
    }
    world.step(frames);
  }
  const int node = segments / 2;
  const std::vector<Vector3>& places = world.cables()[0].state.positions;
  const double place = places[node].z() + shift * (places[node + 1].z() - places[node].z());
  return place - radius;
}

TEST(ContactPoint, PadsHoldACableAnywhereBetweenItsNodes) {
  for (const ShapeType type : {ShapeType::box, ShapeType::mesh, ShapeType::cylinder})
    for (const double time_step : {0.001, 0.01})
      for (const int segments : {10, 20, 61, 120})
        for (const double shift : {0.0, 0.25, 0.5, 0.9})
          EXPECT_NEAR(lifted(segments, shift, type, time_step), 0.25, 0.01)
              << static_cast<int>(type) << ", " << segments << ", " << shift << ", " << time_step;
}

TEST(ContactPoint, FacesOfBodiesExchangeMomentumWithTheCable) {
  for (const double shift : {0.5, 0.3, 0.0, 1.0}) {
    SceneDesc scene = scenes::one_cable(10, 0.6);
    scene.gravity.acceleration.setZero();
    MaterialDesc& material = scene.materials[0].material;
    material.linear_density = 0.06;
    material.radius = 0.004;
    material.bending_stiffness = 0.01;
    CableDesc& cable = scene.cables[0];
    cable.initial.type = InitialShapeDesc::Type::straight;
    cable.initial.from = {0, 0, 0};
    cable.initial.to = {0.6, 0, 0};
    // Flies against the cable between two nodes.
    BodyDesc& block = scene.bodies.emplace_back();
    block.name = "block";
    block.mass = 0.02;
    ShapeDesc shape;
    shape.type = ShapeType::box;
    shape.size = {0.02, 0.02, 0.02};
    block.shapes = {shape};
    block.pose = {(4 + shift) * 0.06, 0, -0.016, 0, 0, 0};
    block.velocity = {0, 0, 0.5};
    World world(scene, {});
    const auto momentum = [&] {
      struct {
        Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
      } sum;
      const SimulatedBody& body = world.bodies()[0];
      const Eigen::Matrix3d axes = body.pose.orientation.toRotationMatrix();
      sum.linear = body.mass * body.velocity;
      sum.angular = body.pose.position.cross(sum.linear) + axes * body.inertia * axes.transpose() * body.angular_velocity;
      const CableState& state = world.cables()[0].state;
      for (int i = 0; i < state.nodes(); ++i) {
        sum.linear += state.masses[i] * state.velocities[i];
        sum.angular += state.masses[i] * state.positions[i].cross(state.velocities[i]);
      }
      return sum;
    };
    const auto before = momentum();
    for (int i = 0; i < 200; ++i) ASSERT_EQ(world.step({}).status, StepResult::Status::ok);
    const auto after = momentum();
    // It has been stopped by the cable, which is as heavy as it, and has not passed through.
    EXPECT_LT(world.bodies()[0].velocity.z(), 0.45);
    EXPECT_LT((after.linear - before.linear).norm(), 1e-10 * before.linear.norm()) << shift;
    // The iteration's tolerance, in an impact.
    EXPECT_LT((after.angular - before.angular).norm(), 1e-5 * before.angular.norm()) << shift;
  }
}

}  // namespace
}  // namespace verlet_cable
