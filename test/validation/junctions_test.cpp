#include "junctions.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "rigid_y_references.h"
#include "validation.h"

/// Ropes and rods that branch against closed forms and independent solutions.
namespace verlet_cable::validation {
namespace {

using End = BranchDesc::End;
using Type = JunctionDesc::Type;

MaterialDesc& rope(SceneDesc& scene) {
  return scene.materials[0].material;
}

PlaceDesc at_end() {
  PlaceDesc place;
  place.at = PlaceDesc::At::end;
  return place;
}

// --- Knots ------------------------------------------------------------------------------------------------------------------

struct Knot {
  const char* name;
  double density;          ///< [kg/m]
  double axial_stiffness;  ///< [N]
  Type type;
};

void PrintTo(const Knot& knot, std::ostream* stream) {
  *stream << knot.name;
}

class ThreeRopes : public testing::TestWithParam<Knot> {};

/// Two ropes of unequal lengths from two points to a knot, from which a load hangs on a third one. Lami, 1679: each force is as
/// the sine of the angle between the two others.
TEST_P(ThreeRopes, ForcesAtTheKnotAreLamis) {
  const Knot& knot = GetParam();
  constexpr double load = 0.5, left = 0.4, right = 0.6;
  const Vector3 far(0.7, 0, -0.1), begin(0.17, 0, -0.36);
  const auto samples = sample({1, 4}, [&](int n) {
    SceneDesc scene = no_cables();
    rope(scene).linear_density = knot.density;
    rope(scene).radius = 1e-3;
    rope(scene).axial_stiffness = knot.axial_stiffness;
    CableDesc& trunk = add_straight(scene, "trunk", 5 * n, {0, 0, 0}, {1, 0, 0});
    trunk.initial.points = {{0, 0, 0}, begin, far};
    hold_end(trunk, PlaceDesc::At::start, Vector3::Zero(), AttachmentType::hinge);
    hold_end(trunk, PlaceDesc::At::end, far, AttachmentType::hinge);
    CableDesc& branch_off = add_straight(scene, "hanging", 2 * n, begin, begin - Vector3(0, 0, 0.2));
    branch_off.point_masses = {scenes::payload(load)};
    add_junction(scene, "trunk", at_arc_length(left), {branch("hanging")}, knot.type);
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle()) << knot.name;
    run.run(0.2);
    const Vector3 place = cable_of(run.world, "hanging").positions.front();
    // Directions from the knot; the weight of the ropes counts at their ends.
    const Vector3 a = -place, b = far - place;
    const double to_left = std::atan2(std::abs(a.x()), a.z()), to_right = std::atan2(std::abs(b.x()), b.z());
    const double below = load * gravity / std::sin(to_left + to_right);
    if (knot.axial_stiffness == infinity) {
      EXPECT_NEAR(a.norm(), left, 1e-6);
      EXPECT_NEAR(b.norm(), right, 1e-6);
    }
    const double error_left = run.force("trunk_start").norm() / (below * std::sin(to_right)) - 1;
    const double error_right = run.force("trunk_end").norm() / (below * std::sin(to_left)) - 1;
    return std::max(std::abs(error_left), std::abs(error_right));
  });
  report(std::string("three ropes at a knot, ") + knot.name + ": forces", samples, 5e-4, Order::none);
}

const Knot knots[] = {{"rigid", 1e-5, infinity, Type::rigid},
                      {"hinge", 1e-5, infinity, Type::hinge},
                      {"extremely light", 1e-7, infinity, Type::hinge},
                      {"elastic", 1e-5, 1e4, Type::rigid},
                      {"elastic hinge", 1e-5, 100, Type::hinge}};
INSTANTIATE_TEST_SUITE_P(Knots, ThreeRopes, testing::ValuesIn(knots));

/// A load on a trunk from which two ropes lead to other points, not in one plane: three forces that balance a weight.
TEST(Tripod, ForcesBalanceTheLoad) {
  constexpr double load = 2;
  const std::array<Vector3, 3> tops{Vector3(0.3, 0, 0), Vector3(-0.2, 0.4, 0.1), Vector3(-0.1, -0.35, -0.05)};
  const Vector3 place(0.05, 0.02, -0.5);
  const auto samples = sample({1, 4}, [&](int n) {
    SceneDesc scene = no_cables();
    rope(scene).linear_density = 1e-5;
    rope(scene).radius = 1e-3;
    CableDesc& trunk = add_straight(scene, "trunk", 10 * n, tops[0], place);
    const double upper = trunk.length;
    trunk.length *= 1.25;
    trunk.segments = 5 * n;
    trunk.initial.points = {tops[0], place, place - Vector3(0, 0, 0.25 * upper)};
    trunk.point_masses = {scenes::payload(load)};
    hold_end(trunk, PlaceDesc::At::start, tops[0], AttachmentType::hinge);
    // One by its start, one by its end
    hold_end(add_straight(scene, "second", 3 * n, place, tops[1]), PlaceDesc::At::end, tops[1], AttachmentType::hinge);
    hold_end(add_straight(scene, "third", 3 * n, tops[2], place), PlaceDesc::At::start, tops[2], AttachmentType::hinge);
    add_junction(scene, "trunk", at_arc_length(upper), {branch("second"), branch("third", End::end)}, Type::hinge);
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    run.run(0.1);
    Eigen::Matrix3d directions;
    for (int i = 0; i < 3; ++i) directions.col(i) = (tops[i] - place).normalized();
    const Vector3 exact = directions.inverse() * Vector3(0, 0, load * gravity);
    double error = 0;
    const std::array<const char*, 3> names{"trunk_start", "second_end", "third_start"};
    for (int i = 0; i < 3; ++i) error = std::max(error, std::abs(run.force(names[i]).norm() / exact[i] - 1));
    return error;
  });
  report("a load on three ropes at a knot: forces", samples, 5e-4, Order::none);
}

// --- Rods ------------------------------------------------------------------------------------------------------------------

/// Three rods of 1 m, EI = 1 N m^2, GJ = 0.75 N m^2, welded at the origin, their other ends clamped; that of "rod0", in the frame
/// "hand", along x.
SceneDesc rigid_y(const std::array<Vector3, 3>& directions, int segments) {
  SceneDesc scene = no_cables();
  scene.gravity.acceleration.setZero();
  rope(scene).linear_density = 0.01;
  rope(scene).bending_stiffness = 1;
  rope(scene).torsional_stiffness = 0.75;
  for (int i = 0; i < 3; ++i) {
    const Vector3& direction = directions[i];
    // The first one ends at the weld, the second starts there, the third ends there.
    const bool ends = i != 1;
    CableDesc& rod = add_straight(scene, "rod" + std::to_string(i), segments, ends ? direction : Vector3(Vector3::Zero()),
                                  ends ? Vector3(Vector3::Zero()) : direction);
    AttachmentDesc& clamp = hold_end(rod, ends ? PlaceDesc::At::start : PlaceDesc::At::end, direction, AttachmentType::clamp,
                                     towards(ends ? Vector3(-direction) : direction));
    clamp.name = "clamp" + std::to_string(i);
    if (i > 0) continue;
    clamp.frame = "hand";
    clamp.offset.setZero();
    clamp.initial_pose = InitialPose{direction.x(), direction.y(), direction.z(), 0, 0, 0};
  }
  add_junction(scene, "rod0", at_end(), {branch("rod1"), branch("rod2", End::end)});
  return scene;
}

/// Turns the hand evenly within a second, and settles.
void turn_hand(Simulation& run, int axis, double angle) {
  const int steps = 100;
  for (int i = 1; i <= steps; ++i) {
    run.inputs[1].pose.orientation = Eigen::AngleAxisd(angle * i / steps, Vector3::Unit(axis));
    run.step();
  }
  EXPECT_TRUE(run.world.settle());
}

class RigidYTurned : public testing::TestWithParam<int> {};

/// One end is turned by 0.5 rad about its own axis (0) or across (1, 2).
TEST_P(RigidYTurned, IsKirchhoffs) {
  const RigidY& exact = validation::rigid_y[GetParam()];
  double largest_force = 0, largest_moment = 0;
  for (int i = 0; i < 3; ++i) {
    largest_force = std::max(largest_force, exact.forces[i].norm());
    largest_moment = std::max(largest_moment, exact.moments[i].norm());
  }
  std::vector<Sample> of_forces;
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rigid_y({rigid_y_directions[0], rigid_y_directions[1], rigid_y_directions[2]}, n);
    scene.time_step = 0.01;
    rope(scene).drag = 1;
    Simulation run(scene);
    turn_hand(run, GetParam(), 0.5);
    double force_error = 0, error = (cable_of(run.world, "rod1").positions.front() - exact.place).norm();
    for (int i = 0; i < 3; ++i) {
      const std::string name = "clamp" + std::to_string(i);
      force_error = std::max(force_error, (run.force(name) - exact.forces[i]).norm() / largest_force);
      error = std::max(error, (run.torque(name) - exact.moments[i]).norm() / largest_moment);
    }
    of_forces.push_back({static_cast<double>(n), force_error});
    return error;
  });
  const std::string name = std::string("rigid Y, one end turned about ") + "xyz"[GetParam()] + ": ";
  report(name + "moments", samples, 5e-3, Order::second);
  report(name + "forces", of_forces, 5e-3, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Axes, RigidYTurned, testing::Values(0, 1, 2));

