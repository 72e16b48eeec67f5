#pragma once

#include "scene/scene_errors.h"

namespace verlet_cable {

/// The part of `validate` that is about obstacles, the robot and contact.
void check_obstacles(const SceneDesc& scene, Errors& errors);

}  // namespace verlet_cable
