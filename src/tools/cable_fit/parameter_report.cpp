#include "parameter_report.h"

#include <cstdio>

namespace verlet_cable::cable_fit {
namespace {

/// As values of the scene's key.
struct Interval {
  double low, high;
};

Interval interval(const Parameter& parameter, double value, const Confidence& confidence) {
  return {scene_value(parameter, value - confidence.half_width), scene_value(parameter, value + confidence.half_width)};
}

template <class... Values>
std::string formatted(const char* format, Values... values) {
  char buffer[400];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

}  // namespace

tools::Json parameter_json(const Parameter& parameter, double value, const Confidence& confidence) {
  const Interval range = interval(parameter, value, confidence);
  return {{"key", parameter.key}, {"unit", parameter.unit}, {"value", scene_value(parameter, value)},
          {"low", range.low},     {"high", range.high},     {"told_by_the_data", confidence.told ? "yes" : "no"}};
}

std::string parameter_line(const Parameter& parameter, double value, const Confidence& confidence) {
  const std::string text =
      formatted("%-44s %10.4g %-9s ", parameter.key.c_str(), scene_value(parameter, value), parameter.unit.c_str());
  // The interval of what is not told may be without end, and says no more.
  if (!confidence.told) return text + "not determined by these recordings\n";
  const Interval range = interval(parameter, value, confidence);
  return text + formatted("(%.3g to %.3g)\n", range.low, range.high);
}

}  // namespace verlet_cable::cable_fit
