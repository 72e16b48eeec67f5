#pragma once

#include "value.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {

/// Reads the robot and the meshes that a scene names. What cannot be read is an error under its key.
void read_scene_files(const Value& root, const SceneSources& sources, SceneDesc& scene);

}  // namespace verlet_cable
