#pragma once

#include <ros/node_handle.h>
#include <xmlrpcpp/XmlRpcValue.h>
#include <yaml-cpp/node/node.h>

#include <string>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {

/// A parameter as the tree of keys that the scene reader knows. `key` is its full name, for errors: throws SceneError where the
/// tree holds binary data or dates, or is larger than a scene may be.
YAML::Node to_yaml(XmlRpc::XmlRpcValue value, const std::string& key = {});

/// What scenes of a node may read: files of packages and in `scene_directory`, and parameters in the namespace `where` and those
/// around it.
SceneSources node_sources(const std::string& scene_directory, const std::string& where);

/// Warns of what a scene's robot does without.
void warn_of_left_out(const SceneDesc& scene);

/// Reads the scene from a node's private parameters; `tuning` is left out. Throws SceneError with every error at once.
SceneDesc read_scene_parameters(const ros::NodeHandle& private_node);

}  // namespace verlet_cable
