#include "errors_in_variables.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <mutex>
#include <random>
#include <set>

#include "bent_places.h"
#include "core/world/parallel_for.h"
#include "input_errors.h"
#include "prediction.h"
#include "prediction_error.h"
#include "supposed.h"

namespace verlet_cable::cable_fit {
namespace {

/// [s] Differences are compared as means over this time: cables hardly move otherwise meanwhile, and there are fewer.
constexpr double compared_over = 0.04;
constexpr double least_noise = 1e-5;  // [m]
/// Differences this much above the variance of noise are due to more than noise.
constexpr double due_to_noise = 1.2;
constexpr double longest_step = 0.3, far = 0.25;  // decades
/// Of a standard deviation: a step this short ends the search.
constexpr double short_step = 0.1;
/// [decades / rad] What noise in a hand's direction leaves in logarithmic parameters beyond all that is corrected, as measured
/// with recordings of a known rod (fit_coverage).
constexpr double of_direction = 0.15;
constexpr int pairs = 4;  ///< of samples
/// Of a parameter's information: where so much of it is noise of slopes, it is not determined. In recordings of a known rod it is
/// at most an eighth where hands swing, and a half of that on bending damping where they move slowly.
constexpr double most_noise = 0.3;
constexpr double most_taken = 0.95;
/// Slopes by the inputs are found anew at every so manieth step.
constexpr int steps_with_slopes = 2;
/// A width that many parameters have in common is this part of what is likely at least.
constexpr double least_width = 0.01;
constexpr int width_rounds = 100;
/// Derivatives are good enough with so many segments.
constexpr int segments_for_slopes = 24;

using Matrices = std::vector<Eigen::MatrixXd>;
using Vectors = std::vector<Eigen::VectorXd>;

Problem with_segments(Problem problem, int segments) {
  problem.settings.segments = segments;
  return problem;
}

/// [m^2] of a coordinate, the mean of the recordings.
double noise_variance(const Problem& problem, const std::vector<int>& recordings) {
  double sum = 0;
  for (const int i : recordings) sum += problem.inputs[i].noise * problem.inputs[i].noise;
  return std::max(sum / static_cast<double>(recordings.size()), least_noise * least_noise);
}

int rows_together(const Recording& recording) {
  const double interval = recording.times.back() / (recording.rows() - 1);
  return std::max(1, static_cast<int>(std::lround(compared_over / interval)));
}

/// Predicted minus measured coordinates [m] of the markers between the hands after the given rows, large ones tamed, as means.
Eigen::VectorXd compared(const Prediction& prediction, const Recording& recording) {
  const int together = rows_together(recording);
  const int columns = 3 * (recording.marker_count() - 4);
  const int means = (recording.rows() - given_rows + together - 1) / together;
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(columns, means);
  for (int row = given_rows; row < recording.rows(); ++row) {
    const int mean = (row - given_rows) / together;
    const int rows = std::min(together, recording.rows() - given_rows - mean * together);
    for (int i = 0; i < columns; ++i) {
      const int marker = 2 + i / 3, axis = i % 3;
      sums(i, mean) += robust(prediction.positions[row][marker][axis] - recording.markers[row][marker][axis]) / rows;
    }
  }
  return Eigen::Map<Eigen::VectorXd>(sums.data(), sums.size());
}

/// Of the standard normal distribution.
Eigen::VectorXd drawn(Eigen::Index count, std::mt19937_64& random) {
  std::normal_distribution<double> normal(0, 1);
  Eigen::VectorXd numbers(count);
  for (double& number : numbers) number = normal(random);
  return numbers;
}

/// Of information, less its noise: which is itself uncertain, and takes no direction more than `most_taken` of what it has, so
/// that intervals only become wider.
Eigen::MatrixXd inverse_without(const Eigen::MatrixXd& noise, const Eigen::MatrixXd& information) {
  const Eigen::VectorXd scale = scale_of(information);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> whole(scale.asDiagonal() * information * scale.asDiagonal());
  const Eigen::VectorXd& told = whole.eigenvalues();
  const double least = told.size() * std::numeric_limits<double>::epsilon() * told.maxCoeff();
  const auto size = [&](double value) { return value > least ? 1 / std::sqrt(value) : 0.0; };
  const Eigen::MatrixXd whitened = scale.asDiagonal() * whole.eigenvectors() * told.unaryExpr(size).asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> taken(whitened.transpose() * noise * whitened);
  const Eigen::VectorXd left = (1 - taken.eigenvalues().array()).max(1 - most_taken).min(1.0);
  const Eigen::MatrixXd directions = whitened * taken.eigenvectors();
  return directions * left.cwiseInverse().asDiagonal() * directions.transpose();
}

/// The estimate, as it is improved step by step.
class Search {
 public:
  Search(const Problem& problem, const std::vector<int>& recordings, std::vector<double> values)
      : coarse_(with_segments(problem, std::min(problem.settings.segments, segments_for_slopes))),
        usual_(problem),
        fine_(with_segments(problem, 2 * problem.settings.segments)),
        which_(recordings),
        values_(std::move(values)) {
    const double variance = noise_variance(problem, recordings);
    double rows = 0;
    for (const int i : recordings) {
      inputs_.emplace_back(problem.recordings[i], problem.inputs[i], variance);
      errors_.push_back(Eigen::VectorXd::Zero(inputs_.back().count()));
      rows += rows_together(problem.recordings[i]) / static_cast<double>(recordings.size());
    }
    noise_variance_ = variance;
    mean_variance_ = variance / rows;
    alike_ = alike / rows;
    for (Eigen::Index k = 0; k < parameters(); ++k) (problem.parameters[k].has_common_width ? common_ : single_).push_back(k);
    if (!common_.empty()) likely_width_ = problem.parameters[common_.front()].likely;
    pull_ = Eigen::VectorXd::Zero(parameters());
    correction_ = Eigen::VectorXd::Zero(parameters());
    place_markers();
  }

