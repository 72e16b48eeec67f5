#pragma once

#include <set>
#include <string>

#include "simulation/statistics.h"
#include "time/time_grid.h"

namespace verlet_cable {

/// How a simulation goes.
struct SimulationReport {
  /// What it does: the first of these that holds, but for `running`.
  enum class Phase {
    faulted,
    building,             ///< the frames are there, and the scene is being built
    no_time,              ///< there is no ROS time yet
    awaits_first_frames,  ///< to start
    paused,
    awaits_lost_frame,
    running
  };
  Phase phase = Phase::running;
  Statistics statistics;    ///< since the last report
  Nanoseconds behind = 0;   ///< what is due and not simulated yet
  Nanoseconds dropped = 0;  ///< since the node started, as `faults`
  int faults = 0;
  std::set<std::string> intrusions;  ///< "CABLE in OBSTACLE" of those that were found inside since the scene started
};

}  // namespace verlet_cable
