#include "depth_sensor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "random.h"

namespace verlet_cable::view {
namespace {

constexpr float no_return = std::numeric_limits<float>::quiet_NaN();
constexpr unsigned for_noise = 0, for_edges = 1;  // uses of random numbers

/// Whether a neighbour of a pixel is deeper by more than `step`, or shows nothing.
bool is_beside_edge(const CameraModel& model, const float* depth, int column, int row, double step) {
  const auto is_deep = [&](int other_column, int other_row) {
    if (other_column < 0 || other_column >= model.width || other_row < 0 || other_row >= model.height) return false;
    const float* pixel = depth + static_cast<std::size_t>(row) * model.width + column;
    const float other = depth[static_cast<std::size_t>(other_row) * model.width + other_column];
    return !(other - *pixel <= step);
  };
  return is_deep(column - 1, row) || is_deep(column + 1, row) || is_deep(column, row - 1) || is_deep(column, row + 1);
}

}  // namespace

bool is_perfect(const SensorModel& sensor) {
  const bool is_quiet = sensor.axial[0] == 0 && sensor.axial[1] == 0 && sensor.axial[2] == 0;
  return is_quiet && sensor.dropout_angle >= 90 && sensor.baseline == 0 && sensor.disparity_step == 0 && sensor.edge_dropout == 0;
}

void measure_row(const CameraModel& model, const SensorModel& sensor, const NoiseSeed& noise, const TrueDepth& truth, int row,
                 float* measured) {
  const CountedRandom random(noise.seed, noise.image);
  const double least_cosine = std::cos(sensor.dropout_angle * M_PI / 180);
  const double disparity_at_1 = std::abs(model.fx * sensor.baseline);
  const auto [a, b, c] = sensor.axial;
  for (int column = 0; column < model.width; ++column) {
    const std::size_t pixel = static_cast<std::size_t>(row) * model.width + column;
    measured[column] = no_return;
    const double depth = truth.depth[pixel], cosine = truth.cosine[pixel];
    if (!(depth >= model.near) || cosine < 0 || (sensor.dropout_angle < 90 && cosine < least_cosine)) continue;
    if (sensor.edge_dropout > 0 && is_beside_edge(model, truth.depth, column, row, sensor.edge_step) &&
        random.uniform(pixel, for_edges) < sensor.edge_dropout)
      continue;
    const double deviation = a + depth * (b + depth * c);
    double seen = depth;
    if (deviation > 0) seen += deviation * normal_quantile(random.uniform(pixel, for_noise));
    if (sensor.disparity_step > 0) {
      const double disparity = sensor.disparity_step * std::round(disparity_at_1 / seen / sensor.disparity_step);
      if (!(disparity > 0)) continue;
      seen = disparity_at_1 / disparity;
    }
    if (seen >= model.near && seen <= model.far) measured[column] = static_cast<float>(seen);
  }
}

}  // namespace verlet_cable::view
