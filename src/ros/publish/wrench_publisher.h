#pragma once

#include <ros/ros.h>

#include <future>
#include <map>
#include <string>

#include "publish/wrench_means.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `wrench/ATTACHMENT` (geometry_msgs/WrenchStamped), one an attachment: what the cable exerts on what holds it, in the
/// axes of the attachment's frame and with the torque about that frame's origin, the mean since the last tick. A topic is there
/// as long as its attachment, but for the moment that the master takes, which is not waited for.
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
