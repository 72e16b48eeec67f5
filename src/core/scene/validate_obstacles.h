#pragma once

#include "scene/scene_errors.h"

namespace verlet_cable {

/// The dimensions that the shape's type has.
void check_shape(const std::string& prefix, const ShapeDesc& shape, Errors& errors);

/// The part of `validate` that is about obstacles, the robot and contact. `names`: of what may touch them: contacts, events and
/// topics tell all of these by their names.
void check_obstacles(const SceneDesc& scene, UniqueNames names, Errors& errors);

}  // namespace verlet_cable
