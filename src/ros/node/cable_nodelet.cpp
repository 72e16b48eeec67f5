#include <nodelet/nodelet.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "node/cable_node.h"

namespace verlet_cable {

/// The node in a nodelet manager. Its callbacks come one after the other, whatever the number of the manager's threads.
class CableNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<CableNode>(getPrivateNodeHandle());
    } catch (const SceneError& error) {
      log_errors(error);
      throw;  // the manager takes it for a nodelet that could not be loaded
    }
  }

  std::unique_ptr<CableNode> node_;
};

}  // namespace verlet_cable

PLUGINLIB_EXPORT_CLASS(verlet_cable::CableNodelet, nodelet::Nodelet)
