#include "report.h"

#include <algorithm>
#include <cstdarg>
#include <cstdio>

#include "common/json.h"
#include "parameter_report.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_fit {
namespace {

using tools::Json;

Json error_json(const PredictionError& error) {
  return {{"mean", error.mean}, {"largest", error.largest}, {"last", error.last}};
}

Json parameters_json(const Fit& fit) {
  const auto& [problem, result] = fit;
  Json json = Json::array();
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    Json& of_parameter = json.emplace_back(parameter_json(problem.parameters[i], result.values[i], result.confidence[i]));
    of_parameter["value_with_exact_inputs"] = scene_value(problem.parameters[i], result.with_exact_inputs[i]);
  }
  return json;
}

bool any_swapped(const std::vector<SwappedEnds>& swapped) {
  return std::any_of(swapped.begin(), swapped.end(), [](const SwappedEnds& ends) { return ends.any(); });
}

std::string line(const char* format, ...) __attribute__((format(printf, 1, 2)));
std::string line(const char* format, ...) {
  char buffer[400];
  va_list arguments;
  va_start(arguments, format);
  std::vsnprintf(buffer, sizeof buffer, format, arguments);
  va_end(arguments);
  return buffer;
}

Json recordings_json(const std::vector<SwappedEnds>& swapped, const Fit& fit) {
  const auto& [problem, result] = fit;
  Json json = Json::array();
  for (std::size_t i = 0; i < problem.recordings.size(); ++i) {
    Json recording{
        {"path", problem.recordings[i].path}, {"noise", problem.inputs[i].noise}, {"swapped_markers", swapped_text(swapped[i])}};
    const auto add_errors = [&](const std::string& key, const Errors& errors) {
      if (errors.as_numbered.empty()) return;
      recording[key] = error_json(errors.as_numbered[i]);
      if (swapped[i].any()) recording[key + "_in_order"] = error_json(errors.in_order[i]);
    };
    add_errors("fitted", result.fitted);
    add_errors("left_out", result.left_out);
    json.push_back(std::move(recording));
  }
  return json;
}

/// Adds what a fit found to an object.
void add_fit(const std::vector<SwappedEnds>& swapped, const Fit& fit, Json& json) {
  const auto& [problem, result] = fit;
  const bool cross_validated = !result.left_out.as_numbered.empty();
  json["mean_error"] = mean_error(result.fitted.as_numbered);
  if (cross_validated) json["cross_validated_error"] = mean_error(result.left_out.as_numbered);
  if (cross_validated && any_swapped(swapped)) json["cross_validated_error_in_order"] = mean_error(result.left_out.in_order);
  json["resegmented"] = Json::array();
  for (const Resegmented& other : result.resegmented)
    json["resegmented"].push_back({{"segments", other.segments}, {"mean_error", other.error}});
  json["parameters"] = parameters_json(fit);
  const Markers markers = markers_of(problem.settings, result.values);
  json["marker_places"] = markers.places;
  json["marker_offsets"] = markers.offsets;
  json["recordings"] = recordings_json(swapped, fit);
}

bool is_curvature(const Parameter& parameter) {
  return parameter.key.rfind("cables[0].rest_curvature[", 0) == 0;
}

/// Curvatures that the recordings do not tell are many, and one line.
std::string parameter_lines(const Fit& fit) {
  const auto& [problem, result] = fit;
  std::string text;
  int curvatures = 0, untold = 0;
  for (std::size_t i = 0; i < problem.parameters.size(); ++i) {
    const Parameter& parameter = problem.parameters[i];
    if (is_curvature(parameter)) {
      ++curvatures;
      if (!result.confidence[i].told) {
        ++untold;
        continue;
      }
    }
    text += parameter_line(parameter, result.values[i], result.confidence[i]);
  }
  if (untold > 0)
    text += line(
        "cables[0].rest_curvature: of %d numbers, two axes at %d places along the cable, %d are not determined by these\n"
        "  recordings: there the unloaded cable may as well be straight; --report FILE lists them\n",
        curvatures, curvatures / 2, untold);
  return text;
}

std::string error_lines(const std::vector<SwappedEnds>& swapped, const FitResult& result) {
  std::string text;
  const auto add_mean = [&](const char* what, const Errors& errors) {
    text += line("mean absolute error of recordings %s: %.3f cm\n", what, 100 * mean_error(errors.as_numbered));
    if (any_swapped(swapped))
      text += line("  with the swapped markers in their order: %.3f cm\n", 100 * mean_error(errors.in_order));
  };
  add_mean("that were fitted", result.fitted);
  if (!result.left_out.as_numbered.empty()) add_mean("left out of the fit", result.left_out);
  return text;
}

}  // namespace

double mean_error(const std::vector<PredictionError>& errors) {
  double sum = 0;
  for (const PredictionError& error : errors) sum += error.mean;
  return sum / static_cast<double>(errors.size());
}

std::string report_json(const std::vector<SwappedEnds>& swapped, const Fit& fit, const Fit* centre_line) {
  Json json{{"name", fit.problem.settings.name}, {"segments", fit.problem.settings.segments}};
  add_fit(swapped, fit, json);
  if (centre_line) add_fit(swapped, *centre_line, json["centre_line"]);
  return tools::file_text(json);
}

std::string summary_text(const std::vector<SwappedEnds>& swapped, const Fit& fit, const Fit* centre_line) {
  std::string text = parameter_lines(fit);
  double noise = 0;
  for (std::size_t i = 0; i < swapped.size(); ++i) {
    if (swapped[i].any())
      text += fit.problem.recordings[i].path + ": " + swapped_text(swapped[i]) + " markers are numbered in the wrong order\n";
    noise = std::max(noise, fit.problem.inputs[i].noise);
  }
  text += line("noise of a coordinate: at most %.2f mm\n", 1000 * noise) + error_lines(swapped, fit.result);
  if (centre_line)
    text += "\nthe centre line, with the markers beside it:\n" + parameter_lines(*centre_line) +
            error_lines(swapped, centre_line->result);
  return text;
}

std::string prediction_csv(const Recording& recording, const Prediction& prediction) {
  std::string text = "t";
  for (int i = 0; i < recording.marker_count(); ++i)
    for (const char* axis : {"x", "y", "z"}) text += std::string(",") + axis + std::to_string(i);
  text += "\n";
  for (int row = 0; row < recording.rows(); ++row) {
    text += number_text(recording.times[row]);
    for (const Vector3& marker : prediction.positions[row])
      for (int axis = 0; axis < 3; ++axis) text += "," + number_text(marker[axis]);
    text += "\n";
  }
  return text;
}

}  // namespace verlet_cable::cable_fit