using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// Of a straight beam along x with EI, GJ and EA (Przemieniecki, Theory of Matrix Structural Analysis, 1968, section 5.6), shear
/// left out: of forces and moments at both ends against their displacements and rotations.
Eigen::Matrix<double, 12, 12> beam_stiffness(double length, double bending, double torsion, double axial) {
  Eigen::Matrix<double, 12, 12> k = Eigen::Matrix<double, 12, 12>::Zero();
  const double l = length, a = bending / (l * l * l);
  const auto set = [&](int i, int j, double value) { k(i, j) = k(j, i) = value; };
  for (const int e : {0, 3}) {
    const double s = e == 0 ? axial / l : torsion / l;
    set(e, e, s);
    set(e, e + 6, -s);
    set(e + 6, e + 6, s);
  }
  // Deflection along y with rotation about z, and along z with rotation about -y
  for (const auto& [v, r, sign] : {std::array<int, 3>{1, 5, 1}, std::array<int, 3>{2, 4, -1}}) {
    set(v, v, 12 * a);
    set(v + 6, v + 6, 12 * a);
    set(v, v + 6, -12 * a);
    set(r, r, 4 * a * l * l);
    set(r + 6, r + 6, 4 * a * l * l);
    set(r, r + 6, 2 * a * l * l);
    set(v, r, sign * 6 * a * l);
    set(v, r + 6, sign * 6 * a * l);
    set(v + 6, r, -sign * 6 * a * l);
    set(v + 6, r + 6, -sign * 6 * a * l);
  }
  return k;
}

