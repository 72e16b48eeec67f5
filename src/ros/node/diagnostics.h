#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include "requests/obstacle_listener.h"
#include "simulation/simulation.h"

namespace verlet_cable {

/// Topic `/diagnostics` (diagnostic_msgs/DiagnosticArray), once per second of wall time: the status of the simulation, its frames
/// and its obstacles.
class Diagnostics {
 public:
  Diagnostics(ros::NodeHandle& private_node, Simulation& simulation, const ObstacleListener& obstacles);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;
  void report_simulation(Status& status);
  /// Which attachments wait for which frames: a key `waiting_attachment CABLE/ATTACHMENT` each, the frame is its value.
  void report_waiting(Status& status) const;
  void report_winches(Status& status) const;
  void report_frames(Status& status) const;
  void report_obstacles(Status& status) const;

  Simulation& simulation_;
  const ObstacleListener& obstacles_;
  Nanoseconds dropped_ = 0;  ///< at the last report
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace verlet_cable
