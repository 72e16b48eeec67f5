#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "publish/wrench_topics.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `contact/OBSTACLE` (geometry_msgs/WrenchStamped), one per obstacle, link of a robot and body: force and torque of the
/// cables and bodies that touch it, in the axes of its frame, with the torque about the origin of that frame; mean since the last
/// tick. A topic exists as long as what it names, except for the time that the master takes.
class ContactPublisher {
 public:
  explicit ContactPublisher(ros::NodeHandle& private_node);
  void note_step(const World& world);  ///< after each step
  void forget_steps() { sums_.clear(); }
  void publish(const World& world, const ros::Time& stamp);

 private:
  /// Of a topic that somebody listens to, over the steps since the last tick.
  struct Sum {
    std::string name;
    Vector3 force = Vector3::Zero(), torque = Vector3::Zero();
    int steps = 0;
  };

  WrenchTopics topics_;
  std::vector<Sum> sums_;
  bool shown_ = false;
};

}  // namespace verlet_cable
