#include "supposed.h"

#include <Eigen/Dense>

namespace verlet_cable::cable_fit {

Supposed::Supposed(const Eigen::MatrixXd& information, Eigen::Index supposed) {
  const Eigen::Index others = information.rows() - supposed;
  const Eigen::MatrixXd coupling = information.topRightCorner(others, supposed);
  follow_ = -information.topLeftCorner(others, others).llt().solve(coupling);
  solver_.compute(information.bottomRightCorner(supposed, supposed) + coupling.transpose() * follow_);
}

Eigen::VectorXd Supposed::likeliest_with(const Eigen::VectorXd& normal) const {
  const Eigen::VectorXd sample = solver_.matrixU().solve(normal);
  Eigen::VectorXd result(follow_.rows() + sample.size());
  result << follow_ * sample, sample;
  return result;
}

Eigen::VectorXd pull_of(const Eigen::MatrixXd& one, const Eigen::MatrixXd& other, const Eigen::VectorXd& tangent,
                        double variance) {
  return (one - other).transpose() * tangent / (2 * variance);
}

}  // namespace verlet_cable::cable_fit
