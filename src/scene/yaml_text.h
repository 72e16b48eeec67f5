#pragma once

#include <yaml-cpp/yaml.h>

#include <functional>
#include <string>

namespace verlet_cable {

/// Gives `read` the tree of a YAML text: one document of at most 16 MiB, a million values and 32 levels, with aliases counted
/// each time they are used. Throws SceneError; syntax errors come with line and column.
void read_yaml_text(const std::string& text, const std::function<void(const YAML::Node& root)>& read);

}  // namespace verlet_cable
