#pragma once

#include <ros/ros.h>

#include <map>
#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `state` (verlet_cable/CableArray): everything that is simulated, in double precision.
class StatePublisher {
 public:
  StatePublisher(ros::NodeHandle& private_node, const SceneDesc& scene);
  void show(const SceneDesc& scene);   ///< from now on
  void note_step(const World& world);  ///< after each step
  void forget_steps();
  /// With the worst statuses since the last call.
  void publish(const World& world, const ros::Time& stamp);

 private:
  ros::Publisher publisher_;
  std::string frame_id_;
  std::map<std::string, StepResult::Status> worst_;  ///< of cables and bodies, since the last call of `publish`
};

}  // namespace verlet_cable
