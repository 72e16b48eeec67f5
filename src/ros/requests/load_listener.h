#pragma once

#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>

#include <map>
#include <string>

#include "simulation/simulation.h"

namespace verlet_cable {

/// Subscribed topic `apply/BODY` (geometry_msgs/WrenchStamped), one per body of the scene: force and torque at its center
/// of mass, in the axes of the header's frame, until the next message, but no longer than `apply_timeout`. A message that is
/// refused is logged and changes nothing.
class LoadListener {
 public:
  LoadListener(ros::NodeHandle& private_node, Simulation& simulation);

  /// Subscribes to the topics of the bodies that there are now. To be called between steps.
  void follow_scene();

 private:
  void receive(const std::string& body, const geometry_msgs::WrenchStamped& message);

  Simulation& simulation_;
  ros::NodeHandle node_;
  int scene_version_ = -1;                              ///< whose bodies all have their topics
  std::map<std::string, ros::Subscriber> subscribers_;  ///< by body
};

}  // namespace verlet_cable
