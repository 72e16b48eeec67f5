#include "least_squares.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <limits>
#include <mutex>

#include "core/world/parallel_for.h"
#include "prediction_error.h"

namespace verlet_cable::cable_fit {
namespace {

constexpr double starting_bending[] = {1e-3, 3e-3, 1e-2, 3e-2, 1e-1, 3e-1, 1};  // EI over the linear density [N m^3 / kg]
constexpr double starting_damping[] = {1e-4, 1e-3, 5e-3};                       // of bending, likewise [N m^3 s / kg]
constexpr Ending for_valleys{2, 0, 1e-2, 0};                                    ///< far enough to tell them apart
constexpr int few_segments = 24;                                                ///< of a fit's first part
constexpr double tolerance_with_few = 1e-2;
constexpr double first_trust_radius = 30;
constexpr int most_steps = 12;  ///< of a round

constexpr int bending_guesses = std::size(starting_bending), damping_guesses = std::size(starting_damping);
/// Of the guesses, no two of which are neighbours.
constexpr int most_valleys = ((bending_guesses + 1) / 2) * ((damping_guesses + 1) / 2);

Problem with_segments(Problem problem, int most) {
  problem.settings.segments = std::min(problem.settings.segments, most);
  return problem;
}

/// The differences of all training recordings as one block: one block each would be summed in the order in which threads end, and
/// the result would depend on it. Slopes take most of the time: they are found once, and then follow what steps have changed
/// (Broyden's update).
class Cost : public ceres::CostFunction {
 public:
  Cost(const Problem& problem, const std::vector<int>& training) : problem_(problem), training_(training) {
    mutable_parameter_block_sizes()->push_back(static_cast<int>(problem.parameters.size()));
    for (const int i : training) count_ += static_cast<Eigen::Index>(difference_count(problem, i));
    set_num_residuals(static_cast<int>(count_ + problem.parameters.size()));
  }

  /// The next slopes are found anew.
  void forget_slopes() { slopes_.resize(0, 0); }

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override {
    const std::vector<double> values(blocks[0], blocks[0] + problem_.parameters.size());
    const bool with_slopes = jacobians && jacobians[0];
    if (with_slopes && slopes_.size() == 0)
      find_slopes(values);
    else if (values != evaluated_at_)
      find_differences(values, linearize(problem_, training_, values, false));
    if (with_slopes && values != slopes_at_) update_slopes();
    const Prior prior(problem_.parameters, values);
    Eigen::Map<Eigen::VectorXd> all(residuals, num_residuals());
    all << differences_, prior.values;
    if (!with_slopes) return true;
    Eigen::Map<Slopes> matrix(jacobians[0], num_residuals(), static_cast<Eigen::Index>(values.size()));
    matrix << slopes_, prior.slopes;
    return true;
  }

 private:
  using Slopes = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  void find_differences(const std::vector<double>& values, const Linearization& linear) const {
    evaluated_at_ = values;
    differences_.resize(count_);
    Eigen::Index row = 0;
    for (const RecordingDifferences& of_recording : linear) {
      differences_.segment(row, of_recording.values.size()) = of_recording.values;
      row += of_recording.values.size();
    }
  }

  void find_slopes(const std::vector<double>& values) const {
    const Linearization linear = linearize(problem_, training_, values, true);
    find_differences(values, linear);
    slopes_.resize(count_, static_cast<Eigen::Index>(values.size()));
    Eigen::Index row = 0;
    for (const RecordingDifferences& of_recording : linear) {
      slopes_.middleRows(row, of_recording.slopes.rows()) = of_recording.slopes;
      row += of_recording.slopes.rows();
    }
    slopes_at_ = values;
    differences_there_ = differences_;
  }

  /// Slopes along the step since then become what it has changed; of parameters in units of what derivatives are taken over.
  void update_slopes() const {
    const auto count = static_cast<Eigen::Index>(slopes_at_.size());
    Eigen::VectorXd step(count), weighted(count);
    for (Eigen::Index k = 0; k < count; ++k) {
      step[k] = evaluated_at_[k] - slopes_at_[k];
      weighted[k] = step[k] / (problem_.parameters[k].step * problem_.parameters[k].step);
    }
    const Eigen::VectorXd missed = differences_ - differences_there_ - slopes_ * step;
    slopes_ += missed * (weighted / step.dot(weighted)).transpose();
    slopes_at_ = evaluated_at_;
    differences_there_ = differences_;
  }

