#pragma once

#include <ros/ros.h>

#include "publish/color.h"

namespace verlet_cable {

/// Topic `legend` (verlet_cable/Legend), latched: what the colors of `markers`, `points` and `surface` mean. Published whenever
/// that changes.
class LegendPublisher {
 public:
  LegendPublisher(ros::NodeHandle& private_node, const ColorScale& colors);
  void show(const ColorScale& colors);

 private:
  ros::Publisher publisher_;
};

}  // namespace verlet_cable
