#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "cable_parameters.h"
#include "smoothing.h"

namespace verlet_cable::cable_fit {

/// The cable that is looked for, and where.
struct Problem {
  const std::vector<Recording>& recordings;  ///< what predictions are compared with
  const std::vector<Smoothed>& inputs;       ///< what they start from and what holds the cable: the same, smoothed
  CableSettings settings;
  std::vector<Parameter> parameters;
  std::function<void()> simulated;  ///< called whenever a recording was simulated, from one thread at a time
  /// Of a harness: what predicts a recording, by its index, with so many segments of its trunk; empty: it is one cable.
  std::function<Prediction(int segments, const std::vector<double>& values, int recording)> predict_harness = {};
  /// Where no markers were recorded: by how much [m] a recording is missed, by its index, with so many segments; else empty.
  /// Their numbers do not depend on the values.
  std::function<std::vector<double>(int segments, const std::vector<double>& values, int recording)> missed_by = {};
  std::vector<std::size_t> missed_counts = {};  ///< likewise: how many, a recording
};

/// Predicted minus measured coordinates of a recording in units of the scatter that is expected of them, so that their squares
/// add up with those of a prior; large ones count linearly (pseudo-Huber), so that a few bad markers do not decide.
struct RecordingDifferences {
  Eigen::VectorXd values;  ///< a coordinate
  Eigen::MatrixXd slopes;  ///< a coordinate, a parameter; empty if they were not asked for
};
using Linearization = std::vector<RecordingDifferences>;

/// So many neighbouring coordinates err alike: rows within some tenths of a second, neighbouring markers.
constexpr double alike = 100;

/// A difference [m], a large one tamed: half its square is the pseudo-Huber loss.
double robust(double difference);

std::size_t difference_count(const Problem& problem, int recording);

/// Those of some recordings, in their order; slopes by differences, the simulations on all cores.
Linearization linearize(const Problem& problem, const std::vector<int>& recordings, const std::vector<double>& values,
                        bool with_slopes);

/// What the parameters' priors add: a value a parameter, 0 where there is none.
struct Prior {
  Prior(const std::vector<Parameter>& parameters, const std::vector<double>& at);
  Eigen::VectorXd values;
  Eigen::MatrixXd slopes;  ///< a parameter, a parameter
};

}  // namespace verlet_cable::cable_fit
