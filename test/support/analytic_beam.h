#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

/// Straight beams and strings of length 1: what a textbook says of them.
namespace verlet_cable::analytic {

/// Zeros of J0.
constexpr double bessel_zeros[] = {2.404825557695773, 5.520078110286311, 8.653727912911012};

/// Roots of cos(b) cosh(b) = -1: natural frequencies of a cantilever, b^2 sqrt(EI / mu) / L^2. (Blevins, Formulas for Natural
/// Frequency and Mode Shape, 1979, table 8-1.)
constexpr double cantilever_roots[] = {1.875104068711961, 4.694091132974175};

/// Mode shape of a cantilever at s from its clamp, in lengths.
inline double cantilever_mode(double root, double s) {
  const double ratio = (std::cosh(root) + std::cos(root)) / (std::sinh(root) + std::sin(root));
  return std::cosh(root * s) - std::cos(root * s) - ratio * (std::sinh(root * s) - std::sin(root * s));
}

/// Shape of a cantilever along +x under a transverse load at its tip: EI theta'' = -P cos(theta), theta(0) = 0, theta'(1) = 0.
/// (Bisshopp and Drucker, Large deflection of cantilever beams, 1945; the numbers: Mattiasson, Numerical results from large
/// deflection beam and frame problems analysed by means of elliptic integrals, 1981.) `load`: P L^2 / EI. Point i of n + 1: x and
/// deflection in lengths.
inline std::vector<Eigen::Vector2d> elastica(double load, int n) {
  constexpr int substeps = 200;
  const double h = 1.0 / (n * substeps);
  std::vector<Eigen::Vector2d> points(n + 1);
  // State: angle, curvature, x, deflection; Runge-Kutta's fourth order.
  const auto slope = [load](const Eigen::Vector4d& y) {
    return Eigen::Vector4d(y[1], -load * std::cos(y[0]), std::cos(y[0]), std::sin(y[0]));
  };
  const auto tip_curvature = [&](double curvature) {
    Eigen::Vector4d y(0, curvature, 0, 0);
    for (int i = 0; i < n * substeps; ++i) {
      if (i % substeps == 0) points[i / substeps] = {y[2], y[3]};
      const Eigen::Vector4d a = slope(y), b = slope(y + 0.5 * h * a), c = slope(y + 0.5 * h * b), d = slope(y + h * c);
      y += h / 6 * (a + 2 * b + 2 * c + d);
    }
    points[n] = {y[2], y[3]};
    return y[1];
  };
  // The tip's curvature grows with the root's up to the load's own moment, P L.
  double low = 0, high = load;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (tip_curvature(middle) > 0 ? high : low) = middle;
  }
  return points;
}

}  // namespace verlet_cable::analytic
