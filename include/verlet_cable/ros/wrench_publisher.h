#pragma once

#include <ros/ros.h>

#include <map>
#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topics `wrench/<attachment>`: what the cable exerts on what holds it, in the axes of the attachment's frame and with the
/// torque about that frame's origin. A topic is there as long as its attachment.
class WrenchPublisher {
 public:
  explicit WrenchPublisher(ros::NodeHandle& private_node);
  void publish(const World& world, const ros::Time& stamp);

 private:
  void follow_attachments(const World& world);

  ros::NodeHandle node_;
  std::map<std::string, ros::Publisher> publishers_;  // by attachment name
};

}  // namespace verlet_cable
