#include "least_squares.h"

#include <ceres/ceres.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "prediction_error.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr double starting_bending[] = {1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1, 1};  // EI over the linear density [N m^3 / kg]
constexpr double starting_damping[] = {1e-4, 1e-3, 5e-3};                       // of bending, likewise [N m^3 s / kg]
constexpr int coarse_segments = 16;                                             ///< of the search
constexpr int few_segments = 24;                                                ///< of a fit's first part
constexpr double first_trust_radius = 30;

SceneDesc coarse(const CableSettings& settings, const std::vector<double>& values) {
  CableSettings coarser = settings;
  coarser.segments = std::min(settings.segments, coarse_segments);
  return cable_scene(coarser, values);
}

/// The differences of all training recordings as one block: one block each would be summed in the order in which threads end, and
/// the result would depend on it.
class Cost : public ceres::CostFunction {
 public:
  Cost(const Problem& problem, const std::vector<int>& training) : problem_(problem), training_(training) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.parameters.size()));
    std::size_t count = problem.parameters.size();
    for (const int i : training) count += difference_count(problem.recordings[i]);
    set_num_residuals(static_cast<int>(count));
  }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const std::vector<double> values(blocks[0], blocks[0] + problem_.parameters.size());
    const Linearization linear = linearize(problem_, training_, values, jacobians && jacobians[0]);
    double* residual = residuals;
    double* row = jacobians ? jacobians[0] : nullptr;
    for (const RecordingDifferences& of_recording : linear) {
      for (Eigen::Index i = 0; i < of_recording.values.size(); ++i) {
        *residual++ = of_recording.values[i];
        if (!row) continue;
        for (Eigen::Index k = 0; k < of_recording.slopes.cols(); ++k) *row++ = of_recording.slopes(i, k);
      }
    }
    const Prior prior(problem_.parameters, values);
    for (Eigen::Index i = 0; i < prior.values.size(); ++i) {
      *residual++ = prior.values[i];
      if (!row) continue;
      for (Eigen::Index k = 0; k < prior.slopes.cols(); ++k) *row++ = prior.slopes(i, k);
    }
    return true;
  }

 private:
  const Problem& problem_;
  const std::vector<int>& training_;
};

std::vector<double> minimize(const Problem& problem, const std::vector<int>& training, std::vector<double> values, int iterations,
                             double tolerance) {
  Cost cost(problem, training);
  ceres::Problem::Options ownership;
  ownership.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem least_squares(ownership);
  least_squares.AddResidualBlock(&cost, nullptr, values.data());
  for (std::size_t i = 0; i < values.size(); ++i) {
    least_squares.SetParameterLowerBound(values.data(), static_cast<int>(i), problem.parameters[i].lowest);
    least_squares.SetParameterUpperBound(values.data(), static_cast<int>(i), problem.parameters[i].highest);
  }
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  options.max_num_iterations = iterations;
  options.function_tolerance = tolerance;
  options.initial_trust_region_radius = first_trust_radius;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &least_squares, &summary);
  return values;
}

}  // namespace

int most_simulations(const Problem& problem, int recordings, const Ending& ending) {
  const int guesses = static_cast<int>(std::size(starting_bending) * std::size(starting_damping));
  return recordings * (guesses + (ending.iterations + ending.refinements) * static_cast<int>(problem.parameters.size() + 1));
}

std::vector<double> coarse_search(const Problem& problem, const std::vector<int>& training) {
  std::vector<std::vector<double>> guesses;
  for (const double bending : starting_bending)
    for (const double damping : starting_damping) guesses.push_back(first_guess(problem.settings, bending, damping));
  const int recordings = static_cast<int>(training.size());
  std::vector<double> errors(guesses.size() * training.size());
  std::mutex mutex;
  tbb::parallel_for(0, static_cast<int>(errors.size()), [&](int i) {
    const int recording = training[i % recordings];
    const std::vector<double>& guess = guesses[i / recordings];
    const Prediction prediction =
        predict(coarse(problem.settings, guess), markers_of(problem.settings, guess), problem.inputs[recording].recording);
    errors[i] = prediction_error(prediction, problem.recordings[recording]).mean;
    const std::lock_guard<std::mutex> lock(mutex);
    problem.simulated();
  });
  std::vector<double> sums(guesses.size(), 0.0);
  for (std::size_t i = 0; i < errors.size(); ++i) sums[i / training.size()] += errors[i];
  return guesses[std::min_element(sums.begin(), sums.end()) - sums.begin()];
}

std::vector<double> fit(const Problem& problem, const std::vector<int>& training, std::vector<double> values,
                        const Ending& ending) {
  if (problem.settings.segments > few_segments) {
    Problem with_few = problem;
    with_few.settings.segments = few_segments;
    values = minimize(with_few, training, std::move(values), ending.iterations, ending.tolerance);
    return minimize(problem, training, std::move(values), ending.refinements, ending.tolerance);
  }
  return minimize(problem, training, std::move(values), ending.iterations, ending.tolerance);
}

}  // namespace verlet_cable::cable_fit
