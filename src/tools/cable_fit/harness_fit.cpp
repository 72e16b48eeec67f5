#include "harness_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/world/parallel_for.h"
#include "least_squares.h"
#include "prediction_error.h"

namespace verlet_cable::cable_fit {
namespace {

/// Where branches' parameters begin.
constexpr double branch_bending[] = {1e-3, 3e-3, 1e-2, 3e-2, 1e-1};  // EI over the linear density [N m^3 / kg]
constexpr double starting_times[] = {0.01, 0.1};                     // [s] damping over stiffness

/// Fits of parts of the recordings begin far off, that of all of them begins where one of these ended.
constexpr Ending from_guess{4, 2, 5e-3, 0}, from_part{2, 1, 1e-3, 0};

std::vector<int> all_of(const HarnessProblem& problem) {
  std::vector<int> all(problem.recordings.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

HarnessSettings measured(const HarnessProblem& problem, const std::vector<int>& which) {
  HarnessSettings settings = problem.settings;
  measure_harness(problem.recordings, problem.inputs, which, settings);
  measure_branches(problem.inputs, which, settings);
  return settings;
}

/// The same as a problem of least squares.
Problem least_squares_problem(const HarnessProblem& problem, const HarnessSettings& settings) {
  Problem result{problem.recordings, problem.inputs, {}, harness_parameters(settings), problem.simulated};
  result.settings.segments = settings.segments;
  result.predict_harness = [settings, &problem](int segments, const std::vector<double>& values, int recording) {
    return predict_harness(settings, segments, values, problem.inputs[recording].recording);
  };
  return result;
}

/// The best of straight cables of one material.
std::vector<double> coarse_harness_search(Problem problem, const HarnessSettings& settings, const std::vector<int>& training) {
  problem.settings.segments = std::min(problem.settings.segments, coarse_segments);
  std::vector<double> best;
  double least = infinity;
  for (const double bending : branch_bending)
    for (const double time : starting_times) {
      std::vector<double> values = first_harness_guess(settings, bending, time * bending);
      double cost = 0;
      for (const RecordingDifferences& recording : linearize(problem, training, values, false))
        cost += recording.values.squaredNorm();
      if (cost >= least && !best.empty()) continue;
      least = cost;
      best = std::move(values);
    }
  return best;
}

std::vector<Prediction> predict_all(const HarnessProblem& problem, const std::vector<FittedHarness>& harnesses) {
  std::vector<Prediction> predictions(problem.recordings.size());
  parallel_for(predictions.size(), [&](std::size_t i) {
    const auto& [settings, values] = harnesses[i];
    predictions[i] = predict_harness(settings, settings.segments, values, problem.inputs[i].recording);
  });
  return predictions;
}

std::vector<HarnessError> errors_of(const HarnessProblem& problem, const std::vector<Prediction>& predictions) {
  std::vector<HarnessError> errors;
  for (std::size_t i = 0; i < predictions.size(); ++i)
    errors.push_back(harness_error(problem.settings.harness, predictions[i], problem.recordings[i]));
  return errors;
}

}  // namespace

std::vector<std::vector<int>> left_out_parts(int recordings, int parts) {
  std::vector<std::vector<int>> left_out(std::min(parts, recordings));
  for (int i = 0; i < recordings; ++i) left_out[i % left_out.size()].push_back(i);
  return left_out;
}

int most_simulations(const HarnessProblem& problem, int parts) {
  const int count = static_cast<int>(problem.recordings.size());
  const Problem least_squares = least_squares_problem(problem, measured(problem, all_of(problem)));
  int simulations = most_simulations(least_squares, count, parts > 0 ? from_part : from_guess);
  if (parts > 0)
    for (const std::vector<int>& left_out : left_out_parts(count, parts))
      simulations += most_simulations(least_squares, count - static_cast<int>(left_out.size()), from_guess);
  return simulations;
}

FittedHarness fit_harness(const HarnessProblem& problem, const std::vector<int>& training, const std::vector<double>& begin) {
  FittedHarness fitted{measured(problem, training), {}};
  const Problem least_squares = least_squares_problem(problem, fitted.settings);
  const bool anew = begin.empty();
  fitted.values = fit(least_squares, training, anew ? coarse_harness_search(least_squares, fitted.settings, training) : begin,
                      anew ? from_guess : from_part);
  return fitted;
}

HarnessFit fit_harness(const HarnessProblem& problem, int parts) {
  const std::vector<int> all = all_of(problem);
  HarnessFit result;
  if (parts > 0) {
    result.folds.resize(all.size());
    for (const std::vector<int>& left_out : left_out_parts(static_cast<int>(all.size()), parts)) {
      std::vector<int> training;
      std::set_difference(all.begin(), all.end(), left_out.begin(), left_out.end(), std::back_inserter(training));
      const FittedHarness fitted = fit_harness(problem, training, {});
      for (const int i : left_out) result.folds[i] = fitted;
    }
    result.predictions = predict_all(problem, result.folds);
    result.left_out_errors = errors_of(problem, result.predictions);
  }
  result.fitted = fit_harness(problem, all, parts > 0 ? result.folds.front().values : std::vector<double>());
  const Problem least_squares = least_squares_problem(problem, result.fitted.settings);
  result.parameters = least_squares.parameters;
  result.confidence = confidence_by_scatter(least_squares, all, result.fitted.values);
  result.errors = errors_of(problem, predict_all(problem, std::vector<FittedHarness>(all.size(), result.fitted)));
  return result;
}

HarnessError harness_error(const Harness& harness, const Prediction& prediction, const Recording& recording) {
  HarnessError error;
  const std::vector<double> all = coordinate_errors(prediction, recording);
  const std::size_t in_row = 3 * static_cast<std::size_t>(recording.marker_count());
  std::size_t free = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    error.mean += std::abs(all[i]) / static_cast<double>(all.size());
    error.largest = std::max(error.largest, std::abs(all[i]));
    if (std::binary_search(harness.held.begin(), harness.held.end(), static_cast<int>(i % in_row / 3))) continue;
    error.root_mean_square += all[i] * all[i];
    ++free;
  }
  error.root_mean_square = std::sqrt(error.root_mean_square / static_cast<double>(free));
  return error;
}

double root_mean_square(const std::vector<HarnessError>& errors) {
  double sum = 0;
  for (const HarnessError& error : errors) sum += error.root_mean_square * error.root_mean_square;
  return std::sqrt(sum / static_cast<double>(errors.size()));
}

}  // namespace verlet_cable::cable_fit
