#pragma once

#include <ros/ros.h>

#include "publish/wrench_means.h"
#include "publish/wrench_topics.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `wrench/ATTACHMENT` (geometry_msgs/WrenchStamped), one per attachment: force and torque that the cable exerts on
/// its holder, in the axes of the attachment's frame, with the torque about the origin of that frame; mean since the last tick. A
/// topic exists as long as its attachment, except for the time that the master takes.
class WrenchPublisher {
 public:
  explicit WrenchPublisher(ros::NodeHandle& private_node);
  void publish(const World& world, const ros::Time& stamp);
  WrenchMeans& means() { return means_; }

 private:
  WrenchTopics topics_;
  WrenchMeans means_;
};

}  // namespace verlet_cable
