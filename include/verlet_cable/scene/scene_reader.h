#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/scene/resource.h"

namespace verlet_cable {

/// Where a scene may read the files and parameters that it names.
struct SceneSources {
  FileAccess files;
  /// The value of a parameter, none if it is not set. An empty function if there are no parameters.
  std::function<std::optional<std::string>(const std::string& name)> parameter;
  /// The frame that the program sends at a scene's `origin`, a name that the scene must not use then; empty: it sends none.
  std::string origin_frame = {};
};

/// Tag of scalars that are booleans and not text, whatever they look like.
constexpr const char* boolean_tag = "tag:yaml.org,2002:bool";

/// Reads a scene from its tree of keys. Throws SceneError with all errors at once: unknown and duplicate keys, wrong
/// types, meshes and robots that cannot be read, and all that `validate` finds; in the order of the tree, then of `validate`.
/// Scalars are text, as in YAML: numbers may be written as integers, decimals or `.inf`. Top-level keys in `ignored` are
/// ignored. Null values are refused; errors name them by their tag if they have one. The tree must be finite: aliases are
/// limited by `read_scene_text` for text, and nowhere else.
SceneDesc read_scene(const YAML::Node& root, const std::vector<std::string>& ignored = {}, const SceneSources& sources = {});

/// Reads a scene from YAML text: one document of at most 16 MiB, a million values and 32 levels, with aliases counted each time
/// they are used. Throws SceneError; syntax errors come with line and column.
SceneDesc read_scene_text(const std::string& text, const SceneSources& sources = {});

/// Access to any file, with relative paths referring to the directory of a scene file.
FileAccess access_beside(const std::string& scene);

/// The text of a scene file, of which no more is read than `read_scene_text` allows. Throws SceneError.
std::string scene_file_text(const std::string& path);

/// Reads a scene from a YAML file, and the files that it names from anywhere: relative paths refer to the directory of the scene
/// file. Throws SceneError, also if the file cannot be read.
SceneDesc read_scene_file(const std::string& path);
/// The same, but files and parameters that it names are read from `sources` only.
SceneDesc read_scene_file(const std::string& path, const SceneSources& sources);

/// Paths of the files that a scene names and that are there: meshes of obstacles, bodies and the robot, and the robot's URDF.
std::vector<std::string> named_files(const SceneDesc& scene, const FileAccess& access);

/// Reads one obstacle, with the keys of an obstacle in a scene. Throws SceneError likewise; its lines begin with the key.
ObstacleDesc read_obstacle(const YAML::Node& keys, const SceneSources& sources = {});

}  // namespace verlet_cable
