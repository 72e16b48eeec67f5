#include "scene_sources/scene_parameters.h"

#include <ros/console.h>
#include <ros/names.h>
#include <ros/param.h>
#include <yaml-cpp/yaml.h>

#include <cmath>
#include <optional>
#include <string>

#include "scene/scene_size.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

using XmlRpc::XmlRpcValue;

std::string yaml_number(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  return number_text(value);
}

/// XmlRpcValue converts by non-const reference only.
class Converter {
 public:
  YAML::Node node_of(XmlRpcValue& value, const std::string& key, std::size_t level) {
    const bool is_text = value.getType() == XmlRpcValue::TypeString;
    size_.add(key, level, is_text ? static_cast<std::string&>(value).size() : 0);
    switch (value.getType()) {
      case XmlRpcValue::TypeBoolean:
        return YAML::Node(static_cast<bool&>(value) ? "true" : "false");
      case XmlRpcValue::TypeInt:
        return YAML::Node(std::to_string(static_cast<int&>(value)));
      case XmlRpcValue::TypeDouble:
        return YAML::Node(yaml_number(static_cast<double&>(value)));
      case XmlRpcValue::TypeString:
        return YAML::Node(static_cast<std::string&>(value));
      case XmlRpcValue::TypeArray:
        return array_of(value, key, level);
      case XmlRpcValue::TypeStruct:
        return struct_of(value, key, level);
      case XmlRpcValue::TypeInvalid:
        return YAML::Node(YAML::NodeType::Null);
      default:
        throw SceneError({key + ": binary data or a date; allowed: numbers, text, true, false, lists and maps"});
    }
  }

 private:
  YAML::Node struct_of(XmlRpcValue& value, const std::string& key, std::size_t level) {
    YAML::Node map(YAML::NodeType::Map);
    for (auto& [name, member] : value) {
      size_.add(key, level, name.size());
      const std::string text = escaped(name);
      map.force_insert(name, node_of(member, key.empty() ? text : key + "." + text, level + 1));
    }
    return map;
  }

  YAML::Node array_of(XmlRpcValue& value, const std::string& key, std::size_t level) {
    YAML::Node sequence(YAML::NodeType::Sequence);
    for (int i = 0; i < value.size(); ++i) sequence.push_back(node_of(value[i], key + "[" + std::to_string(i) + "]", level + 1));
    return sequence;
  }

  SceneSize size_;
};

}  // namespace

YAML::Node to_yaml(XmlRpcValue value, const std::string& key) {
  return Converter().node_of(value, key, 0);
}

SceneSources node_sources(const std::string& scene_directory, const std::string& where) {
  SceneSources sources;
  sources.files = {false, scene_directory};
  sources.parameter = [where](const std::string& name) -> std::optional<std::string> {
    std::string full_name, text;
    const bool found = ros::names::validate(name, full_name) && ros::param::search(where, name, full_name);
    return found && ros::param::get(full_name, text) ? std::optional(text) : std::nullopt;
  };
  return sources;
}

void warn_of_left_out(const SceneDesc& scene) {
  if (!scene.robot) return;
  for (const std::string& line : scene.robot->left_out) ROS_WARN("%s", line.c_str());
}

SceneDesc read_scene_parameters(const ros::NodeHandle& private_node) {
  XmlRpcValue parameters;
  private_node.getParam(private_node.getNamespace(), parameters);
  if (parameters.getType() != XmlRpcValue::TypeStruct) {
    throw SceneError({"no scene: the parameters under " + private_node.getNamespace() +
                      " are empty. To start the node with a scene: roslaunch verlet_cable cable.launch scene:=FILE.yaml; in a "
                      "launch file of your own, inside <node>: <rosparam command=\"load\" file=\"FILE.yaml\"/>"});
  }
  std::string scene_directory;
  private_node.getParam("scene_directory", scene_directory);
  SceneDesc scene = read_scene(to_yaml(parameters), {"tuning"}, node_sources(scene_directory, private_node.getNamespace()));
  warn_of_left_out(scene);
  return scene;
}

}  // namespace verlet_cable
