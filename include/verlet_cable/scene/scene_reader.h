#pragma once

#include <yaml-cpp/yaml.h>

#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// Reads a scene from its tree of keys. Throws SceneError with every error at once: unknown, doubled and unsupported keys, wrong
/// types, and all that `validate` finds; in the order of the tree, then of `validate`. Scalars are text, as YAML has them:
/// numbers may be written as integers, decimals or `.inf`. Top-level keys in `ignored` are not looked at. The tree must be
/// finite: aliases are bounded for text by `read_scene_text`, and nowhere else.
SceneDesc read_scene(const YAML::Node& root, const std::vector<std::string>& ignored = {});

/// Reads a scene from YAML text: one document, at most 64 MB, a million values and 32 levels deep, aliases counted as often as
/// they are used. Throws SceneError; syntax errors with line and column.
SceneDesc read_scene_text(const std::string& text);

/// Reads a scene from a YAML file. Throws SceneError, also where the file cannot be read.
SceneDesc read_scene_file(const std::string& path);

}  // namespace verlet_cable
