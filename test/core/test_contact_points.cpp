#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <string>

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

}  // namespace
}  // namespace verlet_cable