  Estimate run(int most_steps) {
    for (int step = 0; step < most_steps; ++step) {
      if (step % steps_with_slopes == 0 || went_far()) find_input_slopes();
      find_differences();
      find_slopes();
      if (improve()) break;
    }
    correct_for_what_is_supposed();
    find_noise_of_slopes();
    return {values_, confidence(), usual_.settings.marker_places};
  }

 private:
  std::size_t recordings() const { return inputs_.size(); }
  Eigen::Index parameters() const { return static_cast<Eigen::Index>(values_.size()); }

  Prediction predicted(const Problem& problem, double time_step_share, std::size_t recording, const std::vector<double>& values,
                       const Eigen::VectorXd& errors) const {
    const CableSettings& settings = problem.settings;
    SceneDesc scene = cable_scene(settings, values);
    scene.time_step *= time_step_share;
    return predict(scene, markers_of(settings, values), inputs_[recording].changed(errors));
  }

  void place_markers() {
    std::vector<Prediction> predictions(recordings());
    std::mutex mutex;
    parallel_for(recordings(), [&](std::size_t i) {
      predictions[i] = predicted(usual_, 1, i, values_, errors_[i]);
      const std::lock_guard<std::mutex> lock(mutex);
      usual_.simulated();
    });
    const std::vector<double> places =
        places_along(usual_.settings.marker_places, markers_of(usual_.settings, values_).places, predictions);
    for (Problem* problem : {&coarse_, &usual_, &fine_}) problem->settings.marker_places = places;
  }

  struct Slopes {
    Vectors differences;  // where they are found
    Matrices matrices;
  };