/// Consistent masses likewise; `polar` [m^2]: the square of the section's polar radius of gyration.
Eigen::Matrix<double, 12, 12> beam_mass(double length, double density, double polar) {
  Eigen::Matrix<double, 12, 12> m = Eigen::Matrix<double, 12, 12>::Zero();
  const double l = length, a = density * l / 420;
  const auto set = [&](int i, int j, double value) { m(i, j) = m(j, i) = value; };
  for (const int e : {0, 3}) {
    const double s = density * l / 6 * (e == 0 ? 1 : polar);
    set(e, e, 2 * s);
    set(e, e + 6, s);
    set(e + 6, e + 6, 2 * s);
  }
  for (const auto& [v, r, sign] : {std::array<int, 3>{1, 5, 1}, std::array<int, 3>{2, 4, -1}}) {
    set(v, v, 156 * a);
    set(v + 6, v + 6, 156 * a);
    set(v, v + 6, 54 * a);
    set(r, r, 4 * a * l * l);
    set(r + 6, r + 6, 4 * a * l * l);
    set(r, r + 6, -3 * a * l * l);
    set(v, r, sign * 22 * a * l);
    set(v, r + 6, -sign * 13 * a * l);
    set(v + 6, r, sign * 13 * a * l);
    set(v + 6, r + 6, -sign * 22 * a * l);
  }
  return m;
}

/// A frame of beams between points.
struct Frame {
  std::vector<Vector3> points;
  Eigen::MatrixXd stiffness, mass;

