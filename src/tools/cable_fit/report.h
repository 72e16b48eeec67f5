#pragma once

#include <string>
#include <vector>

#include "confidence.h"
#include "cross_validation.h"

namespace verlet_cable::cable_fit {

/// How well recordings are predicted, one entry each.
struct Errors {
  std::vector<PredictionError> as_numbered;  ///< of the recordings as they are
  std::vector<PredictionError> in_order;     ///< with swapped markers in their order
};

/// The same cable with another number of segments.
struct Resegmented {
  int segments;
  double error;  ///< [m] mean over recordings
};

/// What a fit to all recordings found, and how well it can be trusted.
struct FitResult {
  std::vector<double> values;             ///< a parameter, in its scale
  std::vector<double> with_exact_inputs;  ///< likewise, if hands moved exactly as smoothing has left them
  std::vector<Confidence> confidence;     ///< a parameter
  Errors fitted;                          ///< by the fit to all recordings
  std::vector<Resegmented> resegmented;   ///< errors of recordings in order
  std::vector<FittedCable> folds;         ///< fits that did not know the recording; empty if not asked for
  Errors left_out;                        ///< by these
};

/// A fit with what was looked for.
struct Fit {
  Problem problem;
  FitResult result;
};

/// [m] mean over recordings.
double mean_error(const std::vector<PredictionError>& errors);

/// The scene file: materials and cables; with `attachments` where the centre line was looked for, without `initial`.
std::string scene_yaml(const Fit& fit);

/// --report: parameters with their intervals, errors a recording, fitted and left out. `centre_line`: null if it was not looked
/// for.
std::string report_json(const std::vector<SwappedEnds>& swapped, const Fit& fit, const Fit* centre_line);

/// Tables for people.
std::string summary_text(const std::vector<SwappedEnds>& swapped, const Fit& fit, const Fit* centre_line);

/// Markers as predicted by the folds, in the format of recordings.
std::string prediction_csv(const Recording& recording, const Prediction& prediction);

}  // namespace verlet_cable::cable_fit
