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

/// Into so many parts each of some recordings is cut, so that there are enough to tell the scatter between them.
int parts_of_each(int recordings);

/// One a parameter. Covariances: by what is known of noise and of the errors of the model, and by the scatter between parts of
/// the recordings (a sandwich estimate), of so many degrees of freedom. The wider interval counts.
std::vector<Confidence> confidence_of(const std::vector<Parameter>& parameters, const std::vector<double>& values,
                                      const Eigen::MatrixXd& by_noise, const Eigen::MatrixXd& by_scatter, int degrees);

/// By the scatter between parts of all recordings alone, with motions of the hands taken for exact.
std::vector<Confidence> confidence_by_scatter(const Problem& problem, const std::vector<double>& values);

}  // namespace verlet_cable::cable_fit
