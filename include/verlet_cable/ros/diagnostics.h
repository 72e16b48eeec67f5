#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>

#include "verlet_cable/ros/simulation.h"

namespace verlet_cable {

/// Reports on `/diagnostics`, each second of wall time: how the simulation goes, and how its frames are.
class Diagnostics {
 public:
  Diagnostics(ros::NodeHandle& private_node, Simulation& simulation);

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;
  void report_simulation(Status& status);
  void report_frames(Status& status) const;

  Simulation& simulation_;
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;
};

}  // namespace verlet_cable
