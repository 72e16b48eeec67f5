// The direct solver of rods against a dense one.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <ostream>
#include <random>

#include "rod/rod_elimination.h"

namespace verlet_cable {
namespace {

using Eigen::Matrix3d;

Matrix3d cross_matrix(const Vector3& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

struct Case {
  int segments = 0;
  std::vector<int> held;
  bool elastic = false, touched = false;
  double tolerance = 1e-7;  ///< relative
};

std::ostream& operator<<(std::ostream& stream, const Case& c) {
  stream << c.segments << " segments," << (c.elastic ? " elastic," : "") << (c.touched ? " touched," : "") << " held at";
  for (const int node : c.held) stream << " " << node;
  return stream;
}

/// A bent rod under way, of a metre, its numbers as a step's may be.
struct RandomRod {
  explicit RandomRod(const Case& c) : generator(c.segments) {
    const int n = c.segments;
    system.resize(n);
    stiffness.resize(n);
    joints.resize(n + 1);
    stiffness.turning_part = 0.25;
    Vector3 direction(1.0 / n, 0, 0);
    for (int i = 0; i <= n; ++i) {
      system.diagonal[i] = between(1e3, 2e3);
      system.movable[i] = 1;
      set(system.load, i, vector(1));
    }
    for (const int i : c.held) system.movable[i] = 0;
    for (int i = 0; i < n; ++i) {
      direction = (direction + vector(0.3 / n)).normalized() / n;
      set(system.direction, i, direction);
      system.compliance[i] = c.elastic || c.held.size() > 1 ? between(1e-6, 1e-5) : 0;
      system.gap[i] = between(-1, 1) * 1e-3 / (n * n);
      stiffness.force_density[i] = between(-1, 5);
      stiffness.torque[i] = between(-1, 1) * 1e-3;
      add(stiffness.segment, i, 1, positive(1e-3));
      if (i == 0) continue;
      add(joints.convex_stiffness, i, 1, positive(1));
      set(joints.moment, i, vector(0.1));
    }
    if (c.touched)
      for (const int i : {0, n / 3, n / 3, n - 1}) {
        // On the centre line, and on the surface
        system.add_stiffness({0, i, between(0, 1)}, positive(1e5));
        const Vector3 along = get(system.direction, i).normalized(), across = along.cross(vector(1)).normalized();
        system.add_stiffness({0, i, between(0, 1), along, across, 0.1}, positive(1e5));
      }
  }

  double between(double low, double high) { return std::uniform_real_distribution<double>(low, high)(generator); }
  Vector3 vector(double size) { return size * Vector3(between(-1, 1), between(-1, 1), between(-1, 1)); }
  Matrix3d positive(double size) {
    Matrix3d m;
    m << vector(1), vector(1), vector(1);
    return size * (m * m.transpose() + 0.1 * Matrix3d::Identity());
  }

  std::mt19937 generator;
  KktSystem system;
  RodStiffness stiffness;
  RodJoints joints;
};

struct Solution {
  std::vector<Vector3> displacement, force;
  std::vector<double> multiplier, twist;
};

/// Unknowns: displacements x of the nodes, rotations w and stretches e of the segments, and the forces f that make
/// x_(i+1) - x_i = w x d + e d.
Solution solve_dense(const KktSystem& s, const RodStiffness& r, const RodJoints& joints, int n) {
  const auto x = [](int i) { return 3 * i; };
  const auto w = [n](int i) { return 3 * (n + 1) + 3 * i; };
  const auto f = [n](int i) { return 3 * (n + 1) + 3 * n + 3 * i; };
  const auto e = [n](int i) { return 3 * (n + 1) + 6 * n + i; };
  const int size = 3 * (n + 1) + 7 * n;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(size);
  const Matrix3d one = Matrix3d::Identity();
  for (int i = 0; i <= n; ++i) {
    a.block<3, 3>(x(i), x(i)) += s.diagonal[i] * one + get(s.added, i);
    b.segment<3>(x(i)) += get(s.load, i);
  }
  for (int i = 0; i < n; ++i) {
    const Vector3 d = get(s.direction, i);
    const double square = d.squaredNorm();
    a.block<3, 3>(x(i), x(i + 1)) += get(s.added_next, i);
    a.block<3, 3>(x(i + 1), x(i)) += get(s.added_next, i).transpose();
    a.block<3, 3>(x(i), f(i)) -= one;
    a.block<3, 3>(x(i + 1), f(i)) += one;
    a.block<3, 3>(f(i), x(i)) -= one;
    a.block<3, 3>(f(i), x(i + 1)) += one;
    a.block<3, 3>(f(i), w(i)) += cross_matrix(d);
    a.block<3, 1>(f(i), e(i)) -= d;
    a.block<3, 3>(w(i), w(i)) += get(r.segment, i);
    a.block<3, 3>(w(i), f(i)) -= cross_matrix(d);
    b.segment<3>(w(i)) += r.torque[i] * d.normalized();
    // What the multiplier m = f . d / d² - density e says of the stretch: e d² - compliance m = gap.
    a(e(i), e(i)) += square + s.compliance[i] * r.force_density[i];
    a.block<1, 3>(e(i), f(i)) -= s.compliance[i] / square * d.transpose();
    b[e(i)] += s.gap[i];
    if (i == 0) continue;
    const Matrix3d stiff = get(joints.stiffness(), i), turning = cross_matrix(r.turning_part * get(joints.moment, i));
    a.block<3, 3>(w(i - 1), w(i - 1)) += stiff;
    a.block<3, 3>(w(i), w(i)) += stiff;
    a.block<3, 3>(w(i - 1), w(i)) += turning - stiff;
    a.block<3, 3>(w(i), w(i - 1)) -= turning + stiff;
  }
  for (int i = 0; i <= n; ++i) {
    if (s.movable[i] != 0) continue;
    a.middleRows<3>(x(i)).setZero();
    a.block<3, 3>(x(i), x(i)) = one;
    b.segment<3>(x(i)).setZero();
  }
  const Eigen::VectorXd u = a.fullPivLu().solve(b);
  Solution solution;
  for (int i = 0; i <= n; ++i) solution.displacement.push_back(u.segment<3>(x(i)));
  for (int i = 0; i < n; ++i) {
    const Vector3 d = get(s.direction, i), force = u.segment<3>(f(i));
    // With what joins the nodes beyond what holds each of them, as it acts on the one that is nearer to an end.
    const Matrix3d added = get(s.added_next, i), symmetric = 0.5 * (added + added.transpose());
    const int inner = i < (n + 1) / 2 ? i + 1 : i;
    solution.force.push_back(force - symmetric * (u.segment<3>(x(i + 1)) - u.segment<3>(x(i))) -
                             (added - symmetric) * u.segment<3>(x(inner)));
    solution.multiplier.push_back(force.dot(d) / d.squaredNorm() - r.force_density[i] * u[e(i)]);
    solution.twist.push_back(u.segment<3>(w(i)).dot(d.normalized()));
  }
  return solution;
}

double largest(const std::vector<Vector3>& vectors) {
  double largest = 0;
  for (const Vector3& v : vectors) largest = std::max(largest, v.norm());
  return largest;
}

double largest(const std::vector<double>& numbers) {
  double largest = 0;
  for (const double number : numbers) largest = std::max(largest, std::abs(number));
  return largest;
}

class SolvesRods : public testing::TestWithParam<Case> {};

TEST_P(SolvesRods, AsADenseSolverDoes) {
  const int n = GetParam().segments;
  RandomRod rod(GetParam());
  RodElimination elimination;
  elimination.resize(n);
  EXPECT_TRUE(elimination.factor(rod.system, rod.stiffness, rod.joints));
  elimination.solve(rod.system, rod.stiffness.torque);
  const Solution dense = solve_dense(rod.system, rod.stiffness, rod.joints, n);
  const double tolerance = GetParam().tolerance;
  for (int i = 0; i <= n; ++i)
    EXPECT_LE((get(elimination.displacement(), i) - dense.displacement[i]).norm(), tolerance * largest(dense.displacement)) << i;
  for (int i = 0; i < n; ++i) {
    EXPECT_NEAR(elimination.multiplier()[i], dense.multiplier[i], tolerance * largest(dense.multiplier)) << i;
    EXPECT_NEAR(elimination.twist()[i], dense.twist[i], tolerance * largest(dense.twist)) << i;
    EXPECT_LE((get(elimination.force(), i) - dense.force[i]).norm(), tolerance * largest(dense.force)) << i;
  }
}

std::vector<Case> cases() {
  std::vector<Case> cases;
  for (const int n : {1, 2, 3, 4, 7, 12})
    for (const bool elastic : {false, true})
      for (const bool touched : {false, true})
        for (const std::vector<int>& held : {std::vector<int>{}, {0}, {n}, {0, n}, {n / 2}, {0, n / 2, n}})
          if (n > 3 || held.size() < 2) cases.push_back({n, held, elastic, touched});
  return cases;
}
/// Held nodes next to each other give way to each other a little, which the next correction of a step makes good.
std::vector<Case> neighbours() {
  std::vector<Case> cases;
  for (const int n : {7, 12, 30})
    for (const std::vector<int>& held : {std::vector<int>{n / 2, n / 2 + 1}, {0, n - 6, n - 5}, {0, 1, n}})
      cases.push_back({n, held, false, false, 1e-4});
  return cases;
}
INSTANTIATE_TEST_SUITE_P(Neighbours, SolvesRods, testing::ValuesIn(neighbours()));
INSTANTIATE_TEST_SUITE_P(Rods, SolvesRods, testing::ValuesIn(cases()));

TEST(RodElimination, TellsWhereTheMatrixIsNotPositive) {
  RandomRod rod({8, {0}, false, false});
  RodElimination elimination;
  elimination.resize(8);
  EXPECT_TRUE(elimination.factor(rod.system, rod.stiffness, rod.joints));
  add(rod.stiffness.segment, 2, -100, Matrix3d::Identity());
  EXPECT_FALSE(elimination.factor(rod.system, rod.stiffness, rod.joints));
}

}  // namespace
}  // namespace verlet_cable
