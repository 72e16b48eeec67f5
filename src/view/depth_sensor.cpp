#include "depth_sensor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "packets/passes.h"
#include "random.h"

namespace verlet_cable::view {
namespace {

constexpr float no_return = std::numeric_limits<float>::quiet_NaN();

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
  static const PacketPasses& passes = packet_passes();
  const std::size_t first = static_cast<std::size_t>(row) * static_cast<std::size_t>(model.width);
  SensorNumbers numbers;
  std::copy(sensor.axial.begin(), sensor.axial.end(), numbers.axial);
  numbers.near = model.near;
  numbers.far = model.far;
  numbers.least_cosine = sensor.dropout_angle < 90 ? std::cos(sensor.dropout_angle * M_PI / 180) : 0;
  numbers.disparity_at_1 = std::abs(model.fx * sensor.baseline);
  numbers.disparity_step = sensor.disparity_step;
  numbers.key = random_key(noise.seed, noise.image);
  numbers.first_number = first;
  passes.measure(numbers, truth.depth + first, truth.cosine + first, model.width, measured);
  if (sensor.edge_dropout == 0) return;
  for (int column = 0; column < model.width; ++column) {
    const auto bits = static_cast<std::int64_t>(random_bits(numbers.key, first + static_cast<std::size_t>(column), for_edges));
    if (uniform_of_bits(bits) < sensor.edge_dropout && is_beside_edge(model, truth.depth, column, row, sensor.edge_step))
      measured[column] = no_return;
  }
}

}  // namespace verlet_cable::view
