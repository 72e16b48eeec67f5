#pragma once

#include "scene/scene_errors.h"

namespace verlet_cable {

/// The dimensions that the shape's type has.
void check_shape(const std::string& prefix, const ShapeDesc& shape, Errors& errors);

/// The part of `validate` that is about obstacles, the robot and contact.
void check_obstacles(const SceneDesc& scene, Errors& errors);

}  // namespace verlet_cable
