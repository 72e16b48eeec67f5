#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "recording.h"

namespace verlet_cable::cable_fit {

/// A recording without its camera's noise.
struct Smoothed {
  Recording recording;
  double noise = 0;     ///< [m] standard deviation of a coordinate, as far as it does not carry over from row to row
  double strength = 0;  ///< of the penalty on the hands' motion, over the weight of a row
};

/// Smooths every coordinate over time: least squares with a penalty on third differences (Whittaker 1923, Eilers 2003), as strong
/// as generalized cross-validation finds best for the recording's hands, and for the markers between them (Craven and Wahba
/// 1979). Two markers with 2 mm of noise on a hand give its direction to some degrees, and their shaking would be taken for
/// motion: it is the input of a fit, not what is compared.
Smoothed smoothed(const Recording& recording);

/// Divided third differences over rows, times such a power of the mean interval that they are plain differences where times are
/// even: what the penalty is on.
Eigen::SparseMatrix<double> third_differences(const std::vector<double>& times);

/// How many of a coordinate's degrees of freedom smoothing leaves, of so many rows.
double degrees_of_freedom(Eigen::Index rows, double strength);

}  // namespace verlet_cable::cable_fit
