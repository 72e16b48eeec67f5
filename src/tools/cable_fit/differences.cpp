#include "differences.h"

#include <cmath>
#include <mutex>

#include "core/world/parallel_for.h"
#include "prediction_error.h"

namespace verlet_cable::cable_fit {
namespace {

/// [m] differences above this count linearly.
constexpr double outlying = 0.01;
constexpr double scatter = 0.005;  // [m] of predictions

Prediction predicted(const Problem& problem, const std::vector<double>& values, int which) {
  if (problem.predict_harness) return problem.predict_harness(problem.settings.segments, values, which);
  return predict(cable_scene(problem.settings, values), markers_of(problem.settings, values), problem.inputs[which].recording);
}

Eigen::VectorXd scaled_differences(const Problem& problem, const std::vector<double>& values, int which) {
  const std::vector<double> errors = problem.missed_by
                                         ? problem.missed_by(problem.settings.segments, values, which)
                                         : coordinate_errors(predicted(problem, values, which), problem.recordings[which]);
  Eigen::VectorXd differences(static_cast<Eigen::Index>(errors.size()));
  const double unit = scatter * std::sqrt(alike);
  for (std::size_t i = 0; i < errors.size(); ++i) differences[static_cast<Eigen::Index>(i)] = robust(errors[i]) / unit;
  return differences;
}

}  // namespace

double robust(double difference) {
  const double ratio = difference / outlying;
  return difference * std::sqrt(2 / (1 + std::sqrt(1 + ratio * ratio)));
}

std::size_t difference_count(const Problem& problem, int recording) {
  if (problem.missed_by) return problem.missed_counts[recording];
  const Recording& markers = problem.recordings[recording];
  return static_cast<std::size_t>(markers.rows() - given_rows) * markers.marker_count() * 3;
}

Linearization linearize(const Problem& problem, const std::vector<int>& recordings, const std::vector<double>& values,
                        bool with_slopes) {
  const int count = static_cast<int>(recordings.size());
  const int changes = with_slopes ? static_cast<int>(problem.parameters.size()) : 0;
  // One column for the values as they are and one for each that is changed.
  std::vector<std::vector<Eigen::VectorXd>> columns(count, std::vector<Eigen::VectorXd>(changes + 1));
  std::vector<double> steps(changes);
  for (int k = 0; k < changes; ++k) {
    const Parameter& parameter = problem.parameters[k];
    steps[k] = values[k] + parameter.step <= parameter.highest ? parameter.step : -parameter.step;
  }
  std::mutex mutex;
  parallel_for(recordings.size() * (changes + 1), [&](std::size_t i) {
    const std::size_t change = i / recordings.size(), recording = i % recordings.size();
    const int which = recordings[recording];
    std::vector<double> changed = values;
    if (change > 0) changed[change - 1] += steps[change - 1];
    columns[recording][change] = scaled_differences(problem, changed, which);
    const std::lock_guard<std::mutex> lock(mutex);
    problem.simulated();
  });
  Linearization linearization(count);
  for (int recording = 0; recording < count; ++recording) {
    RecordingDifferences& of_recording = linearization[recording];
    of_recording.values = columns[recording][0];
    if (!with_slopes) continue;
    of_recording.slopes.resize(of_recording.values.size(), changes);
    for (int k = 0; k < changes; ++k) of_recording.slopes.col(k) = (columns[recording][k + 1] - of_recording.values) / steps[k];
  }
  return linearization;
}

Prior::Prior(const std::vector<Parameter>& parameters, const std::vector<double>& at) {
  const auto count = static_cast<Eigen::Index>(parameters.size());
  values = Eigen::VectorXd::Zero(count);
  slopes = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Parameter& parameter = parameters[i];
    if (parameter.likely == 0) continue;
    values[i] = (at[i] - parameter.expected) / parameter.likely;
    slopes(i, i) = 1 / parameter.likely;
    if (parameter.relative_to < 0) continue;
    values[i] -= at[parameter.relative_to] / parameter.likely;
    slopes(i, parameter.relative_to) = -1 / parameter.likely;
  }
}

}  // namespace verlet_cable::cable_fit
