#include "prediction_error.h"

#include <algorithm>
#include <cmath>

namespace verlet_cable::cable_fit {

std::vector<double> coordinate_errors(const Prediction& prediction, const Recording& recording) {
  std::vector<double> result;
  result.reserve(static_cast<std::size_t>(recording.rows()) * recording.marker_count() * 3);
  for (int row = given_rows; row < recording.rows(); ++row) {
    for (int marker = 0; marker < recording.marker_count(); ++marker) {
      const Vector3 difference = prediction.positions[row][marker] - recording.markers[row][marker];
      result.insert(result.end(), difference.data(), difference.data() + 3);
    }
  }
  return result;
}

PredictionError prediction_error(const Prediction& prediction, const Recording& recording) {
  PredictionError error;
  const std::vector<double> all = coordinate_errors(prediction, recording);
  const std::size_t row = 3 * static_cast<std::size_t>(recording.marker_count());
  for (std::size_t i = 0; i < all.size(); ++i) {
    const double size = std::abs(all[i]);
    error.mean += size / static_cast<double>(all.size());
    error.largest = std::max(error.largest, size);
    if (i + row >= all.size()) error.last += size / static_cast<double>(row);
  }
  return error;
}

}  // namespace verlet_cable::cable_fit
