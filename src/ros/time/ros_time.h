#pragma once

#include <ros/time.h>

#include "time/time_grid.h"

namespace verlet_cable {

/// The latest instant that ROS can say: 2^32 s, less a nanosecond.
constexpr Nanoseconds last_ros_time = (Nanoseconds{1} << 32) * 1'000'000'000 - 1;

/// Exact, whatever a message says. ros::Time's own arithmetic throws near the ends of its range, so nothing here adds to or
/// subtracts from one.
inline Nanoseconds from_ros_time(const ros::Time& time) {
  return Nanoseconds{time.sec} * 1'000'000'000 + time.nsec;
}

/// The nearest instant that ROS can say.
ros::Time to_ros_time(Nanoseconds time);

/// Whether the nanoseconds are less than a second, as they are in a message that was made by ROS.
inline bool is_normal(const ros::Time& time) {
  return time.nsec < 1'000'000'000;
}

}  // namespace verlet_cable