  /// Those of each recording by so many changes, which `change` makes of the values and of the recording's input.
  template <class Change>
  Slopes slopes(const std::vector<double>& at, const Vectors& at_errors, Eigen::Index count, const Change& change) const {
    const auto columns_each = static_cast<std::size_t>(count + 1);
    Vectors columns(recordings() * columns_each);
    std::vector<double> steps(columns.size(), 1.0);
    std::mutex mutex;
    parallel_for(columns.size(), [&](std::size_t n) {
      const std::size_t recording = n / columns_each, column = n % columns_each;
      std::vector<double> values = at;
      Eigen::VectorXd errors = at_errors[recording];
      if (column > 0) steps[n] = change(recording, static_cast<Eigen::Index>(column - 1), values, errors);
      columns[n] = compared(predicted(coarse_, 1, recording, values, errors), coarse_.recordings[which_[recording]]);
      const std::lock_guard<std::mutex> lock(mutex);
      coarse_.simulated();
    });
    Slopes result;
    for (std::size_t i = 0; i < recordings(); ++i) {
      const Eigen::VectorXd& base = result.differences.emplace_back(columns[i * columns_each]);
      Eigen::MatrixXd& matrix = result.matrices.emplace_back(base.size(), count);
      for (Eigen::Index k = 0; k < count; ++k) {
        const std::size_t n = i * columns_each + static_cast<std::size_t>(k) + 1;
        matrix.col(k) = (columns[n] - base) / steps[n];
      }
    }
    return result;
  }

  /// From the values at which slopes by the inputs' errors were found.
  bool went_far() const {
    for (std::size_t k = 0; k < values_.size(); ++k)
      if (coarse_.parameters[k].logarithmic && std::abs(values_[k] - input_slopes_at_[k]) > far) return true;
    return false;
  }

  void find_input_slopes() {
    input_slopes_at_ = values_;
    input_squares_.clear();
    input_slopes_.clear();
    for (std::size_t i = 0; i < recordings(); ++i) input_slopes_.push_back(input_slopes(i));
    for (const Eigen::MatrixXd& matrix : input_slopes_) input_squares_.emplace_back(matrix.transpose() * matrix);
  }

  /// Of one recording. A prediction goes on from where its input differs first.
  Eigen::MatrixXd input_slopes(std::size_t recording) const {
    const InputErrors& input = inputs_[recording];
    const SceneDesc scene = cable_scene(coarse_.settings, values_);
    const Markers markers = markers_of(coarse_.settings, values_);
    const auto differs_after = [&](Eigen::Index k) { return input.first_row(k) - rows_ahead; };
    std::set<int> rows;
    for (Eigen::Index k = 0; k < input.count(); ++k)
      if (differs_after(k) >= 0) rows.insert(differs_after(k));
    const Waypoints waypoints = predict_by({rows.begin(), rows.end()}, scene, markers, input.changed(errors_[recording]));
    const Recording& measured = coarse_.recordings[which_[recording]];
    const Eigen::VectorXd base = compared(waypoints.prediction, measured);
    coarse_.simulated();
    Eigen::MatrixXd result(base.size(), input.count());
    std::mutex mutex;
    parallel_for(static_cast<std::size_t>(input.count()), [&](std::size_t n) {
      const auto k = static_cast<Eigen::Index>(n);
      Eigen::VectorXd errors = errors_[recording];
      errors[k] += 1;
      const Input changed = input.changed(errors);
      const auto waypoint = static_cast<std::size_t>(std::distance(rows.begin(), rows.find(differs_after(k))));
      const Prediction prediction =
          differs_after(k) >= 0 ? predict_on(waypoints, waypoint, scene, markers, changed) : predict(scene, markers, changed);
      result.col(k) = compared(prediction, measured) - base;
      const std::lock_guard<std::mutex> lock(mutex);
      coarse_.simulated();
    });
    return result;
  }

  double step_of(Eigen::Index k) const {
    const Parameter& parameter = coarse_.parameters[k];
    return values_[k] + parameter.step <= parameter.highest ? parameter.step : -parameter.step;
  }

  void find_slopes() {
    slopes_ =
        slopes(values_, errors_, parameters(), [&](std::size_t, Eigen::Index k, std::vector<double>& values, Eigen::VectorXd&) {
          values[k] += step_of(k);
          return step_of(k);
        }).matrices;
  }

