// Rods of material frames: what they conserve, and what their law gives.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "../support/clamped_rod.h"
#include "../support/scenes.h"
#include "rod/rod_frames.h"
#include "verlet_cable/core/rotation.h"

namespace verlet_cable {
namespace {

using Status = StepResult::Status;
using At = PlaceDesc::At;
using Points = std::vector<Vector3>;

constexpr int segments = 40;

double largest_distance(const Points& a, const Points& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, (a[i] - b[i]).norm());
  return largest;
}

/// Nodes of an unloaded rod whose first segment leaves the origin along x, or comes half a segment after a clamp that does.
Points unloaded_shape(double length, const JointAngles& per_metre, bool clamped = false) {
  const double l = length / segments;
  const auto turn = [&](double part) { return joint_rotation({part * per_metre.twist, part * per_metre.y, part * per_metre.z}); };
  Points nodes{Vector3::Zero()};
  Eigen::Matrix3d frame = clamped ? turn(0.5 * l) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  for (int i = 0; i < segments; ++i) {
    nodes.push_back(nodes.back() + l * frame.col(0));
    frame = frame * turn(l);
  }
  return nodes;
}

/// Without gravity, at rest in its own shape.
SceneDesc unloaded_rod(double length, const JointAngles& per_metre, const BendingStiffness& bending, double torsional) {
  SceneDesc scene = scenes::one_cable(segments, length);
  scene.gravity.acceleration.setZero();
  scene.materials[0].material.bending_stiffness = bending;
  scene.materials[0].material.torsional_stiffness = torsional;
  CableDesc& cable = scene.cables[0];
  cable.rest_curvature.type = RestCurvatureDesc::Type::constant;
  cable.rest_curvature.curvature = {per_metre.y, per_metre.z};
  cable.rest_twist = per_metre.twist;
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = unloaded_shape(length, per_metre);
  return scene;
}

void clamp(SceneDesc& scene, bool both) {
  std::vector<AttachmentDesc>& attachments = scene.cables[0].attachments;
  attachments = {scenes::attachment("start", At::start, Vector3::Zero(), "", AttachmentType::clamp)};
  CableDesc& cable = scene.cables[0];
  const std::array<double, 2>& curvature = cable.rest_curvature.curvature;
  cable.initial.points = unloaded_shape(cable.length, {cable.rest_twist, curvature[0], curvature[1]}, true);
  if (!both) return;
  // Where the rod's own shape leads to
  const double l = cable.length / segments;
  const auto turn = [&](double length) {
    return joint_rotation({length * cable.rest_twist, length * curvature[0], length * curvature[1]});
  };
  Eigen::Matrix3d end = turn(0.5 * l);
  for (int i = 1; i < segments; ++i) end = end * turn(l);
  end = end * turn(0.5 * l);
  attachments.push_back(scenes::attachment("end", At::end, Vector3::Zero(), "hand", AttachmentType::clamp));
  const Vector3 place = cable.initial.points.back();
  attachments.back().initial_pose = InitialPose{
      place.x(), place.y(), place.z(), std::atan2(end(2, 1), end(2, 2)), std::asin(-end(2, 0)), std::atan2(end(1, 0), end(0, 0))};
}

struct Shape {
  const char* name;
  double length;
  JointAngles per_metre;
  BendingStiffness bending;
};

class UnloadedRod : public testing::TestWithParam<Shape> {};

TEST_P(UnloadedRod, StaysAsItIs) {
  for (const int clamps : {0, 1, 2}) {
    const Shape& shape = GetParam();
    SceneDesc scene = unloaded_rod(shape.length, shape.per_metre, shape.bending, 0.015);
    if (clamps > 0) clamp(scene, clamps == 2);
    const BoundaryInputs inputs = initial_frames(scene);
    World world(scene, inputs);
    const Points start = world.cables()[0].state.positions;
    for (int i = 0; i < 20000; ++i) ASSERT_EQ(world.step(inputs).status, Status::ok) << i;
    EXPECT_LT(largest_distance(world.cables()[0].state.positions, start), 1e-9) << clamps << " clamps";
    EXPECT_LT(world.energy().total(), 1e-18) << clamps << " clamps";
  }
}

INSTANTIATE_TEST_SUITE_P(Shapes, UnloadedRod,
                         testing::Values(Shape{"arc", 1.5 * M_PI * 0.1, {0, 0, 10}, 0.02}, Shape{"helix", 1, {3, 0, 8}, 0.02},
                                         Shape{"ribbon", 1, {2, 3, -2}, {0.02, 0.003}}),
                         [](const auto& info) { return info.param.name; });

/// Thrown and spinning, shaken.
SceneDesc thrown_rod() {
  SceneDesc scene = unloaded_rod(1, {2, 3, 2}, {0.01, 0.03}, 0.0075);
  InitialShapeDesc& initial = scene.cables[0].initial;
  for (int i = 0; i <= segments; ++i) {
    const double s = static_cast<double>(i) / segments;
    initial.velocities.push_back(Vector3(0.5, -1, 2).cross(initial.points[i] - initial.points[segments / 2]) +
                                 Vector3(0.1 + 0.3 * std::sin(2 * M_PI * s), 0.5 * std::cos(3 * s), 0.5 * std::sin(5 * s)));
  }
  return scene;
}

struct Momenta {
  Vector3 linear = Vector3::Zero(), angular = Vector3::Zero();
};

Momenta momenta(const SceneDesc& scene, const CableState& state) {
  const MaterialDesc& material = scene.materials[0].material;
  Momenta sum;
  for (std::size_t i = 0; i < state.positions.size(); ++i) {
    const Vector3 momentum = state.masses[i] * state.velocities[i];
    sum.linear += momentum;
    sum.angular += state.positions[i].cross(momentum);
  }
  for (std::size_t i = 0; i < state.spin.size(); ++i)
    sum.angular += 0.5 * material.linear_density * material.radius * material.radius * state.rest_lengths[i] * state.spin[i] *
                   (state.positions[i + 1] - state.positions[i]).normalized();
  return sum;
}

TEST(KirchhoffRod, KeepsEnergyAndMomentaInFreeFlight) {
  for (const double axial_stiffness : {infinity, 1e3}) {
    SceneDesc scene = thrown_rod();
    scene.numerical_damping = false;
    scene.materials[0].material.axial_stiffness = axial_stiffness;
    World world(scene, initial_frames(scene));
    const Momenta before = momenta(scene, world.cables()[0].state);
    const double energy = world.energy().total();
    for (int i = 0; i < 10000; ++i) ASSERT_EQ(world.step({FrameInput{}}).status, Status::ok) << i;
    const Momenta after = momenta(scene, world.cables()[0].state);
    EXPECT_LT((after.linear - before.linear).norm(), 1e-9 * before.linear.norm());
    EXPECT_LT((after.angular - before.angular).norm(), 1e-9 * before.angular.norm());
    EXPECT_NEAR(world.energy().total() / energy, 1, 1e-4);
    EXPECT_GT(world.energy().bend + world.energy().twist, 0.01 * energy);
  }
}

/// Falls, clamped at its start. The frames carry nothing where a rod is straight and bends alike about all axes, but for the
/// inertia of its section, which is next to nothing here.
TEST(KirchhoffRod, StraightRodMovesAsWithoutFrames) {
  SceneDesc scene = scenes::one_cable(segments);
  MaterialDesc& material = scene.materials[0].material;
  material.radius = 1e-9;
  material.bending_stiffness = 0.02;
  material.torsional_stiffness = 0.015;
  scene.numerical_damping = false;
  scene.cables[0].initial.type = InitialShapeDesc::Type::straight;
  scene.cables[0].initial.to = Vector3::UnitX();
  scene.cables[0].attachments = {scenes::attachment("start", At::start, Vector3::Zero(), "", AttachmentType::clamp)};
  World plain(scene, initial_frames(scene));
  scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::constant;
  scene.cables[0].rest_curvature.curvature = {0, 1e-100};
  World whole(scene, initial_frames(scene));
  ASSERT_TRUE(whole.cables()[0].state.directors.size() == segments && plain.cables()[0].state.directors.empty());
  for (int i = 0; i < 600; ++i) {
    plain.step({FrameInput{}});
    whole.step({FrameInput{}});
  }
  // Velocities are solved for to 1e-5 segment lengths a second.
  EXPECT_LT(largest_distance(whole.cables()[0].state.positions, plain.cables()[0].state.positions), 1e-8);
  EXPECT_NEAR(whole.energy().bend / plain.energy().bend, 1, 1e-6);
  EXPECT_LT((whole.attachments()[0].torque - plain.attachments()[0].torque).norm(), 1e-6 * plain.attachments()[0].torque.norm());
}

/// What clamps feel of a rod that one of them twists and bends: moments are in balance with the forces.
TEST(KirchhoffRod, ClampsBearWhatTheRodExerts) {
  SceneDesc scene = unloaded_rod(1, {1, 2, 3}, {0.02, 0.005}, 0.01);
  clamp(scene, true);
  const BoundaryInputs start = initial_frames(scene);
  World world(scene, start);
  BoundaryInputs inputs = start;
  for (int i = 1; i <= 10; ++i) {
    const Quaternion turn(Eigen::AngleAxisd(0.2 * i, Vector3(1, 2, 2) / 3));
    inputs[1].pose = {start[1].pose.position + 0.02 * i * Vector3(-1, 1, 0.5), turn * start[1].pose.orientation};
    world.step(inputs);
    ASSERT_TRUE(world.settle()) << i;
  }
  const Attachment &first = world.attachments()[0], &last = world.attachments()[1];
  const Vector3 moment = last.torque + inputs[1].pose.position.cross(last.force);
  EXPECT_GT(first.torque.norm(), 0.01);
  EXPECT_LT((first.force + last.force).norm(), 1e-6 * first.force.norm());
  EXPECT_LT((first.torque + moment).norm(), 1e-6 * first.torque.norm());
}

/// An energy is worth its moments: a clamp that turns a rod slowly does the work that is stored.
TEST(KirchhoffRod, WorkOfAClampIsStored) {
  SceneDesc scene = unloaded_rod(1, {1, 2, 3}, {0.02, 0.005}, 0.01);
  clamp(scene, true);
  const BoundaryInputs start = initial_frames(scene);
  World world(scene, start);
  BoundaryInputs inputs = start;
  double work = 0;
  Vector3 torque = Vector3::Zero();
  const Vector3 axis = Vector3(2, -1, 2) / 3;
  constexpr int turns = 50;
  constexpr double angle = 1.0;
  for (int i = 1; i <= turns; ++i) {
    inputs[1].pose.orientation = Quaternion(Eigen::AngleAxisd(angle * i / turns, axis)) * start[1].pose.orientation;
    world.step(inputs);
    ASSERT_TRUE(world.settle()) << i;
    work -= 0.5 * (torque + world.attachments()[1].torque).dot(axis) * angle / turns;
    torque = world.attachments()[1].torque;
  }
  EXPECT_NEAR((world.energy().bend + world.energy().twist) / work, 1, 1e-3);
}

/// A quarter of a circle that a small load bends out of its plane (Timoshenko, Strength of Materials, 1956, part II).
class BowBeam : public testing::TestWithParam<double> {};

TEST_P(BowBeam, TipAndRootAreTimoshenkos) {
  const double torsional = GetParam();
  SceneDesc scene = unloaded_rod(M_PI / 2, {0, 0, 1}, 1, torsional);
  MaterialDesc& material = scene.materials[0].material;
  material.linear_density = 1e-9;
  scene.cables[0].point_masses = {scenes::payload(1e-2)};
  scene.gravity.acceleration = {0, 0, -1e-3};
  clamp(scene, false);
  constexpr double load = 1e-5;
  World world(scene, initial_frames(scene));
  const double height = world.cables()[0].state.positions.back().z();
  ASSERT_TRUE(world.settle());
  const double expected = load * (M_PI / 4 + (3 * M_PI / 4 - 2) / torsional);
  // 0.1 % with 80 segments, of second order
  EXPECT_NEAR((height - world.cables()[0].state.positions.back().z()) / expected, 1, 4e-3);
  const Vector3& root = world.attachments()[0].torque;
  EXPECT_NEAR(root.x() / load, -1, 2e-3);
  EXPECT_NEAR(root.y() / load, 1, 2e-3);
}

INSTANTIATE_TEST_SUITE_P(TorsionalStiffness, BowBeam, testing::Values(100.0, 1.0, 0.2, 0.05));

/// How far a rod of n segments is from the solution of Kirchhoff's equations, after its end was carried as that solution's.
double distance_from(const ClampedRod& solution, int n, const std::array<double, 2>& curvature, double twist) {
  SceneDesc scene = scenes::one_cable(n);
  scene.gravity.acceleration.setZero();
  scene.materials[0].material.bending_stiffness = 1;
  scene.materials[0].material.torsional_stiffness = 0.75;
  CableDesc& cable = scene.cables[0];
  cable.rest_curvature.type = RestCurvatureDesc::Type::constant;
  cable.rest_curvature.curvature = curvature;
  cable.rest_twist = twist;
  cable.initial.type = InitialShapeDesc::Type::points;
  cable.initial.points = {Vector3::Zero()};
  for (int i = 0; i < n; ++i) {
    const double yaw = 2 * (i + 0.5) / n;
    cable.initial.points.push_back(cable.initial.points.back() + Vector3(std::cos(yaw), std::sin(yaw), 0) / n);
  }
  const Vector3 start = cable.initial.points.back(), end(0.6, 0.3, 0.2);
  cable.attachments = {scenes::attachment("start", At::start, Vector3::Zero(), "", AttachmentType::clamp),
                       scenes::attachment("end", At::end, Vector3::Zero(), "hand", AttachmentType::clamp)};
  cable.attachments[1].initial_pose = InitialPose{start.x(), start.y(), start.z(), 0, 0, 2};
  BoundaryInputs inputs = initial_frames(scene);
  World world(scene, inputs);
  constexpr int stages = 40;
  for (int stage = 1; stage <= stages; ++stage) {
    const double part = static_cast<double>(stage) / stages;
    inputs[1].pose = {start + part * (end - start),
                      Eigen::AngleAxisd(2 - part, Vector3::UnitZ()) * Eigen::AngleAxisd(2 * part, Vector3::UnitX())};
    world.step(inputs);
    EXPECT_TRUE(world.settle()) << stage;
  }
  Points places;
  for (std::size_t i = 0; i < solution.places.size(); ++i)
    places.push_back(world.cables()[0].state.positions[i * n / (solution.places.size() - 1)]);
  const double moment = (world.attachments()[0].torque - solution.moment).norm() / solution.moment.norm();
  EXPECT_LT(moment, 8e-3 * 400 / (n * n)) << n;
  return largest_distance(places, solution.places);
}

TEST(KirchhoffRod, IsKirchhoffsBetweenClampsInSpace) {
  const auto expect_second_order = [](const auto& distance) {
    double last = 0;
    for (const int n : {20, 40, 80}) {
      const double now = distance(n);
      EXPECT_LT(now, 1.3e-3 * 400 / (n * n)) << n;  // 1e-3 of the length
      if (last > 0) {
        EXPECT_NEAR(std::log2(last / now), 2, 0.1) << n;
      }
      last = now;
    }
  };
  expect_second_order([](int n) { return distance_from(straight_rod, n, {0, 1e-100}, 0); });
  expect_second_order([](int n) { return distance_from(curved_rod, n, {1, 2}, 0.5); });
}

/// Falls on a floor and over a pole, with another.
TEST(KirchhoffRod, ComesToRestOnObstaclesAndOnAnother) {
  SceneDesc scene = unloaded_rod(1, {1, 1, 4}, {0.01, 0.004}, 0.0075);
  scene.gravity.acceleration = {0, 0, -9.81};
  MaterialDesc& material = scene.materials[0].material;
  material.bending_damping = material.torsional_damping = 5e-4;
  material.axial_stiffness = 1e4;
  material.axial_damping = 1;
  for (Vector3& point : scene.cables[0].initial.points) point.z() += 0.4;
  scene.cables.push_back(scene.cables[0]);
  scene.cables[1].name = "other";
  for (Vector3& point : scene.cables[1].initial.points) point += Vector3(0.02, 0.03, 0.05);
  ObstacleDesc floor, pole;
  floor.name = "floor";
  pole.name = "pole";
  pole.type = ShapeType::cylinder;
  pole.radius = 0.05;
  pole.length = 1;
  pole.pose = {0.1, 0, 0.2, M_PI / 2, 0, 0};
  scene.obstacles = {floor, pole};
  scene.contact.emplace();
  World world(scene, initial_frames(scene));
  bool touched = false;
  for (int i = 0; i < 2000; ++i) {
    const StepResult result = world.step({FrameInput{}});
    ASSERT_EQ(result.status, Status::ok) << i;
    ASSERT_LE(result.substeps, 16) << i;
    for (const SimulatedContact& contact : world.findings().contacts) touched = touched || contact.other_cable >= 0;
  }
  EXPECT_TRUE(touched);
  for (const SimulatedCable& cable : world.cables())
    for (const Vector3& position : cable.state.positions) EXPECT_GT(position.z(), 0.8 * material.radius);
  EXPECT_LT(world.energy().kinetic, 1e-3);
}

}  // namespace
}  // namespace verlet_cable
