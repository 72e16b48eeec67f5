#include "cross_validation.h"

#include <algorithm>

#include "least_squares.h"
#include "parallel.h"

namespace verlet_cable::cable_fit {
namespace {

/// From so many recordings on, two are left out at once.
constexpr int fewest_for_pairs = 6;

}  // namespace

std::vector<PredictionError> prediction_errors(const CableSettings& settings, const std::vector<Recording>& recordings,
                                               const std::vector<std::vector<double>>& values) {
  std::vector<PredictionError> errors(recordings.size());
  for_each_index(static_cast<int>(errors.size()), [&](int i) {
    errors[i] = prediction_error(predict(cable_scene(settings, values[i]), recordings[i]), recordings[i]);
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

std::vector<std::vector<double>> left_out_fits(const Problem& problem) {
  const int recordings = static_cast<int>(problem.recordings.size());
  std::vector<std::vector<double>> fits(recordings);
  for (const std::vector<int>& left_out : left_out_together(recordings)) {
    std::vector<int> training;
    for (int i = 0; i < recordings; ++i)
      if (std::find(left_out.begin(), left_out.end(), i) == left_out.end()) training.push_back(i);
    const std::vector<double> of_training = fit(problem, training, coarse_search(problem, training));
    for (const int i : left_out) fits[i] = of_training;
  }
  return fits;
}

}  // namespace verlet_cable::cable_fit
