#include "cloud_report.h"

#include <algorithm>

#include "parameter_report.h"
#include "scene_yaml.h"
#include "verlet_cable/core/number_text.h"

namespace verlet_cable::cable_fit {

std::string clouds_yaml(const CloudProblem& problem, const CloudFit& fit) {
  const CableDesc& cable = fit.scene.cables[problem.cable];
  SceneDesc scene;
  std::copy_if(fit.scene.materials.begin(), fit.scene.materials.end(), std::back_inserter(scene.materials),
               [&](const NamedMaterial& named) { return named.name == cable.material; });
  return "# Fitted by cable_fit to " + std::to_string(problem.clouds.times.size()) +
         " clouds. To be a scene, the cable needs `attachments`.\ntime_step: " + number_text(fit.scene.time_step) + "\n" +
         materials_yaml(scene) + "cables:\n" + plain_cable_yaml(cable);
}

std::string clouds_json(const CloudProblem& problem, const CloudFit& fit) {
  tools::Json json{{"name", problem.scene.cables[problem.cable].name},
                   {"segments", problem.scene.cables[problem.cable].segments},
                   {"clouds", problem.clouds.times.size()},
                   {"points", problem.clouds.point_count()},
                   {"mean_distance", fit.mean_distance}};
  json["parameters"] = tools::Json::array();
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    json["parameters"].push_back(parameter_json(fit.parameters[i], fit.values[i], fit.confidence[i]));
  json["mean_distances"] = tools::Json::array();
  for (std::size_t i = 0; i < problem.clouds.times.size(); ++i)
    json["mean_distances"].push_back({{"time", problem.clouds.times[i]}, {"distance", fit.mean_distances[i]}});
  return tools::file_text(json);
}

std::string clouds_text(const CloudProblem& problem, const CloudFit& fit) {
  std::string text;
  for (std::size_t i = 0; i < fit.parameters.size(); ++i)
    text += parameter_line(fit.parameters[i], fit.values[i], fit.confidence[i]);
  return text + "mean distance of " + std::to_string(problem.clouds.point_count()) +
         " points from the cable's surface: " + rounded_text(1000 * fit.mean_distance) + " mm\n";
}

}  // namespace verlet_cable::cable_fit
