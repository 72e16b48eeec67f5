#include "time/ros_time.h"

#include <algorithm>

namespace verlet_cable {

ros::Time to_ros_time(Nanoseconds time) {
  const Nanoseconds inside = std::clamp<Nanoseconds>(time, 0, last_ros_time);
  return {static_cast<std::uint32_t>(inside / 1'000'000'000), static_cast<std::uint32_t>(inside % 1'000'000'000)};
}

}  // namespace verlet_cable
