#include "camera/camera_settings.h"

#include <ros/names.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <set>

#include "scene/keys.h"
#include "scene_sources/scene_parameters.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

constexpr Range rates{1e-3, 1000, "any number above 0, at most 1000"};
constexpr Range timeouts{1e-3, 30, "any number above 0, at most 30"};
constexpr const char* topic_words = "the name of a topic";

/// A number or numbers that `member(owner)` gives; its range is checked later.
template <class Owner, class Member>
Key<Owner> inner_key(const std::string& name, const Member& member, const std::string& allowed) {
  return {name, allowed, false, [=](const Value& value, Owner& owner) { read_field(value, member(owner), allowed); }};
}

template <class Owner, std::size_t N, class Member>
Key<Owner> numbers_key(const std::string& name, const Member& member, const std::string& allowed) {
  return {name, allowed, false, [=](const Value& value, Owner& owner) { member(owner) = read_numbers<N>(value, allowed); }};
}

Keys<view::SensorModel> noise_keys() {
  using view::SensorModel;
  const auto number = [](const std::string& name, double SensorModel::*member) {
    return inner_key<SensorModel>(
        name, [member](SensorModel& sensor) -> double& { return sensor.*member; }, "a number");
  };
  return {numbers_key<SensorModel, 3>(
              "axial", [](SensorModel & sensor) -> auto& { return sensor.axial; }, "three numbers a, b and c"),
          number("dropout_angle", &SensorModel::dropout_angle),
          number("baseline", &SensorModel::baseline),
          number("disparity_step", &SensorModel::disparity_step),
          number("edge_dropout", &SensorModel::edge_dropout),
          number("edge_step", &SensorModel::edge_step)};
}

Key<CameraSettings> labels_key() {
  const std::string allowed = "a list of names, each once";
  return {"labels", allowed, false, [=](const Value& value, CameraSettings& settings) {
            if (!value.node.IsSequence()) return value.reject(allowed);
            std::set<std::string> seen;
            for (std::size_t i = 0; i < value.node.size(); ++i) {
              const Value label = value.element(i, value.node[i]);
              settings.labels.push_back(read_text(label, allowed));
              if (!seen.insert(settings.labels.back()).second) label.reject(allowed);
            }
          }};
}

Keys<CameraSettings> camera_keys() {
  using Settings = CameraSettings;
  const auto of_camera = [](const std::string& name, auto member, const std::string& allowed) {
    return inner_key<Settings>(
        name, [member](Settings & settings) -> auto& { return settings.camera.*member; }, allowed);
  };
  return {text_key("state", &Settings::state, topic_words),
          text_key("optical_frame", &Settings::optical_frame, frame_words),
          text_key("preset", &Settings::preset, "the name of a sensor"),
          of_camera("width", &view::CameraDesc::width, "a whole number"),
          of_camera("height", &view::CameraDesc::height, "a whole number"),
          of_camera("horizontal_fov", &view::CameraDesc::horizontal_fov, "a number"),
          of_camera("near", &view::CameraDesc::near, "a number"),
          of_camera("far", &view::CameraDesc::far, "a number"),
          numbers_key<Settings, 5>(
              "distortion", [](Settings & settings) -> auto& { return settings.camera.distortion; },
              "five numbers k1, k2, t1, t2, k3"),
          field_key(Field<Settings>{"rate", &Settings::rate, "Hz", rates}),
          field_key(Field<Settings>{"tf_timeout", &Settings::tf_timeout, "s", timeouts}),
          {"noise", "a map of axial, dropout_angle, baseline, disparity_step, edge_dropout, edge_step", false,
           [](const Value& value, Settings& settings) { read_map(value, noise_keys(), settings.sensor); }},
          field_key(Field<Settings, int>{"seed", &Settings::seed, "", {0, largest_integer, "an integer from 0"}}),
          choice_key("depth_encoding", &Settings::depth_encoding,
                     {{"32FC1", DepthEncoding::metres}, {"16UC1", DepthEncoding::millimetres}}),
          switch_key("shadows", &Settings::shadows),
          labels_key(),
          text_key("robot_description", &Settings::robot_description, "the name of a parameter with a URDF"),
          text_key("camera_info_topic", &Settings::camera_info_topic, topic_words)};
}

