#pragma once

#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/view/camera_model.h"
#include "verlet_cable/view/sensor_model.h"

namespace verlet_cable {

enum class DepthEncoding { metres, millimetres };

/// The parameters of a camera: config/cameras/template.yaml says what each means.
struct CameraSettings {
  std::string state = "/cable/state";                  ///< topic of a cable node
  std::string optical_frame = "camera_optical_frame";  ///< on tf
  std::string preset;                                  ///< a sensor that can be bought; empty: none
  view::CameraDesc camera;
  view::SensorModel sensor;
  double rate = 30;  ///< [Hz]
  int seed = 0;
  DepthEncoding depth_encoding = DepthEncoding::metres;
  bool shadows = true;              ///< in colors
  std::vector<std::string> labels;  ///< what else than cables, nets, particles and bodies comes first in masks
  std::string robot_description = "robot_description";
  std::string camera_info_topic;  ///< of a driver; empty: none
  double tf_timeout = 0.5;        ///< [s]
  std::string robot;              ///< URDF of `robot_description`; empty: there is none
};

/// Reads a tree of parameters. `parameter` has the URDF. Throws SceneError with every error at once.
CameraSettings read_camera_settings(const YAML::Node& parameters,
                                    const std::function<std::optional<std::string>(const std::string&)>& parameter);
/// The same of a node's private parameters. Names of topics are completed as those of the node are.
CameraSettings read_camera_parameters(const ros::NodeHandle& private_node);

}  // namespace verlet_cable
