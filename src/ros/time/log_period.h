#pragma once

#include <ros/duration.h>

namespace verlet_cable {

constexpr double log_period = 5;                       ///< [s] between warnings about what may last
inline const ros::WallDuration reminder_period(10.0);  ///< between reminders of what is waited for

}  // namespace verlet_cable
