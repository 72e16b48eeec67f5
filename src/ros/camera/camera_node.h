#pragma once

#include <ros/ros.h>

#include <memory>

namespace verlet_cable {

/// What a depth camera sees of the cables of a cable node. All callbacks come from the queue of the node handle, which must be
/// served by one thread.
class CameraNode {
 public:
  /// Throws SceneError.
  explicit CameraNode(ros::NodeHandle private_node);
  ~CameraNode();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace verlet_cable
