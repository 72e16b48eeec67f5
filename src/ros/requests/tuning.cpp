#include "requests/tuning.h"

#include <dynamic_reconfigure/ConfigDescription.h>

#include <algorithm>

#include "edit_requests/error_text.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

using dynamic_reconfigure::Config;

/// Dampings, stiffnesses and friction: what does not change masses or shapes.
constexpr double MaterialDesc::*tunable_of_material[] = {&MaterialDesc::axial_stiffness,   &MaterialDesc::torsional_stiffness,
                                                         &MaterialDesc::axial_damping,     &MaterialDesc::bending_damping,
                                                         &MaterialDesc::torsional_damping, &MaterialDesc::drag,
                                                         &MaterialDesc::friction};

template <class Part>
void add_vector(const std::string& name, const std::string& description, Part SceneDesc::*part, Vector3 Part::*vector,
                std::vector<TunableNumber>& numbers) {
  const char* axes[] = {"_x", "_y", "_z"};
  for (int axis = 0; axis < 3; ++axis)
    numbers.push_back({name + axes[axis], description, coordinate,
                       [=](const SceneDesc& scene) { return (scene.*part.*vector)[axis]; },
                       [=](SceneDesc& scene, double value) { (scene.*part.*vector)[axis] = value; }});
}

/// Of a material that bends alike about all axes one number, which stays so; else one an axis.
void add_bending_stiffness(const SceneDesc& scene, std::size_t material, std::vector<TunableNumber>& numbers) {
  const auto& [key, member, unit, range, required] = bending_stiffness_field;
  const std::string name = scene.materials[material].name + "_" + key, description = std::string("[") + unit + "]";
  const auto add = [&, range = range](const std::string& suffix, std::size_t first, std::size_t last) {
    numbers.push_back({name + suffix, description, range,
                       [=](const SceneDesc& s) { return s.materials[material].material.bending_stiffness[first]; },
                       [=](SceneDesc& s, double value) {
                         BendingStiffness& stiffness = s.materials[material].material.bending_stiffness;
                         stiffness[first] = stiffness[last] = value;
                       }});
  };
  if (scene.materials[material].material.bending_stiffness.is_isotropic()) return add("", 0, 1);
  add("_y", 0, 0);
  add("_z", 1, 1);
}

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
SceneDesc changed_scene(SceneDesc scene, const std::vector<TunableNumber>& numbers, const Config& changes) {
  std::vector<std::string> errors;
  for (const auto& change : changes.doubles) {
    const auto number = std::find_if(numbers.begin(), numbers.end(), [&](const auto& n) { return n.name == change.name; });
    if (number == numbers.end()) {
      errors.push_back("tuning: unknown parameter " + verlet_cable::quoted(change.name));
    } else if (!number->range.contains(change.value)) {
      errors.push_back("tuning." + number->name + ": " + number_text(change.value) + "; allowed: " + number->range.text());
    } else {
      number->set(scene, change.value);
    }
  }
  if (!changes.bools.empty() || !changes.ints.empty() || !changes.strs.empty())
    errors.push_back("tuning: a parameter that is not of type double; allowed: those of type double");
  if (errors.empty()) errors = validate(scene);
  if (!errors.empty()) throw SceneError(std::move(errors));
  return scene;
}

}  // namespace

std::vector<TunableNumber> tunable_numbers(const SceneDesc& scene) {
  std::vector<TunableNumber> numbers;
  add_vector("gravity", "[m/s^2]", &SceneDesc::gravity, &GravityDesc::acceleration, numbers);
  add_vector("wind", "[m/s] velocity of the fluid", &SceneDesc::fluid, &FluidDesc::velocity, numbers);
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    for (const auto& field : material_fields) {
      const auto member = field.member;
      if (std::find(std::begin(tunable_of_material), std::end(tunable_of_material), member) == std::end(tunable_of_material))
        continue;
      // What is inextensible stays so: lengths that are kept exactly cannot turn into springs at once, nor back.
      if (scene.materials[i].material.*member == infinity) continue;
      Range range = field.range;
      range.infinite = false;
      numbers.push_back({scene.materials[i].name + "_" + field.key, std::string("[") + field.unit + "]", range,
                         [i, member](const SceneDesc& s) { return s.materials[i].material.*member; },
                         [i, member](SceneDesc& s, double value) { s.materials[i].material.*member = value; }});
    }
    add_bending_stiffness(scene, i, numbers);
  }
  if (scene.contact)
    numbers.push_back({"contact_friction", "[] cable against cable", not_negative,
                       [](const SceneDesc& s) { return s.contact->friction; },
                       [](SceneDesc& s, double value) { s.contact->friction = value; }});
  return numbers;
}

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
