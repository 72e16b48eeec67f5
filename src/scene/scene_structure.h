#pragma once

#include <string>
#include <utility>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// Of each kind of things in a scene, what they are: names, types and what they belong to, and how many nodes there are.
using SceneStructure = std::vector<std::pair<std::string, std::vector<std::string>>>;

/// What scenes that differ only in numbers have in common.
SceneStructure structure_of(const SceneDesc& scene);

}  // namespace verlet_cable