  explicit Frame(std::vector<Vector3> p) : points(std::move(p)) {
    stiffness = mass = Eigen::MatrixXd::Zero(6 * points.size(), 6 * points.size());
  }
  void add_beam(int from, int to, const MaterialDesc& material, double axial) {
    const Vector3 way = points[to] - points[from];
    const Eigen::Matrix3d turn = Quaternion::FromTwoVectors(Vector3::UnitX(), way).toRotationMatrix();
    Eigen::Matrix<double, 12, 12> axes = Eigen::Matrix<double, 12, 12>::Zero();
    for (int i = 0; i < 4; ++i) axes.block<3, 3>(3 * i, 3 * i) = turn.transpose();
    const Eigen::Matrix<double, 12, 12> k =
        axes.transpose() * beam_stiffness(way.norm(), material.bending_stiffness[0], material.torsional_stiffness, axial) * axes;
    const Eigen::Matrix<double, 12, 12> m =
        axes.transpose() * beam_mass(way.norm(), material.linear_density, 0.5 * material.radius * material.radius) * axes;
    const std::array<int, 2> nodes{from, to};
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j) {
        stiffness.block<6, 6>(6 * nodes[i], 6 * nodes[j]) += k.block<6, 6>(6 * i, 6 * j);
        mass.block<6, 6>(6 * nodes[i], 6 * nodes[j]) += m.block<6, 6>(6 * i, 6 * j);
      }
  }
};

class FlatY : public testing::TestWithParam<int> {};

/// Small turns: beam theory. The rods are in a plane, and hardly stretch.
TEST_P(FlatY, TurnedALittleIsAFrameOfBeams) {
  constexpr double angle = 2e-5, axial = 1e3;
  std::array<Vector3, 3> directions;
  const std::array<double, 3> angles{M_PI, 0.35, -1.1};
  for (int i = 0; i < 3; ++i) directions[i] = {std::cos(angles[i]), std::sin(angles[i]), 0};
  const auto samples = sample({10, 20, 40}, [&](int n) {
    SceneDesc scene = rigid_y(directions, n);
    scene.time_step = 0.01;
    rope(scene).drag = 1;
    rope(scene).axial_stiffness = axial;
    Frame frame({Vector3::Zero(), directions[0], directions[1], directions[2]});
    for (int i = 0; i < 3; ++i) frame.add_beam(0, i + 1, rope(scene), axial);
    Eigen::VectorXd motion = Eigen::VectorXd::Zero(24);
    motion[6 + 3 + GetParam()] = angle;
    motion.head<6>() = frame.stiffness.topLeftCorner<6, 6>().llt().solve(-(frame.stiffness * motion).head<6>());
    const Eigen::VectorXd loads = -frame.stiffness * motion;  // on the clamps
    Simulation run(scene);
    turn_hand(run, GetParam(), angle);
    double error = 0;
    const double largest = loads.segment<6>(6).norm();
    for (int i = 0; i < 3; ++i) {
      const std::string name = "clamp" + std::to_string(i);
      error = std::max(error, (run.torque(name) - loads.segment<3>(6 * (i + 1) + 3)).norm() / largest);
      error = std::max(error, (run.force(name) - loads.segment<3>(6 * (i + 1))).norm() / largest);
    }
    return error;
  });
  report(std::string("flat Y turned a little about ") + "xyz"[GetParam()] + ": forces and moments", samples, 5e-3, Order::none);
}

INSTANTIATE_TEST_SUITE_P(Axes, FlatY, testing::Values(0, 1, 2));

// --- Vibration --------------------------------------------------------------------------------------------------------------

struct BranchedMode {
  const char* name;
  int mode;     ///< from the slowest one on
  double mass;  ///< [kg] of the junction
  bool is_cut;  ///< the trunk ends at the junction, and another cable goes on from there
};

void PrintTo(const BranchedMode& mode, std::ostream* stream) {
  *stream << mode.name;
}

class TrunkWithABranch : public testing::TestWithParam<BranchedMode> {};

