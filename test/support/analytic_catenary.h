#pragma once

#include <Eigen/Dense>
#include <cmath>

namespace verlet_cable::analytic {

/// Elastic catenary from the origin to (span, rise), z upwards. Irvine, Cable Structures, 1981, section 2.3: `horizontal` and
/// `vertical` are the tension's components at the origin, the vertical one upwards.
struct ElasticCatenary {
  double length = 0;           ///< [m] at rest
  double weight = 0;           ///< [N] of the whole cable
  double axial_stiffness = 0;  ///< EA [N]
  double horizontal = 0, vertical = 0;

  /// x and z [m] of the material point at arc length s [m] at rest.
  Eigen::Vector2d point(double s) const {
    const double h = horizontal, v = vertical, w = weight / length, rest = v - w * s;
    const double x = h * s / axial_stiffness + h / w * (std::asinh(v / h) - std::asinh(rest / h));
    const double drop = s / axial_stiffness * (v - 0.5 * w * s) + (std::hypot(h, v) - std::hypot(h, rest)) / w;
    return {x, -drop};
  }
};

/// Newton's method for the tension at the origin.
inline ElasticCatenary elastic_catenary(double span, double rise, double length, double weight, double axial_stiffness) {
  ElasticCatenary c{length, weight, axial_stiffness, 0.5 * weight, 0.5 * weight};
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector2d gap = Eigen::Vector2d(span, rise) - c.point(length);
    if (gap.norm() < 1e-14 * length) break;
    Eigen::Matrix2d slope;
    for (int k = 0; k < 2; ++k) {
      ElasticCatenary moved = c;
      const double change = 1e-6 * weight;
      (k == 0 ? moved.horizontal : moved.vertical) += change;
      slope.col(k) = (moved.point(length) - c.point(length)) / change;
    }
    const Eigen::Vector2d correction = slope.partialPivLu().solve(gap);
    c.horizontal = std::max(0.2 * c.horizontal, c.horizontal + correction[0]);
    c.vertical += correction[1];
  }
  return c;
}

}  // namespace verlet_cable::analytic
