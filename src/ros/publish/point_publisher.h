#pragma once

#include <ros/ros.h>

#include "publish/color.h"
#include "publish/drawing_frame.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `points` (sensor_msgs/PointCloud2): the nodes of every cable, in order, as a cloud of height 1 with the fields x, y, z
/// [m], rgb, tension [N] (of the segment that starts at the node; the last node repeats its neighbour's), cable_id, node_id and s
/// (arc length [m]). Nets follow, with continued cable_id, the largest tension of the links at the node, and s = 0; then
/// particles, without tension.
class PointPublisher {
 public:
  PointPublisher(ros::NodeHandle& private_node, const SceneDesc& scene, const DrawingFrame& frame);
  void show(const SceneDesc& scene, const DrawingFrame& frame);  ///< from now on
  void publish(const World& world, const ColorScale& colors, const ros::Time& stamp);

 private:
  ros::Publisher publisher_;
  DrawingFrame frame_;
};

}  // namespace verlet_cable