/// A cantilever with a branch that is half as long, at 60 degrees, struck at rest. Every second mode leaves its plane, and twists
/// it.
TEST_P(TrunkWithABranch, SwingsAsAFrameOfBeams) {
  const BranchedMode& wanted = GetParam();
  constexpr double at = 0.6, size = 2e-4;
  const Vector3 fork(at, 0, 0), tip = fork + 0.5 * Vector3(0.5, std::sqrt(0.75), 0);
  MaterialDesc material;
  material.linear_density = 0.01;
  material.radius = 1e-3;
  material.bending_stiffness = 1;
  material.torsional_stiffness = 0.75;

  // Fine enough for four digits, with a node wherever a cable has one
  constexpr int fine = 20;
  std::vector<Vector3> points;
  for (int i = 0; i <= fine; ++i) points.emplace_back(static_cast<double>(i) / fine, 0, 0);
  const int inside = static_cast<int>(std::lround(at * fine));
  for (int i = 1; i <= fine / 2; ++i) points.push_back(fork + 2.0 * i / fine * (tip - fork));
  Frame frame(points);
  constexpr double hardly_stretches = 1e6;
  for (int i = 0; i < fine; ++i) frame.add_beam(i, i + 1, material, hardly_stretches);
  for (int i = 0; i < fine / 2; ++i) frame.add_beam(i == 0 ? inside : fine + i, fine + i + 1, material, hardly_stretches);
  frame.mass.block<3, 3>(6 * inside, 6 * inside).diagonal().array() += wanted.mass;
  const auto unknowns = static_cast<Eigen::Index>(6 * (points.size() - 1));
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(frame.mass.bottomRightCorner(unknowns, unknowns),
                                                                         frame.stiffness.bottomRightCorner(unknowns, unknowns));
  const double exact = 1 / std::sqrt(solver.eigenvalues()[unknowns - wanted.mode]);
  Eigen::VectorXd shape = Eigen::VectorXd::Zero(unknowns + 6);
  shape.tail(unknowns) = solver.eigenvectors().col(unknowns - wanted.mode);
  double largest = 0;
  for (std::size_t i = 0; i < points.size(); ++i) largest = std::max(largest, shape.segment<3>(6 * i).norm());
  shape *= size / largest;
  // By what a part s along one of them moves
  const auto moved = [&](bool on_branch, double s) -> Vector3 {
    const double place = s * (on_branch ? fine / 2 : fine);
    const int i = std::min(static_cast<int>(place), (on_branch ? fine / 2 : fine) - 1);
    const auto point = [&](int k) -> Vector3 { return shape.segment<3>(6 * (on_branch ? (k == 0 ? inside : fine + k) : k)); };
    const auto slope = [&](int k) -> Vector3 {
      const int node = on_branch ? (k == 0 ? inside : fine + k) : k;
      const Vector3 along = on_branch ? Vector3((tip - fork).normalized()) : Vector3(Vector3::UnitX());
      return shape.segment<3>(6 * node + 3).cross(along) / fine;
    };
    const double t = place - i;
    return (1 + 2 * t) * (1 - t) * (1 - t) * point(i) + t * (1 - t) * (1 - t) * slope(i) + t * t * (3 - 2 * t) * point(i + 1) -
           t * t * (1 - t) * slope(i + 1);
  };

  const auto samples = sample({10, 20, 40}, [&](int n) {
    SceneDesc scene = no_cables();
    scene.gravity.acceleration.setZero();
    scene.materials[0].material = material;
    scene.time_step = 2 * M_PI / exact / (10 * n);
    struct Part {
      const char* name;
      bool on_branch;
      double from, to;
    };
    std::vector<Part> parts;
    if (wanted.is_cut)
      parts = {{"trunk", false, 0, at}, {"rest", false, at, 1}, {"branch", true, 0, 1}};
    else
      parts = {{"trunk", false, 0, 1}, {"branch", true, 0, 1}};
    for (const Part& part : parts) {
      const double length = (part.on_branch ? 0.5 : 1.0) * (part.to - part.from);
      const int segments = static_cast<int>(std::lround(n * length));
      CableDesc& cable = add_straight(scene, part.name, segments, {0, 0, 0}, {length, 0, 0});
      cable.initial.points.clear();
      for (int i = 0; i <= segments; ++i) {
        const double s = part.from + i * (part.to - part.from) / segments;
        cable.initial.points.push_back(part.on_branch ? Vector3(fork + s * (tip - fork)) : Vector3(s, 0, 0));
        cable.initial.velocities.push_back(exact * moved(part.on_branch, s));
      }
    }
    hold_end(scene.cables[0], PlaceDesc::At::start, Vector3::Zero(), AttachmentType::clamp);
    JunctionDesc& junction = add_junction(scene, "trunk", at_arc_length(at), {branch("branch")});
    if (wanted.is_cut) junction.branches.push_back(branch("rest"));
    junction.mass = wanted.mass;
    Simulation run(scene);
    const auto momentum = [&](const Simulation& now) {
      double sum = 0;
      for (const Part& part : parts) {
        const CableState& state = cable_of(now.world, part.name);
        for (int i = 0; i < state.nodes(); ++i) {
          const double s = part.from + i * (part.to - part.from) / state.segments();
          sum += state.masses[i] * state.velocities[i].dot(moved(part.on_branch, s));
        }
      }
      return sum;
    };
    return angular_frequency(run, momentum, 3) / exact - 1;
  });
  report(std::string("trunk with a branch, ") + wanted.name, samples, 1e-2, Order::second);
}

