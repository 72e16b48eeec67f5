#pragma once

#include <vector>

#include "geometry/vector_array.h"

namespace verlet_cable {

struct RigidMotion {
  Vector3 center = Vector3::Zero();    ///< [m]
  Vector3 velocity = Vector3::Zero();  ///< [m/s] there
  Vector3 rate = Vector3::Zero();      ///< [rad/s]

  Vector3 at(const Vector3& place) const { return velocity + rate.cross(place - center); }
};

/// [m] Of the first nodes, one a mass [kg].
Vector3 center_of_mass(const std::vector<double>& masses, const VectorArray& places);

/// The motion with which nodes that move like a rigid body have a momentum [kg m/s] and an angular momentum about their centre of
/// mass [kg m^2/s]; straight chains do not turn about themselves.
RigidMotion rigid_motion(const std::vector<double>& masses, const VectorArray& places, const Vector3& momentum,
                         const Vector3& angular_momentum);

}  // namespace verlet_cable
