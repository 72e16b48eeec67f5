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

/// What a fit to all recordings found, and how well it can be trusted.
struct FitResult {
  std::vector<double> values;          ///< a parameter, in its scale
  std::vector<Confidence> confidence;  ///< a parameter
  Errors fitted;                       ///< by the fit to all recordings
  Errors left_out;                     ///< by the fits that did not know the recording; empty if not asked for
};

/// [m] mean over recordings.
double mean_error(const std::vector<PredictionError>& errors);

/// The scene file: materials and cables, without `initial` and `attachments`.
std::string scene_yaml(const Problem& problem, const FitResult& result);

/// --report: parameters with their intervals, errors a recording, fitted and left out.
std::string report_json(const Problem& problem, const std::vector<SwappedEnds>& swapped, const FitResult& result);

/// A table for people.
std::string summary_text(const Problem& problem, const std::vector<SwappedEnds>& swapped, const FitResult& result);

}  // namespace verlet_cable::cable_fit