  /// The roll of hands and natural curvature are not measured, only supposed to be somewhere about zero: the more of the noise
  /// they can explain with some material, the likelier it seems. So the likelihood of parameters is what is left when they are
  /// integrated out (Laplace's approximation), or the cost counts as a mean over what is possible of them. Its gradient differs
  /// from that of the least cost: by pairs of samples that are opposite, from the normal distribution of what is supposed, while
  /// all else is as is likeliest with it.
  void correct_for_what_is_supposed() {
    std::mt19937_64 random(1);
    const Normal equations = normal_equations(variance_);
    const Prior prior(coarse_.parameters, values_);
    const Eigen::MatrixXd information = equations.information + prior.slopes.transpose() * prior.slopes;
    const auto commons = static_cast<Eigen::Index>(common_.size()), singles = static_cast<Eigen::Index>(single_.size());
    const Eigen::LLT<Eigen::MatrixXd> common_solver(information(common_, common_));
    // How parameters change along with each of the single ones.
    Eigen::MatrixXd along = Eigen::MatrixXd::Zero(parameters(), singles);
    along(single_, Eigen::all) = Eigen::MatrixXd::Identity(singles, singles);
    if (commons > 0) along(common_, Eigen::all) = -common_solver.solve(information(common_, single_));
    std::vector<Supposed> rolls;
    for (std::size_t i = 0; i < recordings(); ++i) rolls.emplace_back(input_information(i, variance_), inputs_[i].roll_count());

    Vectors bent;
    for (const Eigen::VectorXd& of_recording : differences_) bent.push_back(Eigen::VectorXd::Zero(of_recording.size()));
    const Slopes most_likely = slopes(values_, errors_, 0, [](auto&&...) { return 1.0; });
    for (int pair = 0; pair < pairs; ++pair) {
      Eigen::VectorXd change = Eigen::VectorXd::Zero(parameters());
      if (commons > 0) change(common_) = Eigen::VectorXd(common_solver.matrixU().solve(drawn(commons, random)));
      Vectors samples;
      for (std::size_t i = 0; i < recordings(); ++i)
        samples.emplace_back(rolls[i].likeliest_with(drawn(inputs_[i].roll_count(), random)) -
                             equations.by_parameters[i] * change);
      std::array<Slopes, 2> sides;
      for (const int side : {0, 1}) {
        const double sign = side == 0 ? 1 : -1;
        std::vector<double> values = values_;
        for (Eigen::Index k = 0; k < parameters(); ++k) values[k] += sign * change[k];
        Vectors errors;
        for (std::size_t i = 0; i < recordings(); ++i) errors.push_back(errors_[i] + sign * samples[i]);
        sides[side] = slopes(values, errors, singles,
                             [&](std::size_t recording, Eigen::Index k, std::vector<double>& changed, Eigen::VectorXd& input) {
                               const double step = step_of(single_[k]);
                               for (Eigen::Index j = 0; j < parameters(); ++j) changed[j] += step * along(j, k);
                               input -= step * (equations.by_parameters[recording] * along.col(k));
                               return step;
                             });
      }
      for (std::size_t i = 0; i < recordings(); ++i) {
        const Eigen::VectorXd tangent = input_slopes_[i] * samples[i] + slopes_[i] * change;
        pull_(single_) += pull_of(sides[0].matrices[i], sides[1].matrices[i], tangent, variance_) / pairs;
        bent[i] += (0.5 * (sides[0].differences[i] + sides[1].differences[i]) - most_likely.differences[i]) / pairs;
      }
    }
    for (std::size_t i = 0; i < recordings(); ++i) differences_[i] += bent[i];
    const std::vector<double> before = values_;
    go(step(normal_equations(variance_)));
    for (Eigen::Index k = 0; k < parameters(); ++k) correction_[k] = values_[k] - before[k];
  }

