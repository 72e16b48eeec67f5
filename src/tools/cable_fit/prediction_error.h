#pragma once

#include <vector>

#include "prediction.h"

namespace verlet_cable::cable_fit {

/// The first rows are given: their positions, and the velocities between them.
constexpr int given_rows = 2;

/// Predicted minus measured coordinates [m]: rows after those given, markers, axes.
std::vector<double> coordinate_errors(const Prediction& prediction, const Recording& recording);

/// How well a recording was predicted [m].
struct PredictionError {
  double mean = 0;     ///< of |predicted - measured| over rows, markers and coordinates
  double largest = 0;  ///< likewise, of any coordinate
  double last = 0;     ///< mean over the markers and coordinates of the last row
};
PredictionError prediction_error(const Prediction& prediction, const Recording& recording);

}  // namespace verlet_cable::cable_fit
