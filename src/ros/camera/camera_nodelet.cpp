#include <nodelet/nodelet.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "camera/camera_node.h"
#include "node/cable_node.h"

namespace verlet_cable {

/// The node in a nodelet manager. Cameras of one manager that look at the same cables share what they look at.
class CameraNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<CameraNode>(getPrivateNodeHandle());
    } catch (const SceneError& error) {
      log_errors(error);
      throw;  // the manager takes it for a nodelet that could not be loaded
    }
  }

  std::unique_ptr<CameraNode> node_;
};

}  // namespace verlet_cable

PLUGINLIB_EXPORT_CLASS(verlet_cable::CameraNodelet, nodelet::Nodelet)
