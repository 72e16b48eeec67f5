#pragma once

#include <vector>

#include "differences.h"
#include "prediction_error.h"

namespace verlet_cable::cable_fit {

/// How well recordings are predicted, each with its own set of parameters.
std::vector<PredictionError> prediction_errors(const CableSettings& settings, const std::vector<Recording>& recordings,
                                               const std::vector<std::vector<double>>& values);

/// The recordings that are left out together: pairs in the order in which they were given, single ones where there are few.
std::vector<std::vector<int>> left_out_together(int recordings);

/// For each recording the parameters that fit those best which were not left out with it, looked for from the start: nothing
/// carries over from a fit that knew it. At least two recordings.
std::vector<std::vector<double>> left_out_fits(const Problem& problem);

}  // namespace verlet_cable::cable_fit
