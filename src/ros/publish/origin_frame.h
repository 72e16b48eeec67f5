#pragma once

#include <tf2_ros/static_transform_broadcaster.h>

#include <optional>
#include <string>

#include "publish/drawing_frame.h"

namespace verlet_cable {

/// Topic `/tf_static` (tf2_msgs/TFMessage), latched: where a scene has an `origin`, the frame of `markers`, `points` and
/// `surface`, named after the node (`cable_origin` for `/cable`), as a child of the fixed frame.
class OriginFrame {
 public:
  /// Nothing where it was sent before.
  void send(const DrawingFrame& frame, const std::string& fixed_frame);

 private:
  std::optional<tf2_ros::StaticTransformBroadcaster> broadcaster_;  // none until a scene has an origin
  geometry_msgs::TransformStamped sent_;
};

}  // namespace verlet_cable
