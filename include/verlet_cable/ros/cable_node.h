#pragma once

#include <ros/ros.h>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/ros/cable_services.h"
#include "verlet_cable/ros/diagnostics.h"
#include "verlet_cable/ros/guarded_queue.h"
#include "verlet_cable/ros/hands.h"
#include "verlet_cable/ros/obstacle_listener.h"
#include "verlet_cable/ros/rollouts.h"
#include "verlet_cable/ros/simulation.h"
#include "verlet_cable/ros/tuning.h"

namespace verlet_cable {

/// Everything the node is: the scene of its private parameters, simulated, published and served. All callbacks come from the
/// queue of the node handle, which must be served by one thread.
class CableNode {
 public:
  /// Throws SceneError.
  explicit CableNode(ros::NodeHandle private_node);

  /// The destructor waits for what is being done aside.
  bool busy() const { return simulation_.busy(); }

 private:
  void update();

  GuardedQueue guard_;
  ros::NodeHandle node_;
  Simulation simulation_;
  CableServices services_;
  ObstacleListener obstacles_;
  Tuning tuning_;
  Rollouts rollouts_;
  Hands hands_;
  Diagnostics diagnostics_;
  ros::WallTimer timer_;
  double publish_rate_;  ///< [Hz] for which the timer runs
};

/// Logs every error of a scene as fatal.
void log_errors(const SceneError& error);

}  // namespace verlet_cable
