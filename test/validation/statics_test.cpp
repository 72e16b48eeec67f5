#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "../support/analytic_beam.h"
#include "../support/analytic_catenary.h"
#include "rods.h"
#include "validation.h"

namespace verlet_cable::validation {
namespace {

/// Coordinates of all nodes, for curves.
std::vector<double> coordinates(const Simulation& run, int component) {
  std::vector<double> values;
  for (const Vector3& p : run.positions()) values.push_back(p[component]);
  return values;
}

class Catenary : public testing::TestWithParam<double> {};

TEST_P(Catenary, ShapeAndForcesAreIrvines) {
  constexpr double span = 0.8, stiffness = 10, weight = 0.1 * 9.81;  // 5 % strain
  const double rise = GetParam();
  const std::string name = rise == 0 ? "elastic catenary, level" : "elastic catenary, uneven";
  const analytic::ElasticCatenary exact = analytic::elastic_catenary(span, rise, 1, weight, stiffness);
  std::vector<Sample> force_samples;
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = scenes::between_two_points(n, span);
    material(scene).axial_stiffness = stiffness;
    scene.cables[0].attachments[1].offset.z() = rise;
    // A bend in the middle, far from the shape it settles to.
    const double distance = std::hypot(span, rise), depth = 0.5 * std::sqrt(1 - distance * distance);
    const Vector3 middle = Vector3(0.5 * span, 0, 0.5 * rise) + depth / distance * Vector3(rise, 0, -span);
    scene.cables[0].initial.type = InitialShapeDesc::Type::points;
    scene.cables[0].initial.points = {Vector3::Zero(), middle, {span, 0, rise}};
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    record_curve(name, "n = " + std::to_string(n), coordinates(run, 0), coordinates(run, 2));
    const Vector3 force = run.force("left") - Vector3(exact.horizontal, 0, -exact.vertical);
    force_samples.push_back({static_cast<double>(n), force.norm() / std::hypot(exact.horizontal, exact.vertical)});
    double largest = 0;
    for (int i = 0; i <= n; ++i) {
      const Eigen::Vector2d at = exact.point(static_cast<double>(i) / n);
      largest = std::max(largest, (run.positions()[i] - Vector3(at[0], 0, at[1])).norm());
    }
    return largest;
  });
  std::vector<double> x, z;
  for (int i = 0; i <= 100; ++i) {
    const Eigen::Vector2d at = exact.point(i / 100.0);
    x.push_back(at[0]);
    z.push_back(at[1]);
  }
  record_curve(name, "reference", x, z);
  report(name + ": shape", samples, 1e-3, Order::second);
  report(name + ": end force", force_samples, 1e-3, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Ends, Catenary, testing::Values(0.0, 0.3));

TEST(Cantilever, BendsUnderItsOwnWeight) {
  constexpr double load = 8e-4;  // [N/m]: 1e-4 L of deflection, far inside small deflections
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rod(n, 0.1);
    scene.gravity.acceleration.z() = -load / material(scene).linear_density;
    clamp_start(scene);
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    // The clamp carries all of the load and its moment, q L and q L^2 / 2.
    EXPECT_NEAR(run.force("start").z() / -load, 1, 1e-6);
    EXPECT_NEAR(run.torque("start").y() / (0.5 * load), 1, 1e-3);
    return -run.positions().back().z() / (load / 8) - 1;
  });
  report("cantilever, own weight", samples, 5e-4, Order::second);
}

struct Elastica {
  double load;        ///< P L^2 / EI
  double deflection;  ///< of the tip, in lengths: Mattiasson 1981, table 1
};

class TipLoad : public testing::TestWithParam<Elastica> {};

TEST_P(TipLoad, BendsToTheElastica) {
  const Elastica& elastica = GetParam();
  const std::string name = "elastica P = " + std::to_string(static_cast<int>(elastica.load));
  const std::vector<Eigen::Vector2d> curve = analytic::elastica(elastica.load, 20);
  const Eigen::Vector2d& tip = curve.back();
  std::vector<double> x, z;
  for (const Eigen::Vector2d& at : curve) {
    x.push_back(at[0]);
    z.push_back(-at[1]);
  }
  record_curve(name, "reference", x, z);
  // The table's digits.
  EXPECT_NEAR(tip[1], elastica.deflection, 5e-5);
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rod(n, 0.1);
    constexpr double payload = 1e4;  // beside it the rod's own weight is nothing
    material(scene).linear_density = 1e-4;
    scene.gravity.acceleration.z() = -elastica.load / payload;
    clamp_start(scene);
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    scene.cables[0].point_masses = {{{PlaceDesc::At::end, 0}, payload}};
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    record_curve(name, "n = " + std::to_string(n), coordinates(run, 0), coordinates(run, 2));
    const Vector3& end = run.positions().back();
    return (Eigen::Vector2d(end.x(), -end.z()) - tip).norm() / tip[1];
  });
  report(name, samples, 2e-3, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Loads, TipLoad,
                         testing::Values(Elastica{1, 0.3017}, Elastica{2, 0.4935}, Elastica{5, 0.7138}, Elastica{10, 0.8106}));

/// Points of the arc that a rod of length 1 takes under a moment that turns its end by `angle`.
Vector3 arc_point(double s, double angle) {
  return {std::sin(angle * s) / angle, 0, (1 - std::cos(angle * s)) / angle};
}

