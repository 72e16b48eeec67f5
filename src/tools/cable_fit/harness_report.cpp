#include "harness_report.h"

#include <cstdio>

#include "common/json.h"
#include "parameter_report.h"
#include "scene_yaml.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_fit {
namespace {

using tools::Json;

constexpr const char* frames_text =
    "# Frames: origins in the markers that are held, x along the cable, from start to end. The first branch leaves in the plane "
    "of\n"
    "# x and y of the first frame, carried along the cable. `rest_curvature` of branches is about the axes that they have "
    "without\n"
    "# `initial`: those of the cable that they leave, turned by `rotation`.\n";

std::string number(const char* format, double value) {
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string place_text(const PlaceDesc& place) {
  return place.at == PlaceDesc::At::start ? "start" : place.at == PlaceDesc::At::end ? "end" : number_text(place.arc_length);
}

std::string junction_yaml(const JunctionDesc& junction) {
  std::string yaml = "  - {name: " + junction.name + ", cable: " + junction.cable + ", at: " + place_text(junction.place) +
                     ", type: rigid,\n     branches: [";
  for (std::size_t i = 0; i < junction.branches.size(); ++i)
    yaml += (i > 0 ? ", " : "") + ("{cable: " + junction.branches[i].cable) +
            ", end: start, rotation: " + vector_text(junction.branches[i].rotation) + "}";
  return yaml + "]}\n";
}

Json error_json(const HarnessError& error) {
  return {{"mean", error.mean}, {"root_mean_square", error.root_mean_square}, {"largest", error.largest}};
}

}  // namespace

std::string harness_yaml(const HarnessFit& fit, std::size_t recordings) {
  const HarnessSettings& settings = fit.fitted.settings;
  SceneDesc scene = harness_scene(settings, settings.segments, fit.fitted.values);
  add_clamps(settings, scene);
  std::string yaml = "# Fitted by cable_fit to " + std::to_string(recordings) +
                     (recordings == 1 ? " recording.\n" : " recordings.\n") + frames_text +
                     "time_step: " + number_text(scene.time_step) + "\n" + materials_yaml(scene) + "cables:\n";
  for (const CableDesc& cable : scene.cables) {
    yaml += cable_yaml(cable);
    if (!cable.attachments.empty()) yaml += "    attachments:\n";
    for (const AttachmentDesc& clamp : cable.attachments)
      yaml +=
          "      - {name: " + clamp.name + ", at: " + place_text(clamp.place) + ", frame: " + clamp.frame + ", type: clamp}\n";
  }
  if (!scene.junctions.empty()) yaml += "junctions:\n";
  for (const JunctionDesc& junction : scene.junctions) yaml += junction_yaml(junction);
  return yaml;
}

std::string harness_json(const HarnessProblem& problem, const HarnessFit& fit) {
  const HarnessSettings& settings = fit.fitted.settings;
  Json json{{"segments", settings.segments}, {"root_mean_square_error", root_mean_square(fit.errors)}};
  if (!fit.left_out_errors.empty()) json["cross_validated_root_mean_square_error"] = root_mean_square(fit.left_out_errors);
  json["parameters"] = Json::array();
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    json["parameters"].push_back(parameter_json(fit.parameters[i], fit.fitted.values[i], fit.confidence[i]));
  json["cables"] = Json::array();
  for (std::size_t i = 0; i < settings.cables.size(); ++i)
    json["cables"].push_back({{"name", settings.harness.cables[i].name},
                              {"measured_length", settings.cables[i].length},
                              {"marker_places", settings.cables[i].places}});
  json["recordings"] = Json::array();
  for (std::size_t i = 0; i < problem.recordings.size(); ++i) {
    Json recording{
        {"path", problem.recordings[i].path}, {"noise", problem.inputs[i].noise}, {"fitted", error_json(fit.errors[i])}};
    if (!fit.left_out_errors.empty()) recording["left_out"] = error_json(fit.left_out_errors[i]);
    json["recordings"].push_back(std::move(recording));
  }
  return tools::file_text(json);
}

std::string harness_text(const HarnessProblem& problem, const HarnessFit& fit) {
  std::string text;
  int curvatures = 0, told = 0;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
    const Parameter& parameter = fit.parameters[i];
    if (parameter.key.find("].rest_curvature[") != std::string::npos) {
      ++curvatures;
      told += fit.confidence[i].told ? 1 : 0;
      continue;
    }
    text += parameter_line(parameter, fit.fitted.values[i], fit.confidence[i]);
  }
  text += "rest_curvature: of " + std::to_string(curvatures) + " numbers along the cables " + std::to_string(told) +
          " are determined by these recordings; --report FILE lists them\n";
  double noise = 0;
  for (const Smoothed& input : problem.inputs) noise = std::max(noise, input.noise);
  text += "noise of a coordinate of held markers: at most " + number("%.2f", 1000 * noise) + " mm\n";
  const auto add = [&](const char* which, const std::vector<HarnessError>& errors) {
    text += std::string("root mean square error of a coordinate of free markers in recordings ") + which + ": " +
            number("%.3f", 100 * root_mean_square(errors)) + " cm\n";
  };
  add("that were fitted", fit.errors);
  if (!fit.left_out_errors.empty()) add("left out of the fit", fit.left_out_errors);
  return text;
}

}  // namespace verlet_cable::cable_fit
