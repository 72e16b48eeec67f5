#pragma once

#include <ros/ros.h>

#include <functional>

/// Whether something comes to be so, within 10 s.
inline bool wait_until(const std::function<bool()>& done) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(10);
  while (!done() && ros::WallTime::now() < deadline) ros::WallDuration(0.01).sleep();
  return done();
}