  /// Where the inputs' errors are not known, slopes are not, either: those at the likeliest errors have noise, which looks like
  /// information. A motion of which there is none in truth, but by the noise of a start, seems to tell how it is damped. So much
  /// more slopes tell in the mean over what is possible of the inputs, by pairs of samples that are opposite.
  void find_noise_of_slopes() {
    std::mt19937_64 random(2);
    noise_of_slopes_ = Eigen::MatrixXd::Zero(parameters(), parameters());
    std::vector<Eigen::LLT<Eigen::MatrixXd>> solvers;
    for (std::size_t i = 0; i < recordings(); ++i) solvers.emplace_back(input_information(i, variance_));
    for (int pair = 0; pair < pairs; ++pair) {
      Vectors samples;
      for (std::size_t i = 0; i < recordings(); ++i)
        samples.emplace_back(solvers[i].matrixU().solve(drawn(inputs_[i].count(), random)));
      std::array<Slopes, 2> sides;
      for (const int side : {0, 1}) {
        Vectors errors;
        for (std::size_t i = 0; i < recordings(); ++i) errors.push_back(errors_[i] + (side == 0 ? 1 : -1) * samples[i]);
        sides[side] = slopes(values_, errors, static_cast<Eigen::Index>(single_.size()),
                             [&](std::size_t, Eigen::Index k, std::vector<double>& changed, Eigen::VectorXd&) {
                               changed[single_[k]] += step_of(single_[k]);
                               return step_of(single_[k]);
                             });
      }
      for (std::size_t i = 0; i < recordings(); ++i) {
        const Eigen::MatrixXd noise = 0.5 * (sides[0].matrices[i] - sides[1].matrices[i]);
        const Eigen::MatrixXd coupling = input_slopes_[i].transpose() * noise / variance_;
        noise_of_slopes_(single_, single_) +=
            (noise.transpose() * noise / variance_ - coupling.transpose() * solvers[i].solve(coupling)) / pairs;
      }
    }
  }

  /// Errors of segments and of time steps go with the square of their lengths: they cancel from two simulations, one of which has
  /// them half as long (Richardson's extrapolation).
  void find_differences() {
    differences_.assign(recordings(), {});
    std::mutex mutex;
    parallel_for(recordings(), [&](std::size_t i) {
      Prediction fine = predicted(fine_, 0.5, i, values_, errors_[i]);
      const Prediction usual = predicted(usual_, 1, i, values_, errors_[i]);
      for (std::size_t row = 0; row < fine.positions.size(); ++row)
        for (std::size_t marker = 0; marker < fine.positions[row].size(); ++marker)
          fine.positions[row][marker] += (fine.positions[row][marker] - usual.positions[row][marker]) / 3;
      differences_[i] = compared(fine, fine_.recordings[which_[i]]);
      const std::lock_guard<std::mutex> lock(mutex);
      fine_.simulated();
      fine_.simulated();
    });
  }

  /// On a recording's input errors, by its rows and what is known of them without.
  Eigen::MatrixXd input_information(std::size_t recording, double variance) const {
    return input_squares_[recording] / variance + inputs_[recording].precision();
  }

  /// Of parameters, with the inputs' errors eliminated, without what is known before.
  struct Normal {
    Eigen::MatrixXd information;
    Eigen::VectorXd gradient;
    Matrices by_parameters;  ///< of each recording, minus what the errors change with the parameters
    Vectors alone;           ///< of each recording, minus what they change without
  };

  /// `variance` [m^2]: of the means that are compared.
  Normal normal_equations(double variance) const {
    Normal result{Eigen::MatrixXd::Zero(parameters(), parameters()), Eigen::VectorXd::Zero(parameters()), {}, {}};
    for (std::size_t i = 0; i < recordings(); ++i) {
      const Eigen::MatrixXd &by_input = input_slopes_[i], &slopes = slopes_[i];
      const Eigen::LLT<Eigen::MatrixXd> solver(input_information(i, variance));
      const Eigen::VectorXd pull = by_input.transpose() * differences_[i] / variance + inputs_[i].precision() * errors_[i];
      const Eigen::MatrixXd coupling = by_input.transpose() * slopes / variance;
      result.by_parameters.emplace_back(solver.solve(coupling));
      result.alone.emplace_back(solver.solve(pull));
      result.information += slopes.transpose() * slopes / variance - coupling.transpose() * result.by_parameters.back();
      result.gradient += slopes.transpose() * differences_[i] / variance - coupling.transpose() * result.alone.back();
    }
    return result;
  }

