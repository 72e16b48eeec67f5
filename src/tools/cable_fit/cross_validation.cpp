#include "cross_validation.h"

#include <algorithm>

#include "core/world/parallel_for.h"
#include "errors_in_variables.h"
#include "least_squares.h"

namespace verlet_cable::cable_fit {
namespace {

/// From so many recordings on, two are left out at once.
constexpr int fewest_for_pairs = 6;

}  // namespace

std::vector<Prediction> predictions(const std::vector<FittedCable>& cables, const std::vector<Recording>& recordings) {
  std::vector<Prediction> predictions(recordings.size());
  parallel_for(predictions.size(), [&](std::size_t i) {
    const auto& [settings, values] = cables[i];
    predictions[i] = predict(cable_scene(settings, values), markers_of(settings, values), recordings[i]);
  });
  return predictions;
}

std::vector<PredictionError> prediction_errors(const std::vector<FittedCable>& cables, const std::vector<Recording>& recordings) {
  std::vector<PredictionError> errors;
  const std::vector<Prediction> predicted = predictions(cables, recordings);
  for (std::size_t i = 0; i < recordings.size(); ++i) errors.push_back(prediction_error(predicted[i], recordings[i]));
  return errors;
}

std::vector<std::vector<int>> left_out_together(int recordings) {
  const int size = recordings < fewest_for_pairs ? 1 : 2;
  std::vector<std::vector<int>> folds;
  for (int i = 0; i < recordings; ++i) {
    if (i % size == 0) folds.emplace_back();
    folds.back().push_back(i);
  }
  return folds;
}

std::vector<FittedCable> left_out_fits(const Problem& problem, const std::vector<FittedCable>& on_markers) {
  const int recordings = static_cast<int>(problem.recordings.size());
  std::vector<FittedCable> fits(recordings);
  for (const std::vector<int>& left_out : left_out_together(recordings)) {
    std::vector<int> training;
    for (int i = 0; i < recordings; ++i)
      if (std::find(left_out.begin(), left_out.end(), i) == left_out.end()) training.push_back(i);
    Problem of_training = problem;
    measure_cable(problem.recordings, problem.inputs, training, of_training.settings);
    of_training.parameters = cable_parameters(of_training.settings);
    const std::vector<double> start = on_markers.empty()
                                          ? coarse_search(of_training, training)
                                          : with_markers_on_line(of_training.settings, on_markers[left_out.front()].values);
    const Estimate estimate =
        with_input_errors(of_training, training, fit(of_training, training, start, for_predictions), for_predictions.corrections);
    of_training.settings.marker_places = estimate.marker_places;
    for (const int i : left_out) fits[i] = {of_training.settings, estimate.values};
  }
  return fits;
}

}  // namespace verlet_cable::cable_fit
