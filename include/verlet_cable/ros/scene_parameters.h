#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/node/node.h>

#include <string>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// A parameter as the tree of keys that the scene reader knows. `key` is its full name, for errors: throws SceneError where the
/// tree holds binary data or dates.
YAML::Node to_yaml(const XmlRpc::XmlRpcValue& value, const std::string& key = {});

/// Reads the scene from a node's private parameters; `tuning` is left out. Throws SceneError with every error at once.
SceneDesc read_scene_parameters(const ros::NodeHandle& private_node);

}  // namespace verlet_cable
