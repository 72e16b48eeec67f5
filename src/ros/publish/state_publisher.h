#pragma once

#include <ros/ros.h>

#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `state` (verlet_cable/CableArray): everything that is simulated, in double precision.
class StatePublisher {
 public:
  StatePublisher(ros::NodeHandle& private_node, const SceneDesc& scene);
  void show(const SceneDesc& scene);  ///< from now on
  void publish(const World& world, const ros::Time& stamp);

 private:
  ros::Publisher publisher_;
  std::string frame_id_;
};

}  // namespace verlet_cable
