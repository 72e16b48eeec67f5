#pragma once

#include <Eigen/Core>
#include <vector>

#include "differences.h"

namespace verlet_cable::cable_fit {

/// How well the recordings tell a parameter.
struct Confidence {
  double half_width = 0;  ///< of its 95 % interval, in the scale in which it is looked for; infinite: they do not tell it
  bool told = false;      ///< the interval is small enough to mean something, or far from 0, and the value not at its limit
};

/// What normal equations are scaled by on both sides, as parameters differ in scale by orders of magnitude.
Eigen::VectorXd scale_of(const Eigen::MatrixXd& information);
/// Of normal equations that are scaled so, which may be singular.
Eigen::MatrixXd inverse_scaled(const Eigen::MatrixXd& information, const Eigen::VectorXd& scale);

/// Adds the scatter of the gradient between parts of one of some recordings, into as many of which each is cut as it takes to
/// tell it (a sandwich estimate). Differences in units of what is expected of them, or of its square together with the slopes.
void add_scatter(const Eigen::MatrixXd& slopes, const Eigen::VectorXd& differences, int recordings, Eigen::MatrixXd& scatter);

/// One a parameter. Covariances: by what is known of noise and of the errors of the model, and by the scatter between parts of so
/// many recordings. The wider interval counts.
std::vector<Confidence> confidence_of(const std::vector<Parameter>& parameters, const std::vector<double>& values,
                                      const Eigen::MatrixXd& by_noise, const Eigen::MatrixXd& by_scatter, int recordings);

/// By the scatter between parts of all recordings, by their indices, alone, with motions of the hands taken for exact.
std::vector<Confidence> confidence_by_scatter(const Problem& problem, const std::vector<int>& all,
                                              const std::vector<double>& values);

}  // namespace verlet_cable::cable_fit
