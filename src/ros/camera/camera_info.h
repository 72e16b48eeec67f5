#pragma once

#include <sensor_msgs/CameraInfo.h>

#include <string>

#include "verlet_cable/view/camera_model.h"

namespace verlet_cable {

/// Without header; images are not rectified by it.
sensor_msgs::CameraInfo info_of(const view::CameraModel& model);

/// What a driver says of its camera.
struct ReceivedModel {
  std::string problem;      ///< all why it cannot be used, with field, value and what is allowed; empty: it can
  view::CameraModel model;  ///< with any depth range
};
ReceivedModel model_of(const sensor_msgs::CameraInfo& info, double near, double far);

}  // namespace verlet_cable
