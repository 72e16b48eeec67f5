#pragma once

#include <ros/ros.h>

#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `/tf` (tf2_msgs/TFMessage): the poses of the bodies, as children of the fixed frame, if `broadcast_tf` is true.
class BodyFrames {
 public:
  BodyFrames(const ros::NodeHandle& node, const SceneDesc& scene) : node_(node) { show(scene); }
  void show(const SceneDesc& scene);  ///< from now on
  /// Nothing where the time stands: a transform of a frame is sent once for a stamp.
  void publish(const World& world, const ros::Time& stamp);

 private:
  ros::NodeHandle node_;
  ros::Publisher publisher_;  ///< from the first body on
  std::string frame_id_;
  bool broadcasts_ = true;
  ros::Time last_;
};

}  // namespace verlet_cable
