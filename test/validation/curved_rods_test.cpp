#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "kirchhoff_references.h"
#include "rods.h"
#include "validation.h"

/// Rods that bend and twist at once, at rest: against closed forms and against boundary value problems of Kirchhoff's rod.
namespace verlet_cable::validation {
namespace {

Vector3 vector(const std::array<double, 3>& numbers) {
  return {numbers[0], numbers[1], numbers[2]};
}

/// Takes the clamp in the frame "hand" from `pose(0)` to `pose(1)`, at rest all the way.
void lead(Simulation& run, int steps, const std::function<Pose(double)>& pose) {
  for (int i = 1; i <= steps; ++i) {
    run.inputs[1].pose = pose(static_cast<double>(i) / steps);
    run.step();
    ASSERT_TRUE(run.world.settle()) << "step " << i << " of " << steps;
  }
}

// --- Bow beam: a quarter circle, clamped, with a small load across its plane at its end

/// Across its plane it is bent about y and twisted; its stiffness about z does not matter.
struct BowBeam {
  double torsional_stiffness;  ///< GJ / EI
  double other_stiffness;      ///< EI about z
};

/// [N] So small that its square, which is left out of the reference, is nothing beside 1.
constexpr double bow_load = 1e-4;
constexpr double quarter = M_PI / 2;

SceneDesc bow_beam(const BowBeam& bow, int segments) {
  SceneDesc scene = rod(segments, 0.1);
  constexpr double payload = 1e4;  // beside it the rod's own weight is nothing
  material(scene).linear_density = 1e-4;
  material(scene).bending_stiffness = {1, bow.other_stiffness};
  material(scene).torsional_stiffness = bow.torsional_stiffness;
  scene.gravity.acceleration.z() = -bow_load / payload;
  scene.cables[0].length = quarter;
  scene.cables[0].point_masses = {scenes::payload(payload)};
  bend_at_rest(scene, 0, 1);
  clamp_start(scene);
  const double side = quarter / segments, radius = 0.5 * side / std::sin(0.5 * side);  // of a polygon as long as the arc
  start_at(scene, [&](double s) -> Vector3 { return radius * Vector3(std::sin(quarter * s), 1 - std::cos(quarter * s), 0); });
  return scene;
}

/// Castigliano (Timoshenko, Strength of Materials II, 1956, section 80), at an angle from the clamp: the integral of M m / EI and
/// T t / GJ, with M = sin(pi/2 - a), T = 1 - cos(pi/2 - a) of the load and m, t of a unit load there.
double bow_deflection(double torsional_stiffness, double angle) {
  const double both = 0.5 * angle * std::sin(angle), torsion = angle - std::sin(angle) - 1 + std::cos(angle);
  return both + (both + torsion) / torsional_stiffness;
}

class Bow : public testing::TestWithParam<BowBeam> {};

TEST_P(Bow, BendsAndTwistsAcrossItsPlane) {
  const BowBeam& bow = GetParam();
  const double torsional_stiffness = bow.torsional_stiffness;
  std::string name = "bow beam, GJ = " + short_text(torsional_stiffness);
  if (bow.other_stiffness != 1) name += ", stiff in its plane";
  const double tip = bow_deflection(torsional_stiffness, quarter);
  EXPECT_NEAR(tip, M_PI / 4 + (3 * M_PI / 4 - 2) / torsional_stiffness, 1e-12 * tip);
  std::vector<Sample> moments;
  const auto samples = sample({20, 40, 80}, [&](int n) {
    Simulation run(bow_beam(bow, n));
    EXPECT_TRUE(run.world.settle());
    std::vector<double> angles, deflections;
    for (int i = 0; i <= n; ++i) {
      angles.push_back(quarter * i / n);
      deflections.push_back(-run.positions()[i].z() / bow_load / tip);
    }
    record_curve(name, "n = " + std::to_string(n), angles, deflections);
    // Of the load at (1, 1, 0): it twists the root about x and bends it about y.
    const Vector3 moment(-bow_load, bow_load, 0), error = (run.torque("start") - moment) / bow_load;
    moments.push_back({static_cast<double>(n), std::max({std::abs(error.x()), std::abs(error.y()), std::abs(error.z())})});
    return -run.positions().back().z() / bow_load / tip - 1;
  });
  std::vector<double> angles, deflections;
  for (int i = 0; i <= 100; ++i) {
    angles.push_back(quarter * i / 100);
    deflections.push_back(bow_deflection(torsional_stiffness, angles.back()) / tip);
  }
  record_curve(name, "reference", angles, deflections);
  report(name + ": tip", samples, 1e-3, Order::second);
  report(name + ": moments at the root", moments, 2e-3, Order::none);
}

INSTANTIATE_TEST_SUITE_P(Stiffnesses, Bow,
                         testing::Values(BowBeam{100, 1}, BowBeam{1, 1}, BowBeam{0.2, 1}, BowBeam{0.05, 1}, BowBeam{0.2, 30}));

/// Few segments, and numbers of them without a divisor, lie on the same line: the error is a constant over their square.
TEST(BowSegments, EveryNumberHasItsError) {
  constexpr double torsional_stiffness = 0.2;
  const double tip = bow_deflection(torsional_stiffness, quarter);
  const auto scaled_error = [&](int n) {
    Simulation run(bow_beam({torsional_stiffness, 2}, n));
    EXPECT_TRUE(run.world.settle());
    return (-run.positions().back().z() / bow_load / tip - 1) * n * n;
  };
  const double limit = scaled_error(101);
  for (const int n : {7, 13, 31, 64}) EXPECT_NEAR(scaled_error(n) / limit, 1, 2.0 / n) << n << " segments";
  for (const int n : {1, 2, 3}) EXPECT_LT(std::abs(scaled_error(n)), 3 * std::abs(limit) + 1) << n << " segments";
}

// --- A rod between two clamps in space

class Clamped : public testing::TestWithParam<references::ClampedRod> {};

TEST_P(Clamped, TakesTheShapeOfKirchhoffsRod) {
  const references::ClampedRod& rod_between = GetParam();
  const std::string name = std::string("clamped rod, ") + rod_between.name;
  std::vector<Sample> forces, moments;
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rod(n, 0.1);
    const auto [about_y, about_z] = rod_between.bending_stiffness;
    material(scene).bending_stiffness = {about_y, about_z};
    material(scene).torsional_stiffness = rod_between.torsional_stiffness;
    bend_at_rest(scene, rod_between.rest_curvature[0], rod_between.rest_curvature[1]);
    scene.cables[0].rest_twist = rod_between.rest_twist;
    hold_ends(scene, AttachmentType::clamp, 0);
    scene.cables[0].attachments[1].initial_pose = references::arc_end;
    start_at(scene, [](double s) {
      const double angle = references::arc * s;
      return Vector3(std::sin(angle) / references::arc, (1 - std::cos(angle)) / references::arc, 0);
    });
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    lead(run, 40, [&](double way) {
      InitialPose pose;
      for (int i = 0; i < 6; ++i) pose[i] = references::arc_end[i] + way * (references::goal[i] - references::arc_end[i]);
      pose[3] += way * rod_between.roll;
      return pose_of(pose);
    });
    std::vector<double> x, y;
    double largest = 0;
    const int intervals = static_cast<int>(rod_between.points.size()) - 1;
    for (int i = 0; i <= intervals; ++i)
      largest = std::max(largest, (run.positions()[i * n / intervals] - vector(rod_between.points[i])).norm());
    for (const Vector3& p : run.positions()) {
      x.push_back(p.x());
      y.push_back(p.y());
    }
    record_curve(name, "n = " + std::to_string(n), x, y);
    const auto error = [&](const Vector3& start, const Vector3& end, int first) {
      const Vector3 exact_start = vector(rod_between.holders[first]), exact_end = vector(rod_between.holders[first + 2]);
      return std::max((start - exact_start).norm(), (end - exact_end).norm()) / std::max(exact_start.norm(), exact_end.norm());
    };
    forces.push_back({static_cast<double>(n), error(run.force("start"), run.force("end"), 0)});
    moments.push_back({static_cast<double>(n), error(run.torque("start"), run.torque("end"), 1)});
    return largest;
  });
  std::vector<double> x, y;
  for (const auto& point : rod_between.points) {
    x.push_back(point[0]);
    y.push_back(point[1]);
  }
  record_curve(name, "reference", x, y);
  report(name + ": shape", samples, 1e-3, Order::second);
  report(name + ": forces", forces, 2e-3, Order::second);
  report(name + ": moments", moments, 2e-3, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Rods, Clamped, testing::ValuesIn(references::clamped_rods));

// --- Helical springs: EI = 1 and GJ = 0.75, a rod of length 1

constexpr double spring_torsion = 0.75;

/// A helix that leaves the origin along x, its radius towards y: pitch angle, and angle about its axis a length of rod.
struct Helix {
  double pitch;
  double turning;

