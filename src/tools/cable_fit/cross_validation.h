#pragma once

#include <vector>

#include "differences.h"
#include "prediction_error.h"

namespace verlet_cable::cable_fit {

/// A cable as some recordings tell it.
struct FittedCable {
  CableSettings settings;
  std::vector<double> values;  ///< a parameter
};

/// The recordings as predicted, each by a cable of its own.
std::vector<Prediction> predictions(const std::vector<FittedCable>& cables, const std::vector<Recording>& recordings);

/// How far predictions are off.
std::vector<PredictionError> prediction_errors(const std::vector<FittedCable>& cables, const std::vector<Recording>& recordings);

/// The recordings that are left out together: pairs in the order in which they were given, single ones where there are few.
std::vector<std::vector<int>> left_out_together(int recordings);

/// For each recording the cable that fits those best which were not left out with it, looked for from the start: nothing carries
/// over from a fit that knew it, nothing that is measured on the recordings either. At least two recordings. `on_markers`: where
/// the centre line is looked for, the same of lines through the markers, with which it begins; else empty.
std::vector<FittedCable> left_out_fits(const Problem& problem, const std::vector<FittedCable>& on_markers);

}  // namespace verlet_cable::cable_fit
