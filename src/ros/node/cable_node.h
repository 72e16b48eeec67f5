#pragma once

#include <ros/ros.h>

#include <memory>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// Everything the node is: the scene of its private parameters, simulated, published and served. All callbacks come from the
/// queue of the node handle, which must be served by one thread.
class CableNode {
 public:
  /// Throws SceneError.
  explicit CableNode(ros::NodeHandle private_node);
  ~CableNode();

  /// The destructor waits for what is being done aside.
  bool busy() const;

 private:
  /// Declared only: its headers would cost every file that includes this one seconds to compile.
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

/// Logs every error of a scene as fatal.
void log_errors(const SceneError& error);

}  // namespace verlet_cable