  struct Solution {
    Eigen::VectorXd change, scale;
    Eigen::MatrixXd inverse;  ///< scaled
  };

  Solution solution(const Normal& equations) const {
    const Prior prior(coarse_.parameters, values_);
    const Eigen::MatrixXd information = equations.information + prior.slopes.transpose() * prior.slopes;
    const Eigen::VectorXd gradient = equations.gradient + prior.slopes.transpose() * prior.values + pull_;
    Solution result{{}, scale_of(information), {}};
    result.inverse = inverse_scaled(information, result.scale);
    result.change = -(result.scale.asDiagonal() * (result.inverse * (result.scale.asDiagonal() * gradient)));
    return result;
  }

  /// How far parameters that have a width in common are from what is expected tells that width: that with which the recordings
  /// are likeliest (MacKay 1992), not more than what is likely at first.
  void learn_width(const Normal& equations) {
    if (common_.empty()) return;
    double width = likely_width_;
    for (int round = 0; round < width_rounds; ++round) {
      for (const Eigen::Index k : common_) coarse_.parameters[k].likely = width;
      const Solution now = solution(equations);
      double squares = 0, told = 0;  // sums, of how far they are and how much of that the recordings tell
      for (const Eigen::Index k : common_) {
        squares += std::pow(values_[k] + now.change[k] - coarse_.parameters[k].expected, 2);
        told += 1 - now.inverse(k, k) * now.scale[k] * now.scale[k] / (width * width);
      }
      const double next = std::clamp(told > 0 ? std::sqrt(squares / told) : 0, least_width * likely_width_, likely_width_);
      if (std::abs(next - width) < 1e-3 * width) break;
      width = next;
    }
  }

  struct Step {
    Eigen::VectorXd parameters;
    Vectors errors;
    double left = 0;       ///< [m^2] mean square of the differences after it
    bool is_short = true;  ///< against what the parameters are uncertain by
  };

  Step step(const Normal& equations) const {
    const Solution solved = solution(equations);
    Step result{solved.change, {}};
    for (Eigen::Index k = 0; k < parameters(); ++k) {
      const Parameter& parameter = coarse_.parameters[k];
      const double likely = parameter.has_common_width ? likely_width_ : parameter.likely;
      const double longest = parameter.logarithmic ? longest_step : likely > 0 ? likely : infinity;
      double& change = result.parameters[k];
      change = std::clamp(change, -longest, longest);
      change = std::clamp(values_[k] + change, parameter.lowest, parameter.highest) - values_[k];
      const double deviation = solved.scale[k] * std::sqrt(std::max(solved.inverse(k, k), 0.0));
      result.is_short = result.is_short && std::abs(change) <= short_step * deviation;
    }
    double sum = 0;
    Eigen::Index count = 0;
    for (std::size_t i = 0; i < recordings(); ++i) {
      result.errors.emplace_back(-equations.alone[i] - equations.by_parameters[i] * result.parameters);
      sum += (differences_[i] + slopes_[i] * result.parameters + input_slopes_[i] * result.errors[i]).squaredNorm();
      count += differences_[i].size();
    }
    result.left = sum / static_cast<double>(count);
    return result;
  }

  /// One step. What noise does not explain is an error of the model: alike of so many neighbours, it counts the more.
  bool improve() {
    Step best;
    double wanted = mean_variance_;
    for (int i = 0; i == 0 || (i < 10 && wanted >= 1.05 * variance_); ++i) {
      variance_ = wanted;
      const Normal equations = normal_equations(variance_);
      learn_width(equations);
      best = step(equations);
      wanted = mean_variance_ + alike_ * std::max(0.0, best.left - due_to_noise * mean_variance_);
    }
    go(best);
    return best.is_short;
  }

