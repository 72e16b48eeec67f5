#pragma once

#include <ros/time.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <map>
#include <optional>
#include <string>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Subscribed topic `/tf` (tf2_msgs/TFMessage), and `/tf_static`: where the camera and the robot's links are at the time of a
/// state.
class TfFrames {
 public:
  TfFrames();

  /// Of a frame in another at a time. None where tf does not know it, or not yet; `why` says what it lacks.
  std::optional<Pose> pose(const std::string& fixed_frame, const std::string& frame, const ros::Time& time, std::string& why);

 private:
  struct Known {
    std::string fixed_frame;
    ros::Time time;
    Pose pose;
  };

  tf2_ros::Buffer buffer_;
  tf2_ros::TransformListener listener_;
  std::map<std::string, Known> known_;  ///< by frame, the last: tf forgets it where the simulation stands for long
};

}  // namespace verlet_cable
