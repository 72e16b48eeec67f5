#pragma once

#include <ros/ros.h>

#include "publish/color.h"
#include "publish/drawing_frame.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `surface` (sensor_msgs/PointCloud2): points on the cables' surface, about evenly spaced, as a cloud of height 1 with the
/// fields x, y, z [m], rgb and cable_id. At most 100000 points: many or long cables have fewer each, in rings of at least 12.
class SurfacePublisher {
 public:
  SurfacePublisher(ros::NodeHandle& private_node, const SceneDesc& scene, const DrawingFrame& frame);
  void show(const SceneDesc& scene, const DrawingFrame& frame);  ///< from now on
  void publish(const World& world, const ColorScale& colors, const ros::Time& stamp);

 private:
  ros::Publisher publisher_;
  DrawingFrame frame_;
};

}  // namespace verlet_cable
