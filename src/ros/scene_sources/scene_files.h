#pragma once

#include <verlet_cable/LoadScene.h>

#include <string>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// The file that a scene may read: `package://PACKAGE/PATH` inside the package, or a path inside `scene_directory` (absolute or
/// relative to it; where it leads to counts, through links). Throws SceneError with `key`, the value and what is allowed.
std::string find_scene_file(const std::string& key, const std::string& file, const std::string& scene_directory);

/// The path of a file that may be written: inside `scene_directory` (absolute or relative to it), in a directory that is there.
/// Throws SceneError likewise.
std::string writable_scene_file(const std::string& key, const std::string& file, const std::string& scene_directory);

/// The scene that a request means. What the node was started with in `current` stays in force: `limits` and `scene_directory`.
/// `node`: its private namespace. Logs what is doubtful in the scene. Throws SceneError.
SceneDesc read_requested_scene(const LoadScene::Request& request, const SceneDesc& current, const std::string& node);

}  // namespace verlet_cable
