#include <gtest/gtest.h>

#include <Eigen/LU>
#include <random>
#include <set>
#include <tuple>

#include "rod/block_elimination.h"

namespace verlet_cable {
namespace {

/// Segments, bending, held nodes.
using Case = std::tuple<int, bool, std::set<int>>;

class SaddleSolverAgainstDense : public testing::TestWithParam<Case> {};

TEST_P(SaddleSolverAgainstDense, SolvesTheSystem) {
  const auto [n, bending, held] = GetParam();
  std::mt19937 generator(n);
  std::uniform_real_distribution<double> uniform(-1, 1);
  KktSystem system;
  system.resize(n);
  const int nodes = n + 1, size = 3 * nodes + n;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd b(size);
  const auto couple = [&](int i, int j, double value) { a(i, j) = a(j, i) = value; };
  for (int i = 0; i < nodes; ++i) {
    system.movable[i] = held.count(i) ? 0 : 1;
    system.diagonal[i] = 20 + uniform(generator);
    for (std::vector<double>* load : {&system.load.x, &system.load.y, &system.load.z}) (*load)[i] = uniform(generator);
    b.segment<3>(3 * i) << system.load.x[i], system.load.y[i], system.load.z[i];
  }
  for (int i = 0; i < n; ++i) {
    system.first[i] = -3 + uniform(generator);
    system.second[i] = bending && i + 2 < nodes ? 1 + 0.3 * uniform(generator) : 0;
    for (std::vector<double>* d : {&system.direction.x, &system.direction.y, &system.direction.z}) (*d)[i] = uniform(generator);
    system.compliance[i] = held.count(i) && held.count(i + 1) ? 1 : i % 2 * 0.1;
    system.gap[i] = b[3 * nodes + i] = uniform(generator);
    a(3 * nodes + i, 3 * nodes + i) = -system.compliance[i];
    for (int c = 0; c < 3; ++c) {
      const double d = c == 0 ? system.direction.x[i] : c == 1 ? system.direction.y[i] : system.direction.z[i];
      couple(3 * i + c, 3 * nodes + i, -d);
      couple(3 * i + 3 + c, 3 * nodes + i, d);
    }
  }
  for (int i = 0; i < 3 * nodes; ++i) {
    a(i, i) = system.diagonal[i / 3];
    if (i / 3 < n) couple(i, i + 3, system.first[i / 3]);
    if (i / 3 + 1 < n) couple(i, i + 6, system.second[i / 3]);
  }
  for (const int node : held) {
    for (int i = 3 * node; i < 3 * node + 3; ++i) {
      a.row(i).setZero();
      a.col(i).setZero();
      a(i, i) = 1;
      b[i] = 0;
    }
  }

  BlockElimination solver;
  solver.resize(n);
  solver.factor(system, bending);
  solver.solve(system);
  const Eigen::VectorXd exact = a.partialPivLu().solve(b);
  // Numbers of order 1, systems of at most 50 unknowns: rounding only.
  for (int i = 0; i < nodes; ++i) {
    EXPECT_NEAR(solver.displacement().x[i], exact[3 * i], 1e-12);
    EXPECT_NEAR(solver.displacement().y[i], exact[3 * i + 1], 1e-12);
    EXPECT_NEAR(solver.displacement().z[i], exact[3 * i + 2], 1e-12);
  }
  for (int i = 0; i < n; ++i)
    EXPECT_NEAR(solver.multiplier()[i], exact[3 * nodes + i], 1e-12 * (1 + std::abs(exact[3 * nodes + i])));
}

std::vector<Case> cases() {
  std::vector<Case> out;
  for (const int n : {1, 2, 3, 4, 5, 6, 7, 10, 11})
    for (const bool bending : {false, true})
      for (const std::set<int>& held : {std::set<int>{}, {0}, {n}, {0, n / 2 + 1}, {0, 1, n}})
        // Rigid segments between two held ends leave one free node too little room.
        if (n > 2 || held.size() < 2) out.emplace_back(n, bending, held);
  return out;
}

INSTANTIATE_TEST_SUITE_P(Sizes, SaddleSolverAgainstDense, testing::ValuesIn(cases()));

}  // namespace
}  // namespace verlet_cable
