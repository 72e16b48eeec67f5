#pragma once

#include <ros/ros.h>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// Topic `legend` (verlet_cable/Legend), latched: what the colors of `markers`, `points` and `surface` mean. Published once for
/// each scene.
class LegendPublisher {
 public:
  LegendPublisher(ros::NodeHandle& private_node, const SceneDesc& scene);
  void show(const SceneDesc& scene);

 private:
  ros::Publisher publisher_;
};

}  // namespace verlet_cable
