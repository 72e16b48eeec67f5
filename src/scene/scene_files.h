#pragma once

#include "value.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {

/// Reads the robot and the meshes that a scene names. What cannot be read is an error under its key.
void read_scene_files(const Value& root, const SceneSources& sources, SceneDesc& scene);

/// The same of a robot alone, that of the key `robot`.
void read_robot_files(const Value& root, const SceneSources& sources, RobotDesc& robot);

}  // namespace verlet_cable
