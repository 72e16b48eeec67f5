#pragma once

#include <Eigen/Core>
#include <optional>

#include "verlet_cable/core/body_desc.h"
#include "verlet_cable/core/shape.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// What a rigid body's motion depends on, in some frame.
struct MassProperties {
  double mass = 0;                                    ///< [kg]
  Vector3 center_of_mass = Vector3::Zero();           ///< [m]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< [kg m^2] about the center of mass, along the frame's axes
};

/// Those of a shape that is filled evenly with 1 kg/m^3, in its own frame. A plane bounds no solid: zero.
MassProperties mass_properties(const Shape& shape);

/// Those of a body in its frame: where it does not give them, those of its shapes, filled evenly, one density for all; where
/// shapes overlap they count twice. None where inertia is neither given nor follows from a volume. The meshes of its shapes must
/// have been read.
std::optional<MassProperties> mass_properties(const BodyDesc& body);

/// Whether a body can have these principal moments: positive, and none larger than the other two together.
bool is_inertia(const Vector3& moments);

}  // namespace verlet_cable
