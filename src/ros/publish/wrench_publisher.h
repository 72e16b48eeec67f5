#pragma once

#include <ros/ros.h>

#include <future>
#include <map>
#include <string>

#include "publish/wrench_means.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `wrench/ATTACHMENT` (geometry_msgs/WrenchStamped), one per attachment: force and torque that the cable exerts on
/// its holder, in the axes of the attachment's frame, with the torque about the origin of that frame; mean since the last tick. A
/// topic exists as long as its attachment, except for the time that the master takes, for which the node does not wait.
class WrenchPublisher {
 public:
  explicit WrenchPublisher(ros::NodeHandle& private_node);
  void publish(const World& world, const ros::Time& stamp);
  WrenchMeans& means() { return means_; }

 private:
  using Topics = std::map<std::string, ros::Publisher>;  // by attachment name

  void follow_attachments(const World& world);

  ros::NodeHandle node_;
  WrenchMeans means_;
  Topics topics_;
  std::future<Topics> new_topics_;  // that are being registered
};

}  // namespace verlet_cable