  const Problem& problem_;
  const std::vector<int>& training_;
  Eigen::Index count_ = 0;
  mutable std::vector<double> evaluated_at_, slopes_at_;
  mutable Eigen::VectorXd differences_, differences_there_;
  mutable Slopes slopes_;
};

/// Ends a round where slopes that were updated lead no further.
class EndOfRound : public ceres::IterationCallback {
 public:
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& iteration) override {
    if (iteration.iteration == 0) return ceres::SOLVER_CONTINUE;
    if (!iteration.step_is_successful && moved_) return ceres::SOLVER_TERMINATE_SUCCESSFULLY;
    if (iteration.step_is_successful) {
      moved_ = true;
      radius_ = iteration.trust_region_radius;
    }
    return ceres::SOLVER_CONTINUE;
  }
  /// After the last step that led further.
  double trust_radius() const { return radius_; }

 private:
  bool moved_ = false;
  double radius_ = first_trust_radius;
};

struct Minimum {
  std::vector<double> values;
  double cost;
};

/// `rounds`: each finds slopes anew.
Minimum minimize(const Problem& problem, const std::vector<int>& training, std::vector<double> values, int rounds,
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
  options.max_num_iterations = most_steps;
  options.function_tolerance = tolerance / 10;
  options.initial_trust_region_radius = first_trust_radius;
  options.logging_type = ceres::SILENT;
  double cost_reached = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    cost.forget_slopes();
    EndOfRound ending;
    options.callbacks = {&ending};
    ceres::Solver::Summary summary;
    ceres::Solve(options, &least_squares, &summary);
    cost_reached = summary.final_cost;
    if (summary.initial_cost - summary.final_cost <= tolerance * summary.initial_cost) break;
    options.initial_trust_region_radius = ending.trust_radius();
  }
  return {values, cost_reached};
}

std::vector<double> guess(const Problem& problem, int bending, int damping) {
  return first_guess(problem.settings, starting_bending[bending], starting_damping[damping]);
}

using GuessErrors = std::array<std::array<double, damping_guesses>, bending_guesses>;

/// [m] of each guess, summed over the recordings.
GuessErrors guess_errors(const Problem& problem, const std::vector<int>& training) {
  constexpr std::size_t guesses = bending_guesses * damping_guesses;
  std::vector<double> errors(guesses * training.size());
  std::mutex mutex;
  parallel_for(errors.size(), [&](std::size_t i) {
    const int recording = training[i / guesses], which = static_cast<int>(i % guesses);
    const std::vector<double> values = guess(problem, which / damping_guesses, which % damping_guesses);
    const Prediction prediction =
        predict(cable_scene(problem.settings, values), markers_of(problem.settings, values), problem.inputs[recording].recording);
    errors[i] = prediction_error(prediction, problem.recordings[recording]).mean;
    const std::lock_guard<std::mutex> lock(mutex);
    problem.simulated();
  });
  GuessErrors sums{};
  for (std::size_t i = 0; i < errors.size(); ++i) sums[i % guesses / damping_guesses][i % damping_guesses] += errors[i];
  return sums;
}

/// No guess beside it has a smaller error.
bool is_lowest(const GuessErrors& errors, int bending, int damping) {
  for (int i = std::max(bending - 1, 0); i <= std::min(bending + 1, bending_guesses - 1); ++i)
    for (int k = std::max(damping - 1, 0); k <= std::min(damping + 1, damping_guesses - 1); ++k)
      if (errors[i][k] < errors[bending][damping]) return false;
  return true;
}

}  // namespace

int most_simulations(const Problem& problem, int recordings, const Ending& ending) {
  const int of_a_round = static_cast<int>(problem.parameters.size() + 1 + most_steps);
  return recordings * (bending_guesses * damping_guesses +
                       (most_valleys * for_valleys.rounds + ending.rounds + ending.refinements) * of_a_round);
}

std::vector<double> coarse_search(const Problem& problem, const std::vector<int>& training) {
  const Problem coarse = with_segments(problem, coarse_segments);
  const GuessErrors errors = guess_errors(coarse, training);
  Minimum lowest{{}, std::numeric_limits<double>::infinity()};
  for (int bending = 0; bending < bending_guesses; ++bending)
    for (int damping = 0; damping < damping_guesses; ++damping) {
      if (!is_lowest(errors, bending, damping)) continue;
      Minimum minimum = minimize(coarse, training, guess(coarse, bending, damping), for_valleys.rounds, for_valleys.tolerance);
      if (lowest.values.empty() || minimum.cost < lowest.cost) lowest = std::move(minimum);
    }
  return lowest.values;
}

std::vector<double> fit(const Problem& problem, const std::vector<int>& training, std::vector<double> values,
                        const Ending& ending) {
  if (problem.settings.segments > few_segments) {
    values = minimize(with_segments(problem, few_segments), training, std::move(values), ending.rounds,
                      std::max(ending.tolerance, tolerance_with_few))
                 .values;
    return minimize(problem, training, std::move(values), ending.refinements, ending.tolerance).values;
  }
  return minimize(problem, training, std::move(values), ending.rounds, ending.tolerance).values;
}

}  // namespace verlet_cable::cable_fit
