#pragma once

#include <ros/ros.h>

#include <vector>

#include "verlet_cable/ros/simulation.h"

namespace verlet_cable {

/// The services of the node. Requests are checked and applied at once: the simulation's updates and they share one queue of
/// callbacks, so each is applied between steps, in the order they came.
class CableServices {
 public:
  CableServices(ros::NodeHandle& private_node, Simulation& simulation);

 private:
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace verlet_cable
