#include "errors_in_variables.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <random>

#include "core/world/parallel_for.h"
#include "input_errors.h"
#include "prediction.h"
#include "prediction_error.h"

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
constexpr double singular = 1e-12;  ///< part of the largest eigenvalue of scaled normal equations
/// [decades / rad] What noise in a hand's direction leaves in logarithmic parameters beyond all that is corrected, as measured
/// with recordings of a known rod (fit_coverage).
constexpr double of_direction = 0.15;
constexpr int roll_pairs = 2, pairs = 12;  ///< of samples: of the hands' roll, of all else
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

/// The markers' places with which a prediction's distances between neighbouring ones are as measured: those along the chords cut
/// the bends. `places`: by the measured distances; `predicted_places`: where predictions have them.
std::vector<double> places_along(const std::vector<double>& places, const std::vector<double>& predicted_places,
                                 const std::vector<Prediction>& predictions) {
  std::vector<double> along{0};
  for (std::size_t marker = 1; marker < places.size(); ++marker) {
    std::vector<double> chords;
    for (const Prediction& prediction : predictions)
      for (const std::vector<Vector3>& row : prediction.positions) chords.push_back((row[marker] - row[marker - 1]).norm());
    const double arc = predicted_places[marker] - predicted_places[marker - 1], chord = median(std::move(chords));
    along.push_back(along.back() + (places[marker] - places[marker - 1]) * (chord > 0 ? arc / chord : 1));
  }
  for (double& place : along) place /= along.back();
  return along;
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
    pull_ = Eigen::VectorXd::Zero(parameters());
    correction_ = Eigen::VectorXd::Zero(parameters());
    place_markers();
  }

  Estimate run(int most_steps) {
    for (int step = 0; step < most_steps; ++step) {
      if (step == 0 || went_far()) find_input_slopes();
      find_differences();
      find_slopes();
      if (improve()) break;
    }
    correct_for_curvature();
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

  /// Those of each recording by a column of changes, which `change` makes of the values and the input's errors.
  template <class Change>
  Slopes slopes(const Problem& problem, const Vectors& at, const std::vector<Eigen::Index>& counts, const Change& change) const {
    std::vector<std::pair<std::size_t, Eigen::Index>> all;
    for (std::size_t i = 0; i < recordings(); ++i)
      for (Eigen::Index k = -1; k < counts[i]; ++k) all.emplace_back(i, k);
    Vectors columns(all.size());
    std::vector<double> steps(all.size(), 1.0);
    std::mutex mutex;
    parallel_for(all.size(), [&](std::size_t n) {
      const auto [recording, k] = all[n];
      std::vector<double> values = values_;
      Eigen::VectorXd errors = at[recording];
      if (k >= 0) steps[n] = change(k, values, errors);
      columns[n] = compared(predicted(problem, 1, recording, values, errors), problem.recordings[which_[recording]]);
      const std::lock_guard<std::mutex> lock(mutex);
      problem.simulated();
    });
    Slopes result;
    std::size_t n = 0;
    for (std::size_t i = 0; i < recordings(); ++i) {
      const Eigen::VectorXd& base = result.differences.emplace_back(columns[n++]);
      Eigen::MatrixXd& matrix = result.matrices.emplace_back(base.size(), counts[i]);
      for (Eigen::Index k = 0; k < counts[i]; ++k, ++n) matrix.col(k) = (columns[n] - base) / steps[n];
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
    std::vector<Eigen::Index> counts;
    for (const InputErrors& input : inputs_) counts.push_back(input.count());
    input_slopes_ = slopes(coarse_, errors_, counts, [](Eigen::Index k, std::vector<double>&, Eigen::VectorXd& errors) {
                      errors[k] += 1;
                      return 1.0;
                    }).matrices;
    for (const Eigen::MatrixXd& matrix : input_slopes_) input_squares_.emplace_back(matrix.transpose() * matrix);
  }

  /// By the parameters, with inputs of such errors.
  Slopes slopes_at(const Vectors& errors) const {
    return slopes(coarse_, errors, std::vector<Eigen::Index>(recordings(), parameters()),
                  [&](Eigen::Index k, std::vector<double>& values, Eigen::VectorXd&) {
                    const Parameter& parameter = coarse_.parameters[k];
                    const double step = values[k] + parameter.step <= parameter.highest ? parameter.step : -parameter.step;
                    values[k] += step;
                    return step;
                  });
  }

  void find_slopes() { slopes_ = slopes_at(errors_).matrices; }

  /// A step of the search goes by tangents, and noise as large as this is felt beyond them. What is measured scatters about the
  /// truth: where predictions bend away from their tangents, the estimate is off by as much on the average, the other way (Box
  /// 1971). What is only supposed, the roll of the hands, is itself what scatters: of it, the cost counts as a mean over what is
  /// possible still. Both by pairs of samples that are opposite, from the normal distribution of the estimate.
  void correct_for_curvature() {
    std::mt19937_64 random(1);
    std::normal_distribution<double> normal(0, 1);
    const auto drawn = [&](Eigen::Index count) {
      Eigen::VectorXd numbers(count);
      for (double& number : numbers) number = normal(random);
      return numbers;
    };
    std::vector<Eigen::LLT<Eigen::MatrixXd>> solvers;
    for (std::size_t i = 0; i < recordings(); ++i) solvers.emplace_back(input_squares_[i] / variance_ + inputs_[i].precision());
    const auto sampled = [&](std::size_t i) -> Eigen::VectorXd { return solvers[i].matrixU().solve(drawn(inputs_[i].count())); };
    const Vectors most_likely = compared_at({values_}, {errors_}).front();
    const Vectors bent = bend_of_measured(drawn, sampled, most_likely);
    find_pull_of_roll(sampled, most_likely);
    for (std::size_t i = 0; i < recordings(); ++i) differences_[i] -= bent[i];
    const std::vector<double> before = values_;
    improve();
    for (Eigen::Index k = 0; k < parameters(); ++k) correction_[k] = values_[k] - before[k];
  }

  /// By how much predictions are off on the average as parameters and what is measured of the input are.
  template <class Drawn, class Sampled>
  Vectors bend_of_measured(const Drawn& drawn, const Sampled& sampled, const Vectors& most_likely) const {
    const Step here = step(variance_);
    const Eigen::VectorXd scale = scale_of(here.information);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> parts(scale.asDiagonal() * here.information * scale.asDiagonal());
    const Eigen::VectorXd deviations =
        parts.eigenvalues().cwiseMax(singular * parts.eigenvalues().maxCoeff()).cwiseSqrt().cwiseInverse();
    std::vector<std::vector<double>> values;
    std::vector<Vectors> errors;
    for (int pair = 0; pair < pairs; ++pair) {
      Eigen::VectorXd change = scale.asDiagonal() * (parts.eigenvectors() * (deviations.asDiagonal() * drawn(parameters())));
      for (Eigen::Index k = 0; k < parameters(); ++k) {
        const Parameter& parameter = coarse_.parameters[k];
        const double room = std::max(0.0, std::min(values_[k] - parameter.lowest, parameter.highest - values_[k]));
        const double most = parameter.logarithmic ? std::min(room, longest_step) : room;
        change[k] = std::clamp(change[k], -most, most);
      }
      Vectors samples;
      for (std::size_t i = 0; i < recordings(); ++i) {
        samples.emplace_back(sampled(i) - here.by_parameters[i] * change);
        samples.back().tail(inputs_[i].roll_count()).setZero();
      }
      for (const double sign : {1.0, -1.0}) {
        values.push_back(values_);
        errors.push_back(errors_);
        for (Eigen::Index k = 0; k < parameters(); ++k) values.back()[k] += sign * change[k];
        for (std::size_t i = 0; i < recordings(); ++i) errors.back()[i] += sign * samples[i];
      }
    }
    Vectors mean;
    for (const Eigen::VectorXd& of_recording : most_likely) mean.emplace_back(-of_recording);
    for (const Vectors& sample : compared_at(values, errors))
      for (std::size_t i = 0; i < recordings(); ++i) mean[i] += sample[i] / (2 * pairs);
    return mean;
  }

  /// The difference of the cost's gradient, and of the predictions.
  template <class Sampled>
  void find_pull_of_roll(const Sampled& sampled, const Vectors& most_likely) {
    pull_ = Eigen::VectorXd::Zero(parameters());
    for (int pair = 0; pair < roll_pairs; ++pair) {
      Vectors one, other, change;
      for (std::size_t i = 0; i < recordings(); ++i) {
        Eigen::VectorXd sample = sampled(i);
        change.emplace_back(input_slopes_[i] * sample);
        sample.head(sample.size() - inputs_[i].roll_count()).setZero();
        one.emplace_back(errors_[i] + sample);
        other.emplace_back(errors_[i] - sample);
      }
      const Slopes by_one = slopes_at(one), by_other = slopes_at(other);
      for (std::size_t i = 0; i < recordings(); ++i) {
        pull_ += (by_one.matrices[i] - by_other.matrices[i]).transpose() * change[i] / (2 * roll_pairs * variance_);
        differences_[i] += (0.5 * (by_one.differences[i] + by_other.differences[i]) - most_likely[i]) / roll_pairs;
      }
    }
  }

  /// Differences of each recording, for each of some values and errors of the inputs.
  std::vector<Vectors> compared_at(const std::vector<std::vector<double>>& values, const std::vector<Vectors>& errors) const {
    std::vector<Vectors> result(values.size(), Vectors(recordings()));
    std::mutex mutex;
    parallel_for(values.size() * recordings(), [&](std::size_t n) {
      const std::size_t which = n / recordings(), i = n % recordings();
      result[which][i] = compared(predicted(coarse_, 1, i, values[which], errors[which][i]), coarse_.recordings[which_[i]]);
      const std::lock_guard<std::mutex> lock(mutex);
      coarse_.simulated();
    });
    return result;
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

  /// Normal equations of parameters, with the inputs' errors eliminated, and what a step leaves of the differences.
  struct Step {
    Eigen::MatrixXd information;
    Eigen::VectorXd parameters;
    Vectors errors;
    Matrices by_parameters;  ///< of each recording, minus what the errors change with the parameters
    double left = 0;         ///< [m^2] mean square of the differences after it
  };

  /// `variance` [m^2]: of the means that are compared.
  Step step(double variance) const {
    const Prior prior(coarse_.parameters, values_);
    Step result{prior.slopes.transpose() * prior.slopes, {}, {}, {}, 0};
    Eigen::VectorXd gradient = prior.slopes.transpose() * prior.values + pull_;
    Matrices& by_parameters = result.by_parameters;
    Vectors alone;
    for (std::size_t i = 0; i < recordings(); ++i) {
      const Eigen::MatrixXd &by_input = input_slopes_[i], &slopes = slopes_[i];
      const Eigen::MatrixXd known = inputs_[i].precision();
      const Eigen::LLT<Eigen::MatrixXd> solver(input_squares_[i] / variance + known);
      const Eigen::VectorXd pull = by_input.transpose() * differences_[i] / variance + known * errors_[i];
      const Eigen::MatrixXd coupling = by_input.transpose() * slopes / variance;
      by_parameters.emplace_back(solver.solve(coupling));
      alone.emplace_back(solver.solve(pull));
      result.information += slopes.transpose() * slopes / variance - coupling.transpose() * by_parameters.back();
      gradient += slopes.transpose() * differences_[i] / variance - coupling.transpose() * alone.back();
    }
    const Eigen::VectorXd scale = scale_of(result.information);
    result.parameters = -(scale.asDiagonal() * (inverse_scaled(result.information, scale) * (scale.asDiagonal() * gradient)));
    for (Eigen::Index k = 0; k < parameters(); ++k) {
      const Parameter& parameter = coarse_.parameters[k];
      const double longest = parameter.logarithmic ? longest_step : parameter.likely > 0 ? parameter.likely : infinity;
      result.parameters[k] = std::clamp(result.parameters[k], -longest, longest);
      result.parameters[k] = std::clamp(values_[k] + result.parameters[k], parameter.lowest, parameter.highest) - values_[k];
    }
    double sum = 0;
    Eigen::Index count = 0;
    for (std::size_t i = 0; i < recordings(); ++i) {
      result.errors.emplace_back(-alone[i] - by_parameters[i] * result.parameters);
      sum += (differences_[i] + slopes_[i] * result.parameters + input_slopes_[i] * result.errors[i]).squaredNorm();
      count += differences_[i].size();
    }
    result.left = sum / static_cast<double>(count);
    return result;
  }

  /// One step. What noise does not explain is an error of the model: alike of so many neighbours, it counts the more.
  bool improve() {
    variance_ = mean_variance_;
    Step best = step(variance_);
    for (int i = 0; i < 10; ++i) {
      const double wanted = mean_variance_ + alike_ * std::max(0.0, best.left - due_to_noise * mean_variance_);
      if (wanted < 1.05 * variance_) break;
      variance_ = wanted;
      best = step(variance_);
    }
    const Eigen::VectorXd scale = scale_of(best.information);
    const Eigen::MatrixXd inverse = inverse_scaled(best.information, scale);
    bool is_short = true;
    for (Eigen::Index k = 0; k < parameters(); ++k) {
      is_short = is_short && std::abs(best.parameters[k]) <= short_step * scale[k] * std::sqrt(std::max(inverse(k, k), 0.0));
      values_[k] += best.parameters[k];
    }
    for (std::size_t i = 0; i < recordings(); ++i) {
      // What is left is as the linear model says: if the search ends here, nothing is simulated any more.
      differences_[i] += slopes_[i] * best.parameters + input_slopes_[i] * best.errors[i];
      errors_[i] += best.errors[i];
    }
    return is_short;
  }

  std::vector<Confidence> confidence() const {
    const Prior prior(coarse_.parameters, values_);
    Eigen::MatrixXd information = prior.slopes.transpose() * prior.slopes;
    // The prior is one more thing known, as uncertain as it says.
    Eigen::MatrixXd scatter = information;
    const int count = static_cast<int>(recordings());
    for (std::size_t i = 0; i < recordings(); ++i) {
      const Eigen::MatrixXd& slopes = slopes_[i];
      const Eigen::MatrixXd known = inputs_[i].precision();
      const Eigen::MatrixXd coupling = input_slopes_[i].transpose() * slopes / variance_;
      const Eigen::LLT<Eigen::MatrixXd> solver(input_squares_[i] / variance_ + known);
      information += slopes.transpose() * slopes / variance_ - coupling.transpose() * solver.solve(coupling);
      add_scatter(slopes, differences_[i] / variance_, count, scatter);
    }
    const Eigen::VectorXd scale = scale_of(information);
    const Eigen::MatrixXd inverse = scale.asDiagonal() * inverse_scaled(information, scale) * scale.asDiagonal();
    return confidence_of(with_unresolved_noise(), values_, inverse, inverse * scatter * inverse, count);
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
  Eigen::VectorXd pull_;                            // of the roll, which is uncertain
  Eigen::VectorXd correction_;                      // of the parameters, beyond tangents
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
             2 * roll_pairs * static_cast<Eigen::Index>(problem.parameters.size() + 1) + 2 * pairs + 2;
  return static_cast<int>(count);
}

}  // namespace verlet_cable::cable_fit
