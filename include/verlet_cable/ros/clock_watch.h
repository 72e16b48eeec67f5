#pragma once

#include <ros/time.h>

#include "verlet_cable/ros/ros_time.h"

namespace verlet_cable {

/// ROS time as seen at each update: whether it runs, stands or went back.
class ClockWatch {
 public:
  enum class Motion { none, forward, back };  ///< none: no time yet, too
  /// Reads the clock.
  Motion update();

  Nanoseconds now() const { return from_ros_time(now_); }  ///< at the last update; 0 before there was any time
  bool stands() const;                                     ///< has not moved for half a second of wall time

 private:
  ros::Time now_;
  ros::WallTime last_motion_;
};

}  // namespace verlet_cable