/// A clamp turns the end through a whole turn, about -y, and holds it nowhere: in each step it gives way to the cable's force.
TEST(EndMoment, RollsARodUpToACircle) {
  std::vector<Sample> moments;
  const auto gaps = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rod(n, 0.1);
    hold_ends(scene, AttachmentType::clamp, 1);
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    Simulation run(scene);
    Vector3& end = run.inputs[1].pose.position;
    constexpr int turning_steps = 100, yielding_steps = 100;
    for (int i = 1; i <= turning_steps + yielding_steps; ++i) {
      const double angle = 2 * M_PI * std::min(i, turning_steps) / turning_steps;
      run.inputs[1].pose.orientation = Eigen::AngleAxisd(angle, -Vector3::UnitY());
      if (i <= turning_steps) end = arc_point(1, angle);
      run.step();
      EXPECT_TRUE(run.world.settle());
      if (i > turning_steps) end += 0.01 * run.force("end");
    }
    EXPECT_LT(run.force("end").norm(), 1e-6);
    // A moment alone pulls at nothing.
    EXPECT_NEAR(run.cable().state.tension[n / 2], 0, 1e-2 * 4 * M_PI * M_PI);
    moments.push_back({static_cast<double>(n), std::abs(run.torque("end").norm() / (2 * M_PI) - 1)});
    record_curve("end moment", "n = " + std::to_string(n), coordinates(run, 0), coordinates(run, 2));
    return end.norm();
  });
  std::vector<double> x, z;
  for (int i = 0; i <= 100; ++i) {
    x.push_back(arc_point(i / 100.0, 2 * M_PI).x());
    z.push_back(arc_point(i / 100.0, 2 * M_PI).z());
  }
  record_curve("end moment", "reference", x, z);
  report("end moment: gap", gaps, 1e-3, Order::none);
  report("end moment: moment", moments, 1e-3, Order::none);
}

/// The same circle from the rod's own unloaded shape.
TEST(EndMoment, NaturalCurvatureClosesToACircle) {
  const auto samples = sample({25, 50, 100}, [](int n) {
    SceneDesc scene = rod(n, 0.1);
    material(scene).torsional_stiffness = 0.75;
    clamp_start(scene);
    scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::constant;
    scene.cables[0].rest_curvature.curvature = {0, 2 * M_PI};
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    return run.positions().back().norm();
  });
  report("natural circle: gap", samples, 1e-3, Order::second);
}

/// Curvature that grows along the rod rolls it up into a clothoid: angle c s^2 / 2.
TEST(EndMoment, NaturalCurvatureThatGrowsMakesAClothoid) {
  constexpr double growth = 2 * M_PI;  // [1/m^2] on a rod of 1 m
  Vector3 tip = Vector3::Zero();
  constexpr int parts = 100000;  // of the midpoint rule, which is then exact to 1e-9
  for (int i = 0; i < parts; ++i) {
    const double s = (i + 0.5) / parts;
    tip += Vector3(std::cos(0.5 * growth * s * s), std::sin(0.5 * growth * s * s), 0) / parts;
  }
  const auto samples = sample({25, 50, 100}, [&](int n) {
    SceneDesc scene = rod(n, 0.1);
    material(scene).torsional_stiffness = 0.75;
    clamp_start(scene);
    scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::profile;
    scene.cables[0].rest_curvature.profile = {{0, 0}, {0, 0.5 * growth}, {0, growth}};
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    return (run.positions().back() - tip).norm();
  });
  report("natural clothoid: gap", samples, 1e-3, Order::second);
}

/// A rod between stiff ends: straight, an arc of a circle, straight, wherever nodes are.
TEST(EndMoment, StiffEndsStayStraight) {
  constexpr double first = 0.13, last = 0.05, curvature = M_PI, angle = curvature * (1 - first - last);
  const Vector3 tip(first + std::sin(angle) / curvature + last * std::cos(angle),
                    (1 - std::cos(angle)) / curvature + last * std::sin(angle), 0);
  const auto samples = sample({25, 50, 100}, [&](int n) {
    SceneDesc scene = rod(n, 0.1);
    material(scene).torsional_stiffness = 0.75;
    clamp_start(scene);
    scene.cables[0].rest_curvature.type = RestCurvatureDesc::Type::constant;
    scene.cables[0].rest_curvature.curvature = {0, curvature};
    scene.cables[0].stiff_ends = {first, last};
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    return (run.positions().back() - tip).norm();
  });
  report("natural arc between stiff ends: gap", samples, 1e-3, Order::none);
}

/// Hooke's law does not know of bending: clamps that hold a straight rod feel EA times its strain.
TEST(Stretch, ClampsHoldAStraightRodWithHookesForce) {
  constexpr double strain = 0.01, stiffness = 1000;
  const auto samples = sample({20, 40, 80}, [](int n) {
    SceneDesc scene = rod(n, 0.1);
    material(scene).axial_stiffness = stiffness;
    hold_ends(scene, AttachmentType::clamp, 1 + strain);
    start_at(scene, [](double s) { return Vector3((1 + strain) * s, 0, 0); });
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    return run.force("start").x() / (stiffness * strain) - 1;
  });
  report("stretch between clamps", samples, 1e-6, Order::none);
}

}  // namespace
}  // namespace verlet_cable::validation
