#include "requests/tuning.h"

#include <dynamic_reconfigure/ConfigDescription.h>

#include <utility>

#include "edit_requests/error_text.h"

namespace verlet_cable {
namespace {

using dynamic_reconfigure::Config;

void add_group_state(Config& config) {
  dynamic_reconfigure::GroupState group;
  group.name = "Default";
  group.state = true;
  config.groups.push_back(group);
}

/// One double for each number, by a rule.
template <class Rule>
Config make_config(const std::vector<TunableNumber>& numbers, const Rule& rule) {
  Config config;
  for (const TunableNumber& number : numbers) {
    dynamic_reconfigure::DoubleParameter parameter;
    parameter.name = number.name;
    parameter.value = rule(number);
    config.doubles.push_back(parameter);
  }
  add_group_state(config);
  return config;
}

/// The scene with the changes, or why it cannot be.
SceneDesc changed_scene(const SceneDesc& scene, const std::vector<TunableNumber>& numbers, const Config& config) {
  std::vector<NumberChange> changes;
  for (const auto& change : config.doubles) changes.push_back({change.name, change.value});
  std::vector<std::string> errors;
  if (!config.bools.empty() || !config.ints.empty() || !config.strs.empty())
    errors.push_back("tuning: a parameter that is not of type double; allowed: those of type double");
  return tuned_scene(scene, numbers, changes, std::move(errors));
}

}  // namespace

Tuning::Tuning(ros::NodeHandle& private_node, Simulation& simulation)
    : simulation_(simulation), scene_version_(simulation.scene_version()), numbers_(tunable_numbers(simulation.scene())) {
  ros::NodeHandle node(private_node, "tuning");
  descriptions_ = node.advertise<dynamic_reconfigure::ConfigDescription>("parameter_descriptions", 1, true);
  updates_ = node.advertise<Config>("parameter_updates", 1, true);
  publish_description();
  service_ = node.advertiseService<dynamic_reconfigure::Reconfigure::Request, dynamic_reconfigure::Reconfigure::Response>(
      "set_parameters",
      [this](dynamic_reconfigure::Reconfigure::Request& request, dynamic_reconfigure::Reconfigure::Response& response) {
        // Answered with what holds now: dynamic_reconfigure has no room for reasons.
        set(request.config);
        response.config = present();
        return true;
      });
}

bool Tuning::set(const Config& changes) {
  try {
    simulation_.tune(changed_scene(simulation_.scene(), numbers_, changes));
  } catch (const SceneError& error) {
    ROS_WARN_THROTTLE(1, "tuning refused: %s", join(error.errors()).c_str());
    return false;
  }
  scene_version_ = simulation_.scene_version();
  updates_.publish(present());
  return true;
}

void Tuning::follow_scene() {
  if (scene_version_ == simulation_.scene_version()) return;
  scene_version_ = simulation_.scene_version();
  numbers_ = tunable_numbers(simulation_.scene());
  publish_description();
}

Config Tuning::present() const {
  const SceneDesc& scene = simulation_.scene();
  return make_config(numbers_, [&](const TunableNumber& number) { return number.value(scene); });
}

void Tuning::publish_description() {
  dynamic_reconfigure::ConfigDescription description;
  dynamic_reconfigure::Group group;
  group.name = "Default";
  for (const TunableNumber& number : numbers_) {
    dynamic_reconfigure::ParamDescription parameter;
    parameter.name = number.name;
    parameter.type = "double";
    parameter.description = number.description + " " + number.range.words;
    group.parameters.push_back(parameter);
  }
  description.groups.push_back(group);
  description.min = make_config(numbers_, [](const TunableNumber& number) { return number.range.lowest; });
  description.max = make_config(numbers_, [](const TunableNumber& number) { return number.range.highest; });
  description.dflt = present();
  descriptions_.publish(description);
  updates_.publish(present());
}

}  // namespace verlet_cable