const BranchedMode branched_modes[] = {
    {"mode 1", 1, 0, false},
    {"mode 2", 2, 0, false},
    {"mode 3", 3, 0, false},
    {"mode 4", 4, 0, false},
    {"mode 1, heavy fork", 1, 0.02, false},
    {"mode 4, heavy fork", 4, 0.02, false},
    {"mode 1, trunk in two", 1, 0, true},
    {"mode 2, trunk in two", 2, 0, true},
};
INSTANTIATE_TEST_SUITE_P(Modes, TrunkWithABranch, testing::ValuesIn(branched_modes));

// --- Invariances ------------------------------------------------------------------------------------------------------------

struct CutRod {
  const char* name;
  BendingStiffness bending;
  std::array<double, 2> curvature;  ///< [1/m] at rest
  double rest_twist;                ///< [rad/m]
};

void PrintTo(const CutRod& rod, std::ostream* stream) {
  *stream << rod.name;
}

class RodInTwo : public testing::TestWithParam<CutRod> {};

/// A rod between two clamps, the end bent down and twisted by 1 rad, as a whole and in two pieces that are welded, the second the
/// other way round where that is `reversed`.
SceneDesc bent_rod(const CutRod& rod, int segments, bool in_two, bool reversed) {
  SceneDesc scene = no_cables();
  scene.time_step = 0.01;
  scene.gravity.acceleration *= 2;
  MaterialDesc& material = rope(scene);
  material.linear_density = 0.1;
  material.bending_stiffness = rod.bending;
  material.torsional_stiffness = 0.75;
  material.drag = 1;
  constexpr double at = 0.4;
  for (const bool second : {false, true}) {
    if (second && !in_two) break;
    const double from = second ? at : 0, to = second || !in_two ? 1 : at;
    const bool turned = second && reversed;
    CableDesc& cable = add_straight(scene, second ? "rest" : "rod", static_cast<int>(std::lround(segments * (to - from))),
                                    {turned ? to : from, 0, 0}, {turned ? from : to, 0, 0});
    cable.rest_curvature.type = RestCurvatureDesc::Type::constant;
    cable.rest_curvature.curvature = rod.curvature;
    cable.rest_twist = rod.rest_twist;
    if (rod.curvature == std::array<double, 2>{0, 0}) cable.rest_curvature = {};
    // Turned about the material's z the rod bends to the other side of y.
    if (turned) cable.rest_curvature.curvature[1] *= -1;
    if (!second) hold_end(cable, PlaceDesc::At::start, Vector3::Zero(), AttachmentType::clamp).name = "first";
    if (to < 1) continue;
    AttachmentDesc& clamp = hold_end(cable, turned ? PlaceDesc::At::start : PlaceDesc::At::end, Vector3::Zero(),
                                     AttachmentType::clamp, {0, 0, turned ? M_PI : 0});
    clamp.name = "last";
    clamp.frame = "hand";
    clamp.initial_pose = InitialPose{1, 0, 0, 0, 0, 0};
  }
  if (in_two) add_junction(scene, "rod", at_end(), {branch("rest", reversed ? End::end : End::start)});
  return scene;
}

TEST_P(RodInTwo, IsAsTheWholeRod) {
  for (const bool reversed : {false, true}) {
    const auto samples = sample({10, 20, 40}, [&](int n) {
      const auto settled = [&](bool in_two) {
        Simulation run(bent_rod(GetParam(), n, in_two, reversed));
        const int steps = 100;
        for (int i = 1; i <= steps; ++i) {
          const double part = static_cast<double>(i) / steps;
          run.inputs[1].pose.position = Vector3(1 - 0.2 * part, 0.05 * part, -0.1 * part);
          run.inputs[1].pose.orientation = Eigen::AngleAxisd(part, Vector3::UnitX());
          run.step();
        }
        EXPECT_TRUE(run.world.settle());
        return run;
      };
      const Simulation whole = settled(false), pieces = settled(true);
      const auto difference = [](const Vector3& a, const Vector3& b) { return (a - b).norm() / b.norm(); };
      const double place = (cable_of(pieces.world, "rest").positions[reversed ? cable_of(pieces.world, "rest").segments() : 0] -
                            cable_of(whole.world, "rod").positions[static_cast<int>(std::lround(0.4 * n))])
                               .norm();
      return std::max({place, difference(pieces.force("first"), whole.force("first")),
                       difference(pieces.torque("first"), whole.torque("first")),
                       difference(pieces.force("last"), whole.force("last")),
                       difference(pieces.torque("last"), whole.torque("last"))});
    });
    report(
        std::string("rod in two, ") + GetParam().name + (reversed ? ", the second reversed" : "") + ": places, forces, moments",
        samples, 5e-3, Order::none);
  }
}