  double radius() const { return std::cos(pitch) / turning; }
  double curvature() const { return turning * std::cos(pitch); }
  double torsion() const { return turning * std::sin(pitch); }
  Vector3 axis() const { return {std::sin(pitch), 0, std::cos(pitch)}; }
  /// At a length s from its start, with Frenet's frame: x along the rod, y to the axis.
  Pose at(double s) const {
    const auto in_space = [this](double angle) {
      const double c = std::cos(angle), d = std::sin(angle), along = std::cos(pitch), up = std::sin(pitch);
      Eigen::Matrix3d frame;
      frame << -along * d, -c, up * d, along * c, -d, -up * c, up, 0, along;
      return std::pair<Vector3, Eigen::Matrix3d>{radius() * Vector3(c, d, angle * std::tan(pitch)), frame};
    };
    const auto [start, start_frame] = in_space(0);
    const auto [end, end_frame] = in_space(turning * s);
    return {start_frame.transpose() * (end - start), Quaternion(Eigen::Matrix3d(start_frame.transpose() * end_frame))};
  }
};

/// A helix at rest, clamped at both ends.
SceneDesc spring(const Helix& helix, int segments) {
  SceneDesc scene = rod(segments, 0.1);
  material(scene).torsional_stiffness = spring_torsion;
  bend_at_rest(scene, 0, helix.curvature());
  scene.cables[0].rest_twist = helix.torsion();
  hold_ends(scene, AttachmentType::clamp, 0);
  start_at(scene, [&](double s) { return helix.at(s).position; });
  return scene;
}

/// With the clamp at its end in its place.
Simulation start_spring(const Helix& helix, int segments) {
  const SceneDesc scene = spring(helix, segments);
  BoundaryInputs inputs = initial_frames(scene);
  inputs[1].pose = helix.at(1);
  return Simulation(scene, inputs);
}

struct SpringCase {
  const char* name;
  Helix rest;
  double pitch;       ///< after it was drawn out
  bool turns_freely;  ///< its ends turn about its axis until there is no moment about it
};

class Spring : public testing::TestWithParam<SpringCase> {};

/// Kirchhoff; Love, A Treatise on the Mathematical Theory of Elasticity, 1927, section 271: drawn out by a force and a moment on
/// its axis, a helix stays one.
TEST_P(Spring, DrawnOutStaysAHelixUnderKirchhoffsForce) {
  const SpringCase& spring_case = GetParam();
  const Helix& rest = spring_case.rest;
  const std::string name = std::string("spring, ") + spring_case.name;
  const auto drawn = [&](double way) {
    const double pitch = rest.pitch + way * (spring_case.pitch - rest.pitch), along = std::cos(pitch), up = std::sin(pitch);
    if (!spring_case.turns_freely) return Helix{pitch, rest.turning};
    // No moment about the axis: GJ (torsion - at rest) up + EI (curvature - at rest) along = 0.
    const double at_rest = spring_torsion * rest.torsion() * up + rest.curvature() * along;
    return Helix{pitch, at_rest / (spring_torsion * up * up + along * along)};
  };
  /// About the rod and about its binormal, at its start.
  const auto moment = [&](const Helix& helix) {
    return Vector3(spring_torsion * (helix.torsion() - rest.torsion()), 0, helix.curvature() - rest.curvature());
  };
  const auto force = [&](const Helix& helix) -> Vector3 {
    const Vector3 m = moment(helix);
    return (m.x() * std::cos(helix.pitch) - m.z() * std::sin(helix.pitch)) / helix.radius() * helix.axis();
  };
  constexpr int steps = 10;
  std::vector<double> lengths, exact_forces;
  for (int i = 0; i <= steps; ++i) {
    const Helix helix = drawn(static_cast<double>(i) / steps);
    lengths.push_back(std::sin(helix.pitch) / std::sin(rest.pitch));
    exact_forces.push_back(force(helix).dot(helix.axis()));
  }
  record_curve(name, "reference", lengths, exact_forces);
  std::vector<Sample> moments;
  const auto samples = sample({40, 80, 160}, [&](int n) {
    Simulation run = start_spring(rest, n);
    EXPECT_TRUE(run.world.settle());
    std::vector<double> forces{run.force("start").dot(rest.axis())};
    for (int i = 1; i <= steps; ++i) {
      const Helix helix = drawn(static_cast<double>(i) / steps);
      lead(run, 1, [&](double) { return helix.at(1); });
      forces.push_back(run.force("start").dot(helix.axis()));
    }
    record_curve(name, "n = " + std::to_string(n), lengths, forces);
    const Helix helix = drawn(1);
    moments.push_back({static_cast<double>(n), (run.torque("start") - moment(helix)).norm() / moment(helix).norm()});
    return (run.force("start") - force(helix)).norm() / force(helix).norm();
  });
  report(name + ": force", samples, 5e-3, Order::second);
  report(name + ": moment", moments, 5e-3, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Springs, Spring,
                         testing::Values(SpringCase{"small pitch, held", {0.05, 4 * M_PI}, 0.15, false},
                                         SpringCase{"small pitch, turning", {0.05, 4 * M_PI}, 0.15, true},
                                         SpringCase{"large pitch, held", {0.7, 4 * M_PI}, 0.9, false},
                                         SpringCase{"large pitch, turning", {0.7, 4 * M_PI}, 0.9, true},
                                         SpringCase{"left-handed, held", {-0.7, 4 * M_PI}, -0.9, false}));

/// Wahl, Mechanical Springs, 1963: d F / d x = G d^4 / (8 D^3 N) = GJ / (length radius^2) of a closely wound spring. Its end is
/// drawn along the axis and held against turning.
TEST(CloseSpring, HasWahlsStiffness) {
  const Helix helix{0.005, 4 * M_PI};
  constexpr double drawn = 1e-4;
  const auto samples = sample({40, 80, 160}, [&](int n) {
    Simulation run = start_spring(helix, n);
    EXPECT_TRUE(run.world.settle());
    const double before = run.force("start").dot(helix.axis());
    lead(run, 1, [&](double way) {
      Pose pose = helix.at(1);
      pose.position += way * drawn * helix.axis();
      return pose;
    });
    const double stiffness = (run.force("start").dot(helix.axis()) - before) / drawn;
    return stiffness * helix.radius() * helix.radius() / spring_torsion - 1;
  });
  report("close spring: stiffness", samples, 5e-3, Order::second);
}

/// The shape that a straight rod takes by itself: clamped at one end, rolled up to its helix.
TEST(NaturalHelix, RollsUpFromAStraightRod) {
  const Helix helix{0.6, 8};
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rod(n, 0.1);
    material(scene).bending_stiffness = {1, 2};
    material(scene).torsional_stiffness = spring_torsion;
    bend_at_rest(scene, 0, helix.curvature());
    scene.cables[0].rest_twist = helix.torsion();
    clamp_start(scene);
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    std::vector<double> x, z;
    for (const Vector3& p : run.positions()) {
      x.push_back(p.x());
      z.push_back(p.z());
    }
    record_curve("natural helix", "n = " + std::to_string(n), x, z);
    return (run.positions().back() - helix.at(1).position).norm();
  });
  std::vector<double> x, z;
  for (int i = 0; i <= 200; ++i) {
    const Vector3 p = helix.at(i / 200.0).position;
    x.push_back(p.x());
    z.push_back(p.z());
  }
  record_curve("natural helix", "reference", x, z);
  report("natural helix: end", samples, 1e-3, Order::second);
}

}  // namespace
}  // namespace verlet_cable::validation
