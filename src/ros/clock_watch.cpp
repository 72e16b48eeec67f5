#include "verlet_cable/ros/clock_watch.h"

namespace verlet_cable {

ClockWatch::Motion ClockWatch::update() {
  const ros::Time now = ros::Time::now();
  if (now == now_ || now.isZero()) return Motion::none;
  const Motion motion = now > now_ ? Motion::forward : Motion::back;
  now_ = now;
  last_motion_ = ros::WallTime::now();
  return motion;
}

bool ClockWatch::stands() const {
  return !last_motion_.isZero() && ros::WallTime::now() - last_motion_ > ros::WallDuration(0.5);
}

}  // namespace verlet_cable
