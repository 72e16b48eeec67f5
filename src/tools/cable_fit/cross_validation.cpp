#include "cross_validation.h"

#include <algorithm>

#include "least_squares.h"
#include "parallel.h"

namespace verlet_cable::cable_fit {
namespace {

/// From so many recordings on, two are left out at once.
constexpr int fewest_for_pairs = 6;

}  // namespace

std::vector<PredictionError> prediction_errors(const std::vector<FittedCable>& cables, const std::vector<Recording>& recordings) {
  std::vector<PredictionError> errors(recordings.size());
  for_each_index(static_cast<int>(errors.size()), [&](int i) {
    const auto& [settings, values] = cables[i];
    errors[i] = prediction_error(predict(cable_scene(settings, values), settings.marker_places, recordings[i]), recordings[i]);
  });
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

std::vector<FittedCable> left_out_fits(const Problem& problem) {
  const int recordings = static_cast<int>(problem.recordings.size());
  std::vector<FittedCable> fits(recordings);
  for (const std::vector<int>& left_out : left_out_together(recordings)) {
    std::vector<int> training;
    for (int i = 0; i < recordings; ++i)
      if (std::find(left_out.begin(), left_out.end(), i) == left_out.end()) training.push_back(i);
    Problem of_training = problem;
    of_training.settings.marker_places = marker_places(problem.inputs, training);
    const std::vector<double> values = fit(of_training, training, coarse_search(of_training, training), for_predictions);
    for (const int i : left_out) fits[i] = {of_training.settings, values};
  }
  return fits;
}

}  // namespace verlet_cable::cable_fit
