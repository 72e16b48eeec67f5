#include "verlet_cable/view/sensor_model.h"

#include <algorithm>

#include "error_lines.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable::view {
namespace {

constexpr Range axial_range{-1e3, 1e3, "three finite numbers a, b, c of a + b z + c z^2 [m]"};
constexpr Range angle_range{0.1, 90, "any number above 0, at most 90"};
constexpr Range baseline_range{-10, 10, "any number from -10 to 10"};
constexpr Range step_range{0, 100, "0 or more"};
constexpr double rounding = 1e-12;  // [m] of a law that touches 0
constexpr Range edge_range{1e-6, 1e3, "any number above 0"};

/// [m] The least standard deviation from `near` to `far`.
double least_deviation(const std::array<double, 3>& axial, double near, double far) {
  const auto [a, b, c] = axial;
  const auto at = [a = a, b = b, c = c](double depth) { return a + depth * (b + depth * c); };
  const double ends = std::min(at(near), at(far));
  if (!(c > 0)) return ends;
  return std::min(ends, at(std::clamp(-0.5 * b / c, near, far)));
}

}  // namespace

std::vector<std::string> validate(const SensorModel& sensor, double near, double far) {
  ErrorLines errors;
  const bool is_sound = std::all_of(sensor.axial.begin(), sensor.axial.end(), [](double k) { return axial_range.contains(k); });
  errors.require(is_sound, "noise.axial", list_text(sensor.axial), axial_range.text());
  if (is_sound && near > 0 && near < far && far < infinity)
    errors.require(least_deviation(sensor.axial, near, far) >= -rounding, "noise.axial", list_text(sensor.axial),
                   "a, b, c with a + b z + c z^2 of 0 or more at all depths z from near, " + number_text(near) + ", to far, " +
                       number_text(far) + " [m]");
  const auto check = [&](const char* name, double value, const Range& range, const char* unit) {
    errors.require(range.contains(value), name, number_text(value), range.text(unit));
  };
  check("noise.dropout_angle", sensor.dropout_angle, angle_range, "degree");
  check("noise.baseline", sensor.baseline, baseline_range, "m");
  check("noise.disparity_step", sensor.disparity_step, step_range, "pixels");
  check("noise.edge_dropout", sensor.edge_dropout, unit_interval, "");
  check("noise.edge_step", sensor.edge_step, edge_range, "m");
  errors.require(!(sensor.disparity_step > 0 && sensor.baseline == 0), "noise.disparity_step", number_text(sensor.disparity_step),
                 "0 without a baseline");
  return errors.lines();
}

}  // namespace verlet_cable::view