/// What the parameter `preset` names, if it is one.
void apply_preset(const Value& root, CameraSettings& settings) {
  const YAML::Node node = root.node["preset"];
  if (!node || !node.IsScalar() || node.Scalar().empty()) return;
  if (const view::CameraPreset* preset = view::find_camera_preset(node.Scalar())) {
    settings.camera = preset->camera;
    settings.sensor = preset->sensor;
    return;
  }
  std::string names;
  for (const view::CameraPreset& preset : view::camera_presets()) names += (names.empty() ? "" : " | ") + preset.name;
  root.child("preset", node).reject(names);
}

void check_topic(const Value& root, const char* key, const std::string& topic) {
  std::string problem;
  if (!ros::names::validate(topic, problem)) root.errors->add(key, verlet_cable::in_quotes(topic), topic_words);
}

void check_range(const Value& root, const char* key, const char* unit, double number, const Range& range) {
  if (!range.contains(number) && !root.errors->is_unread(key)) root.errors->add(key, number_text(number), range.text(unit));
}

void check(const Value& root, const CameraSettings& settings) {
  check_topic(root, "state", settings.state);
  if (settings.state.empty()) root.errors->add("state", "\"\"", topic_words);
  check_topic(root, "camera_info_topic", settings.camera_info_topic);
  if (!is_frame_name(settings.optical_frame))
    root.errors->add("optical_frame", verlet_cable::in_quotes(settings.optical_frame), frame_words);
  check_range(root, "rate", "Hz", settings.rate, rates);
  check_range(root, "tf_timeout", "s", settings.tf_timeout, timeouts);
  if (settings.seed < 0) root.errors->add("seed", std::to_string(settings.seed), "an integer from 0");
  std::vector<std::string> problems = view::validate(settings.camera);
  if (problems.empty()) problems = view::validate(view::camera_model(settings.camera));
  root.errors->add_validation(problems);
  root.errors->add_validation(view::validate(settings.sensor, settings.camera.near, settings.camera.far));
}

/// Whoever names a robot has one.
void read_robot(const Value& root, const std::optional<std::string>& text, CameraSettings& settings) {
  if (text) {
    settings.robot = *text;
  } else if (settings.robot_description != CameraSettings{}.robot_description && !settings.robot_description.empty()) {
    root.errors->add("robot_description", verlet_cable::in_quotes(settings.robot_description) + " is not set, or is no text",
                     "a parameter with a URDF");
  }
}

}  // namespace

CameraSettings read_camera_settings(const YAML::Node& parameters,
                                    const std::function<std::optional<std::string>(const std::string&)>& parameter) {
  ErrorList errors;
  const Value root{parameters, "", &errors};
  CameraSettings settings;
  apply_preset(root, settings);
  read_map(root, camera_keys(), settings);
  check(root, settings);
  const std::string& robot = settings.robot_description;
  read_robot(root, robot.empty() ? std::nullopt : parameter(robot), settings);
  if (!errors.empty()) throw SceneError(errors.take());
  return settings;
}

CameraSettings read_camera_parameters(const ros::NodeHandle& private_node) {
  const std::string where = private_node.getNamespace();
  XmlRpc::XmlRpcValue parameters;
  private_node.getParam(where, parameters);
  const bool has_any = parameters.getType() == XmlRpc::XmlRpcValue::TypeStruct;
  const YAML::Node tree = has_any ? to_yaml(parameters) : YAML::Node(YAML::NodeType::Map);
  CameraSettings settings = read_camera_settings(tree, node_sources("", where).parameter);
  const std::string around = ros::names::parentNamespace(where);
  settings.state = ros::names::resolve(around, settings.state);
  if (!settings.camera_info_topic.empty()) settings.camera_info_topic = ros::names::resolve(around, settings.camera_info_topic);
  return settings;
}

}  // namespace verlet_cable