const CutRod cut_rods[] = {{"straight", 1, {0, 0}, 0}, {"ribbon", {1, 2}, {0, 0}, 0}, {"curved ribbon", {1, 2}, {0.5, 1}, 0.5}};
INSTANTIATE_TEST_SUITE_P(Rods, RodInTwo, testing::ValuesIn(cut_rods));

/// A junction in the middle of a trunk with a branch that is next to nothing.
TEST(Junction, OfNothingChangesNothing) {
  const auto tip_after = [](bool branches) {
    SceneDesc scene = no_cables();
    rope(scene).bending_stiffness = 0.02;
    rope(scene).torsional_stiffness = 0.015;
    scene.materials.push_back({"thread", {}});
    scene.materials[1].material.linear_density = 1e-9;
    scene.materials[1].material.radius = 1e-4;
    CableDesc& trunk = add_straight(scene, "trunk", 40, {0, 0, 0}, {1, 0, 0});
    hold_end(trunk, PlaceDesc::At::start, Vector3::Zero(), AttachmentType::clamp);
    if (branches) {
      add_straight(scene, "nothing", 1, {0.5, 0, 0}, {0.5, 0.01, 0}).material = "thread";
      add_junction(scene, "trunk", at_arc_length(0.5), {branch("nothing")});
    }
    Simulation run(scene);
    run.run(0.5);
    return cable_of(run.world, "trunk").positions.back();
  };
  const double way = (tip_after(true) - tip_after(false)).norm();
  report("a junction of nothing on a falling cantilever: way of the tip [m]", {{40, way}}, 1e-3, Order::none);
}

/// A harness that tumbles freely, with trunk, two branches and a twig, for 10 s.
TEST(FreeHarness, KeepsItsMomentaAndEnergy) {
  SceneDesc scene = no_cables();
  scene.numerical_damping = false;
  scene.gravity.acceleration.setZero();
  rope(scene).bending_stiffness = 0.02;
  rope(scene).torsional_stiffness = 0.015;
  add_straight(scene, "trunk", 10, {0, 0, 0}, {1, 0, 0});
  add_straight(scene, "left", 5, {0.4, 0, 0}, {0.4, 0.5, 0});
  add_straight(scene, "right", 5, {0.7, -0.3, 0.4}, {0.7, 0, 0});
  add_straight(scene, "twig", 3, {0.4, 0.3, 0}, {0.4, 0.3, 0.3});
  add_junction(scene, "trunk", at_arc_length(0.4), {branch("left")});
  add_junction(scene, "trunk", at_arc_length(0.7), {branch("right", End::end)}).mass = 0.02;
  add_junction(scene, "left", at_arc_length(0.3), {branch("twig")});
  const Vector3 spin(0.5, 1, 2), velocity(0.1, 0.2, 0.3);
  for (CableDesc& cable : scene.cables)
    for (const Vector3& point : cable.initial.points)
      cable.initial.velocities.push_back(velocity + spin.cross(point) + Vector3(0, 0, 0.5 * point.x() * point.x()));
  Simulation run(scene);
  const Momenta before = momenta_of(run.world);
  const double error = energy_error(run, 10);
  const Momenta after = momenta_of(run.world);
  report("free harness: linear momentum over 10 s", {{10, (after.linear - before.linear).norm() / before.linear.norm()}}, 1e-9,
         Order::none);
  report("free harness: angular momentum over 10 s", {{10, (after.angular - before.angular).norm() / before.angular.norm()}},
         1e-6, Order::none);
  report("free harness: energy over 10 s", {{10, error}}, 1e-5, Order::none);
}

}  // namespace
}  // namespace verlet_cable::validation
