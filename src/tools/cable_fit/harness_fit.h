#pragma once

#include <string>
#include <vector>

#include "confidence.h"
#include "harness_prediction.h"

namespace verlet_cable::cable_fit {

/// A harness as some recordings tell it.
struct FittedHarness {
  HarnessSettings settings;
  std::vector<double> values;  ///< a parameter
};

/// How well a recording was predicted [m], over the rows after those that are given.
struct HarnessError {
  double mean = 0;              ///< of |predicted - measured| over all markers and coordinates
  double root_mean_square = 0;  ///< of a coordinate, of the markers that nothing holds
  double largest = 0;           ///< of a coordinate
};

/// What fits to recordings of a harness found.
struct HarnessFit {
  std::vector<Parameter> parameters;
  FittedHarness fitted;                       ///< by all recordings
  std::vector<Confidence> confidence;         ///< a parameter
  std::vector<HarnessError> errors;           ///< a recording
  std::vector<FittedHarness> folds;           ///< a recording: by those that were not left out with it; empty if not asked for
  std::vector<Prediction> predictions;        ///< likewise
  std::vector<HarnessError> left_out_errors;  ///< likewise
};

struct HarnessProblem {
  const std::vector<Recording>& recordings;
  const std::vector<Smoothed>& inputs;
  HarnessSettings settings;  ///< as given: nothing measured
  std::function<void()> simulated;
};

/// The recordings that are left out together: every so many-th one.
std::vector<std::vector<int>> left_out_parts(int recordings, int parts);

/// Largest number of recordings that fit_harness() simulates.
int most_simulations(const HarnessProblem& problem, int parts);

/// Fits a harness to recordings. `parts`: in which they are left out of further fits, which begin anew, and predict them; 0:
/// none.
HarnessFit fit_harness(const HarnessProblem& problem, int parts);

/// The fit to some of the recordings, by their indices. `begin`: a value a parameter, where it begins; empty: anew.
FittedHarness fit_harness(const HarnessProblem& problem, const std::vector<int>& training, const std::vector<double>& begin);

HarnessError harness_error(const Harness& harness, const Prediction& prediction, const Recording& recording);
/// Root of the mean of squares, over recordings [m].
double root_mean_square(const std::vector<HarnessError>& errors);

}  // namespace verlet_cable::cable_fit
