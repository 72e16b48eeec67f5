#pragma once

#include <Eigen/Cholesky>

namespace verlet_cable::cable_fit {

/// Numbers of which the last ones are not measured, only supposed to be somewhere about zero.
class Supposed {
 public:
  /// `information`: of all of them, the inverse of their covariance.
  Supposed(const Eigen::MatrixXd& information, Eigen::Index supposed);

  /// A sample of what is supposed, by as many standard normal numbers, after what is likeliest with it of the others.
  Eigen::VectorXd likeliest_with(const Eigen::VectorXd& normal) const;

 private:
  Eigen::MatrixXd follow_;              // of the others, by what is supposed
  Eigen::LLT<Eigen::MatrixXd> solver_;  // of what is supposed, whatever the others are
};

/// What integrating out a sample of what is supposed adds to the gradient of half the squares of differences: half the derivative
/// of the logarithm of its information's determinant (Laplace's approximation). `one`, `other`: slopes of the differences with
/// the sample, and with its opposite; `tangent`: what the sample changes of the differences; `variance`: of a difference.
Eigen::VectorXd pull_of(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other, const Eigen::VectorXd& tangent,
                        double variance);

}  // namespace verlet_cable::cable_fit
