#pragma once

#include <ros/ros.h>

#include <string>

#include "publish/color.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Topic `surface` (sensor_msgs/PointCloud2): points on the cables' surface, about evenly spaced, as a cloud of height 1 with the
/// fields x, y, z [m], rgb and cable_id. At most 100000 points: many or long cables have fewer each, in rings of at least 12.
class SurfacePublisher {
 public:
  SurfacePublisher(ros::NodeHandle& private_node, const SceneDesc& scene);
  void show(const SceneDesc& scene);  ///< from now on
  void publish(const World& world, const ros::Time& stamp);

 private:
  ros::Publisher publisher_;
  std::string frame_id_;
  ColorScale colors_;
};

}  // namespace verlet_cable
