#pragma once

#include <ros/ros.h>
#include <verlet_cable/Appearance.h>

#include <set>
#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `appearance` (verlet_cable/Appearance): what a camera needs besides `state`: colors and radii, and the obstacles, links
/// of robots and bodies where they are simulated. It is exact, while `markers` are for the eye.
class AppearancePublisher {
 public:
  AppearancePublisher(ros::NodeHandle& private_node, const SceneDesc& scene);
  void show(const SceneDesc& scene);  ///< from now on
  void publish(const World& world, const ros::Time& stamp);

 private:
  void add_obstacles(const World& world, Appearance& message) const;

  ros::Publisher publisher_;
  std::string frame_id_;
  std::set<std::string> links_;  ///< names of the obstacles that are geometry of a robot
};

}  // namespace verlet_cable
