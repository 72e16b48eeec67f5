#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "rods.h"
#include "validation.h"

/// Cables of two materials, one after the other, against what closed forms or numerical solutions of their own say of two pieces.
namespace verlet_cable::validation {
namespace {

/// The material of the second piece, to be changed: at first as the first one. The cable is of it from `from` [m] to its end.
MaterialDesc& second_material(SceneDesc& scene, double from) {
  scene.materials.push_back({"second", material(scene)});
  scene.cables[0].sections = {{from, scene.cables[0].length, "second"}};
  return scene.materials.back().material;
}

/// Where a function changes its sign.
double root(const std::function<double(double)>& function, double low, double high) {
  const bool rises = function(high) > 0;
  for (int i = 0; i < 200; ++i) {
    const double middle = 0.5 * (low + high);
    ((function(middle) > 0) == rises ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

/// Two pieces of inextensible catenary (Irvine, Cable Structures, 1981): `horizontal` and `vertical` force [N] in its first end,
/// the latter along z.
struct TwoCatenaries {
  double break_at, length;
  std::array<double, 2> weights;  ///< [N/m]
  double horizontal = 1, vertical = 0;

  Eigen::Vector2d point(double s) const {
    Eigen::Vector2d at(0, 0);
    double up = vertical, done = 0;
    for (const int k : {0, 1}) {
      const double piece = std::min(s, k == 0 ? break_at : length) - done, w = weights[k];
      if (piece <= 0) break;
      const double next = up + w * piece;
      at += Eigen::Vector2d(horizontal / w * (std::asinh(next / horizontal) - std::asinh(up / horizontal)),
                            (std::hypot(next, horizontal) - std::hypot(up, horizontal)) / w);
      up = next;
      done += piece;
    }
    return at;
  }
};

/// Newton's method for the forces that lead to an end.
TwoCatenaries two_catenaries(double break_at, const std::array<double, 2>& weights, const Eigen::Vector2d& end) {
  TwoCatenaries chain{break_at, 1, weights};
  const double all = weights[0] * break_at + weights[1] * (1 - break_at);
  chain.horizontal = 0.5 * all;
  chain.vertical = -0.5 * all;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d miss = end - chain.point(1);
    constexpr double step = 1e-6;
    Eigen::Matrix2d slope;
    for (const int axis : {0, 1}) {
      TwoCatenaries other = chain;
      (axis == 0 ? other.horizontal : other.vertical) += step;
      slope.col(axis) = (other.point(1) - chain.point(1)) / step;
    }
    const Eigen::Vector2d change = slope.inverse() * miss;
    chain.horizontal = std::max(chain.horizontal + change[0], 0.2 * chain.horizontal);
    chain.vertical += change[1];
  }
  return chain;
}

class TwoDensities : public testing::TestWithParam<bool> {};

TEST_P(TwoDensities, HangAsTwoCatenaries) {
  constexpr double span = 0.7, rise = 0.1, break_at = 0.4, gravity = 9.81;
  constexpr std::array<double, 2> densities{0.1, 0.35};
  const bool settles = GetParam();
  const std::string name = std::string("catenary of two densities, ") + (settles ? "settled" : "at once");
  const TwoCatenaries exact = two_catenaries(break_at, {gravity * densities[0], gravity * densities[1]}, {span, rise});
  ASSERT_LT((exact.point(1) - Eigen::Vector2d(span, rise)).norm(), 1e-12);
  std::vector<Sample> forces;
  const auto shapes = sample({40, 80, 160}, [&](int n) {
    SceneDesc scene = scenes::between_two_points(n, span);
    scene.cables[0].attachments[1].offset.z() = rise;
    second_material(scene, break_at).linear_density = densities[1];
    if (settles) {
      scene.cables[0].initial.type = InitialShapeDesc::Type::points;
      scene.cables[0].initial.points = {Vector3::Zero(), {0.5 * span, 0, -0.33}, {span, 0, rise}};
    }
    Simulation run(scene);
    if (settles) {
      EXPECT_TRUE(run.world.settle());
    } else {
      run.run(0.1);  // tensions are found by steps
    }
    double largest = 0;
    for (int i = 0; i <= n; ++i) {
      const Eigen::Vector2d at = exact.point(static_cast<double>(i) / n);
      largest = std::max(largest, (run.positions()[i] - Vector3(at[0], 0, at[1])).norm());
    }
    const Vector3 force = run.force("left") - Vector3(exact.horizontal, 0, exact.vertical);
    forces.push_back({static_cast<double>(n), force.norm() / std::hypot(exact.horizontal, exact.vertical)});
    return largest;
  });
  report(name + ": shape", shapes, 5e-4, Order::second);
  report(name + ": end force", forces, 5e-4, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Starts, TwoDensities, testing::Bool());

/// The first stretch alike about y and z, or not, which gives the cable material frames.
class TwoBendingStiffnesses : public testing::TestWithParam<bool> {};

TEST_P(TwoBendingStiffnesses, CantileverBendsAsBeamTheorySays) {
  constexpr double break_at = 0.4, second = 0.25, payload = 1e4, load = 3e-4;
  // Of a load at the tip: the integral of (1 - s)^2 / EI.
  const double rest = std::pow(1 - break_at, 3), deflection = load / 3 * (1 - rest + rest / second);
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rod(n, 0.1);
    material(scene).linear_density = 1e-4;
    material(scene).torsional_stiffness = 1;
    if (GetParam()) material(scene).bending_stiffness = {1, 3};
    second_material(scene, break_at).bending_stiffness = second;
    scene.gravity.acceleration.z() = -load / payload;
    clamp_start(scene);
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    scene.cables[0].point_masses = {scenes::payload(payload)};
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    EXPECT_NEAR(run.torque("start").y() / load, 1, 1e-3);
    return -run.positions().back().z() / deflection - 1;
  });
  report(std::string("cantilever of two stiffnesses") + (GetParam() ? ", with frames" : ""), samples, 1e-3, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Frames, TwoBendingStiffnesses, testing::Bool());

class SteppedShaft : public testing::TestWithParam<bool> {};

TEST_P(SteppedShaft, TwistsAsTwoShaftsDo) {
  constexpr double break_at = 0.4, first = 2, second = 0.5, angle = 0.3;
  const double torque = angle / (break_at / first + (1 - break_at) / second);
  std::vector<Sample> energies;
  const auto torques = sample({10, 40}, [&](int n) {
    SceneDesc scene = rod(n, 0.1);
    material(scene).torsional_stiffness = first;
    if (GetParam()) material(scene).bending_stiffness = {1, 3};
    second_material(scene, break_at).torsional_stiffness = second;
    hold_ends(scene, AttachmentType::clamp, 1);
    start_at(scene, [](double s) { return Vector3(s, 0, 0); });
    Simulation run(scene);
    run.inputs[1].pose.orientation = Eigen::AngleAxisd(angle, Vector3::UnitX());
    run.step();
    EXPECT_TRUE(run.world.settle());
    const std::vector<double> twist = node_twist(run.cable().state);
    EXPECT_NEAR(twist[n / 5] / (torque / first), 1, 1e-6);
    EXPECT_NEAR(twist[4 * n / 5] / (torque / second), 1, 1e-6);
    energies.push_back({static_cast<double>(n), std::abs(run.world.energy().twist / (0.5 * torque * angle) - 1)});
    return run.torque("end").x() / -torque - 1;
  });
  const std::string name = std::string("stepped shaft") + (GetParam() ? ", with frames" : "");
  report(name + ": torque", torques, 1e-6, Order::none);
  report(name + ": energy", energies, 1e-6, Order::none);
}

INSTANTIATE_TEST_SUITE_P(Frames, SteppedShaft, testing::Bool());

/// A rope of two stretches, EA and density, between two walls.
struct TwoPartRope {
  static constexpr double break_at = 0.4, strain = 0.02;
  static constexpr std::array<double, 2> stiffness{1000, 250}, density{0.1, 0.9};
  double tension() const { return strain / (break_at / stiffness[0] + (1 - break_at) / stiffness[1]); }
  /// Of the material at s [m].
  double place(double s) const {
    const double first = std::min(s, break_at), rest = s - first;
    return s + tension() * (first / stiffness[0] + rest / stiffness[1]);
  }
  SceneDesc scene(int segments) const {
    SceneDesc scene = scenes::one_cable(segments);
    scene.gravity.acceleration.setZero();
    material(scene).axial_stiffness = stiffness[0];
    MaterialDesc& second = second_material(scene, break_at);
    second.axial_stiffness = stiffness[1];
    second.linear_density = density[1];
    hold_ends(scene, AttachmentType::hinge, 1 + strain);
    return scene;
  }
};

TEST(TwoPartRope, StretchesAsTwoSprings) {
  const TwoPartRope rope;
  const auto samples = sample({10, 40}, [&](int n) {
    SceneDesc scene = rope.scene(n);
    start_at(scene, [](double s) { return Vector3((1 + TwoPartRope::strain) * s, 0, 0); });
    Simulation run(scene);
    EXPECT_TRUE(run.world.settle());
    const double energy = 0.5 * rope.tension() * TwoPartRope::strain;
    EXPECT_NEAR(run.world.energy().stretch / energy, 1, 1e-6);
    EXPECT_NEAR(run.positions()[2 * n / 5].x() / rope.place(TwoPartRope::break_at), 1, 1e-6);
    return run.force("start").x() / rope.tension() - 1;
  });
  report("two-part rope: stretch", samples, 1e-6, Order::none);
}

/// k1 EA1 cot(k1 a) + k2 EA2 cot(k2 b) = 0 with wave numbers k = omega sqrt(mu / EA) (Graff, Wave Motion in Elastic Solids,
/// 1975).
TEST(TwoPartRope, SwingsAlongItself) {
  const TwoPartRope rope;
  const double a = TwoPartRope::break_at, b = 1 - a;
  const auto number = [](int k, double omega) { return omega * std::sqrt(TwoPartRope::density[k] / TwoPartRope::stiffness[k]); };
  const auto balance = [&](double omega) {
    const double k1 = number(0, omega), k2 = number(1, omega);
    return k1 * TwoPartRope::stiffness[0] * std::cos(k1 * a) * std::sin(k2 * b) +
           k2 * TwoPartRope::stiffness[1] * std::cos(k2 * b) * std::sin(k1 * a);
  };
  const double exact = root(balance, 50, 100);
  const auto shape = [&](double s) {
    const double k1 = number(0, exact), k2 = number(1, exact);
    return s < a ? std::sin(k1 * s) / std::sin(k1 * a) : std::sin(k2 * (1 - s)) / std::sin(k2 * b);
  };
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rope.scene(n);
    scene.time_step = 2 * M_PI / exact / 200 * 20 / n;
    start_at(scene, [&](double s) { return Vector3(rope.place(s) + 1e-3 * shape(s), 0, 0); });
    Simulation run(scene);
    const auto amplitude = [&](const Simulation& r) {
      double sum = 0;
      for (int i = 0; i <= n; ++i) {
        const double s = static_cast<double>(i) / n;
        sum += r.cable().state.masses[i] * (r.positions()[i].x() - rope.place(s)) * shape(s);
      }
      return sum;
    };
    return angular_frequency(run, amplitude, 5) / exact - 1;
  });
  report("two-part rope: lowest mode along", samples, 2e-3, Order::second);
}

/// A soft elastic pendulum with an inextensible middle. Time alone is refined: steps against steps a sixteenth as long.
TEST(StiffSection, KeepsOrderAndEnergyInASoftRope) {
  const auto swing = [](int steps) {
    constexpr double duration = 0.5;
    SceneDesc scene = scenes::released(20, 0.8);
    scene.time_step = duration / steps;
    scene.tolerance = 1e-6;
    material(scene).axial_stiffness = 30;
    scene.materials.push_back({"rod", material(scene)});
    scene.materials.back().material.axial_stiffness = infinity;
    scene.materials.back().material.linear_density = 0.3;
    scene.cables[0].sections = {{0.35, 0.7, "rod"}};
    Simulation run(scene);
    const double before = run.world.energy().total();
    run.run(duration);
    for (int i = 0; i < 20; ++i) {
      if (i < 7 || i >= 14) continue;
      EXPECT_NEAR(strain(run.cable().state, i), 0, 1e-9) << "segment " << i;
    }
    EXPECT_GT(strain(run.cable().state, 3), 0.01);
    EXPECT_GT(strain(run.cable().state, 16), 0.01);
    EXPECT_NEAR(run.world.energy().total(), before, 1e-6 * std::abs(before));
    return run.positions().back();
  };
  const Vector3 exact = swing(16000);
  std::vector<Sample> samples;
  for (const int steps : {500, 1000, 2000}) samples.push_back({static_cast<double>(steps), (swing(steps) - exact).norm()});
  report("stiff section in a soft rope, in time", samples, 1e-3, Order::second);
}

/// Transverse motion w e^(i omega t) of Euler and Bernoulli's beam: (w, w', EI w'', EI w''') at the end of a piece from that at
/// its start, by the exponential of the piece's matrix.
Eigen::Matrix4d transfer(double stiffness, double density, double omega, double length) {
  Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
  rate(0, 1) = 1;
  rate(1, 2) = 1 / stiffness;
  rate(2, 3) = 1;
  rate(3, 0) = density * omega * omega;
  constexpr int halvings = 10, terms = 12;
  rate *= length / (1 << halvings);
  Eigen::Matrix4d sum = Eigen::Matrix4d::Identity(), term = sum;
  for (int i = 1; i <= terms; ++i) {
    term = term * rate / i;
    sum += term;
  }
  for (int i = 0; i < halvings; ++i) sum = sum * sum;
  return sum;
}

class SteppedBeam : public testing::TestWithParam<bool> {};

TEST_P(SteppedBeam, SwingsAsItsTransferMatricesSay) {
  constexpr double break_at = 0.6, stiffness = 0.2, density = 0.4;  // of the second piece, relative
  const auto at = [&](double s, double omega) -> Eigen::Matrix4d {
    const Eigen::Matrix4d first = transfer(1, 1, omega, std::min(s, break_at));
    return s > break_at ? Eigen::Matrix4d(transfer(stiffness, density, omega, s - break_at) * first) : first;
  };
  const auto free_end = [&](double omega) { return at(1, omega).bottomRightCorner<2, 2>().determinant(); };
  const double exact = root(free_end, 1, 6);
  // Clamped: w = w' = 0 at the start; moment and shear that leave none at the end.
  const Eigen::Matrix4d whole = at(1, exact);
  const Eigen::Vector4d start(0, 0, -whole(2, 3) / whole(2, 2), 1);
  const double tip = (whole * start)[0];
  const auto shape = [&](double s) { return (at(s, exact) * start)[0] / tip; };
  const auto samples = sample({20, 40, 80}, [&](int n) {
    SceneDesc scene = rod(n, 2 * M_PI / exact / 200 * 20 / n);
    material(scene).torsional_stiffness = 1;
    if (GetParam()) material(scene).bending_stiffness = {1, 3};
    MaterialDesc& second = second_material(scene, break_at);
    second.bending_stiffness = stiffness;
    second.linear_density *= density;
    clamp_start(scene);
    start_at(scene, [&](double s) { return Vector3(s, 0, 1e-4 * shape(s)); });
    Simulation run(scene);
    return angular_frequency(run, projection(2, shape), 3) / (exact / time_unit) - 1;
  });
  report(std::string("stepped beam, lowest mode") + (GetParam() ? ", with frames" : ""), samples, 1e-2, Order::second);
}

INSTANTIATE_TEST_SUITE_P(Frames, SteppedBeam, testing::Bool());

/// On a floor, each part lies on its own radius, but where the thick one lifts the thin one beside it.
TEST(TwoRadii, LieOnAFloor) {
  constexpr double thin = 0.002, thick = 0.01;
  const auto samples = sample({50}, [&](int n) {
    SceneDesc scene = scenes::one_cable(n);
    material(scene).radius = thin;
    material(scene).drag = 1;
    MaterialDesc& sleeve = second_material(scene, 0.4);
    sleeve.radius = thick;
    scene.cables[0].sections[0].to = 0.6;
    scene.obstacles.push_back({});
    scene.obstacles.back().name = "floor";
    scene.obstacles.back().type = ShapeType::plane;
    start_at(scene, [](double s) { return Vector3(s, 0, 0.012); });
    Simulation run(scene);
    run.run(2);
    double largest = 0;
    for (int i = 0; i <= n; ++i) {
      const double s = static_cast<double>(i) / n, radius = s > 0.39 && s < 0.61 ? thick : thin;
      const bool is_lifted = (s > 0.25 && s < 0.39) || (s > 0.61 && s < 0.75);
      if (!is_lifted) largest = std::max(largest, std::abs(run.positions()[i].z() / radius - 1));
    }
    return largest;
  });
  report("two radii on a floor", samples, 0.02, Order::none);
}

}  // namespace
}  // namespace verlet_cable::validation
