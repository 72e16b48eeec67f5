#pragma once

#include <ros/time.h>

#include "time/ros_time.h"

namespace verlet_cable {

/// ROS time as seen at each update: whether it runs, stands or went back.
class ClockWatch {
 public:
  enum class Motion { none, forward, back };  ///< none: no time yet, too
  /// Reads the clock. Warns, from 2 s of wall time on and every 10 s, that there is no ROS time yet.
  Motion update();

  Nanoseconds now() const { return from_ros_time(now_); }  ///< at the last update; 0 before there was any time
  bool stands() const;                                     ///< has not moved for half a second of wall time

 private:
  void warn_of_no_time();

  ros::Time now_;
  ros::WallTime next_warning_;  ///< that there is no ROS time; zero before the first update
  ros::WallTime last_motion_;
};

}  // namespace verlet_cable
