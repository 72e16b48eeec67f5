#pragma once

#include <ros/ros.h>

#include <string>

#include "publish/color.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `points` (sensor_msgs/PointCloud2): the nodes of every cable, in order, as a cloud of height 1 with the fields x, y, z
/// [m], rgb, tension [N] (of the segment that starts at the node; the last node repeats its neighbour's), cable_id, node_id and s
/// (arc length [m]). Nets follow, with continued cable_id, the largest tension of the links at the node, and s = 0; then
/// particles, without tension.
class PointPublisher {
 public:
  PointPublisher(ros::NodeHandle& private_node, const SceneDesc& scene);
  void show(const SceneDesc& scene);  ///< from now on
  void publish(const World& world, const ros::Time& stamp);

 private:
  ros::Publisher publisher_;
  std::string frame_id_;
  ColorScale colors_;
};

}  // namespace verlet_cable