  void go(const Step& step) {
    for (Eigen::Index k = 0; k < parameters(); ++k) values_[k] += step.parameters[k];
    for (std::size_t i = 0; i < recordings(); ++i) {
      // What is left is as the linear model says: if the search ends here, nothing is simulated any more.
      differences_[i] += slopes_[i] * step.parameters + input_slopes_[i] * step.errors[i];
      errors_[i] += step.errors[i];
    }
  }

  std::vector<Confidence> confidence() const {
    const Prior prior(coarse_.parameters, values_);
    Eigen::MatrixXd information = prior.slopes.transpose() * prior.slopes;
    // The prior is one more thing known, as uncertain as it says.
    Eigen::MatrixXd scatter = information;
    information += normal_equations(variance_).information;
    const int count = static_cast<int>(recordings());
    for (std::size_t i = 0; i < recordings(); ++i) add_scatter(slopes_[i], differences_[i] / variance_, count, scatter);
    std::vector<Eigen::Index> noisy;
    for (Eigen::Index k = 0; k < parameters(); ++k)
      if (noise_of_slopes_(k, k) > most_noise * information(k, k)) noisy.push_back(k);
    const Eigen::MatrixXd inverse = inverse_without(noise_of_slopes_, information);
    std::vector<Confidence> result = confidence_of(with_unresolved_noise(), values_, inverse, inverse * scatter * inverse, count);
    for (const Eigen::Index k : noisy) result[k] = {infinity, false};
    return result;
  }

  /// The parameters, with what the noise of the hands' directions does to them beyond what is corrected, and with a correction as
  /// uncertain as it is large: it is the first term of a series.
  std::vector<Parameter> with_unresolved_noise() const {
    const std::array<double, 2>& held = coarse_.settings.held;
    const double direction = std::sqrt(noise_variance_) / std::min(held[0], held[1]);
    std::vector<Parameter> result = coarse_.parameters;
    for (std::size_t k = 0; k < result.size(); ++k) {
      const double of_noise = result[k].logarithmic ? of_direction * direction : 0;
      result[k].unresolved = std::hypot(result[k].unresolved, of_noise, correction_[static_cast<Eigen::Index>(k)]);
    }
    return result;
  }

  Problem coarse_, usual_, fine_;
  std::vector<int> which_;
  std::vector<double> values_, input_slopes_at_;
  std::vector<InputErrors> inputs_;
  std::vector<Eigen::Index> common_, single_;       // parameters that have a width in common, and others
  double likely_width_ = 0;                         // of the former, before they are looked at
  Eigen::VectorXd pull_;                            // of what is supposed, on the parameters
  Eigen::VectorXd correction_;                      // of the parameters, by it
  Eigen::MatrixXd noise_of_slopes_;                 // what they seem to tell of parameters by it
  Vectors errors_;                                  // a recording
  double noise_variance_ = 0;                       // [m^2] of a coordinate
  double mean_variance_ = 0, variance_ = 0;         // [m^2] of a mean that is compared: by noise, and as it counts
  double alike_ = 0;                                // of these, so many neighbours
  Matrices input_slopes_, input_squares_, slopes_;  // a recording
  Vectors differences_;                             // [m] a recording
};

}  // namespace

Estimate with_input_errors(const Problem& problem, const std::vector<int>& recordings, std::vector<double> values,
                           int most_steps) {
  return Search(problem, recordings, std::move(values)).run(most_steps);
}

int most_simulations_with_input_errors(const Problem& problem, const std::vector<int>& recordings, int most_steps) {
  const double variance = noise_variance(problem, recordings);
  Eigen::Index count = 0;
  for (const int i : recordings)
    count += most_steps * (InputErrors(problem.recordings[i], problem.inputs[i], variance).count() + 1 +
                           static_cast<Eigen::Index>(problem.parameters.size() + 3)) +
             4 * pairs * static_cast<Eigen::Index>(problem.parameters.size() + 1) + 2;
  return static_cast<int>(count);
}

}  // namespace verlet_cable::cable_fit
