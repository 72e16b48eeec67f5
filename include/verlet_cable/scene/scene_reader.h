#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/scene/resource.h"

namespace verlet_cable {

/// Where a scene may take from what it names outside of its own text.
struct SceneSources {
  FileAccess files;
  /// The value of a parameter, none if it is not set. Empty where there are no parameters.
  std::function<std::optional<std::string>(const std::string& name)> parameter;
};

/// Of scalars that are no text, whatever they look like.
constexpr const char* boolean_tag = "tag:yaml.org,2002:bool";

/// Reads a scene from its tree of keys. Throws SceneError with every error at once: unknown and doubled keys, wrong
/// types, meshes and robots that cannot be read, and all that `validate` finds; in the order of the tree, then of `validate`.
/// Scalars are text, as YAML has them: numbers may be written as integers, decimals or `.inf`. Top-level keys in `ignored` are
/// not looked at. What is nothing is refused; errors call it by its tag, where it has one. The tree must be finite: aliases are
/// bounded for text by `read_scene_text`, and nowhere else.
SceneDesc read_scene(const YAML::Node& root, const std::vector<std::string>& ignored = {}, const SceneSources& sources = {});

/// Reads a scene from YAML text: one document, at most 64 MB, a million values and 32 levels deep, aliases counted as often as
/// they are used. Throws SceneError; syntax errors with line and column.
SceneDesc read_scene_text(const std::string& text, const SceneSources& sources = {});

/// Reads a scene from a YAML file, and what it names from anywhere: relative paths start at the file. Throws SceneError, also
/// where the file cannot be read.
SceneDesc read_scene_file(const std::string& path);
/// The same, and what it names from `sources` only.
SceneDesc read_scene_file(const std::string& path, const SceneSources& sources);

/// Reads one obstacle by the keys that a scene's have. Throws SceneError likewise; its lines begin with the key.
ObstacleDesc read_obstacle(const YAML::Node& keys, const SceneSources& sources = {});

}  // namespace verlet_cable
