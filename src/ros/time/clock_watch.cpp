#include "time/clock_watch.h"

#include <ros/console.h>

namespace verlet_cable {
namespace {

/// Whoever publishes the clock may have been started together with the node.
const ros::WallDuration first_warning(2.0);
const ros::WallDuration warning_period(10.0);

}  // namespace

ClockWatch::Motion ClockWatch::update() {
  const ros::Time now = ros::Time::now();
  if (now_.isZero() && now.isZero()) warn_of_no_time();
  if (now == now_ || now.isZero()) return Motion::none;
  const Motion motion = now > now_ ? Motion::forward : Motion::back;
  now_ = now;
  last_motion_ = ros::WallTime::now();
  return motion;
}

void ClockWatch::warn_of_no_time() {
  const ros::WallTime now = ros::WallTime::now();
  if (next_warning_.isZero()) next_warning_ = now + first_warning;
  if (now < next_warning_) return;
  next_warning_ = now + warning_period;
  ROS_WARN("no ROS time yet: use_sim_time is true, and nothing publishes /clock; the simulation starts when something does");
}

bool ClockWatch::stands() const {
  return !last_motion_.isZero() && ros::WallTime::now() - last_motion_ > ros::WallDuration(0.5);
}

}  // namespace verlet_cable
