#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <vector>

#include "verlet_cable/core/body_desc.h"
#include "verlet_cable/core/shape.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// A part of a body's surface.
struct BodyShape {
  Pose pose;  ///< in the body's frame
  Shape shape;
};

/// A rigid body. It is also a frame, whose pose the world computes and which can hold cables, nets and other bodies.
struct SimulatedBody {
  std::string name;
  double mass = 0;                                    ///< [kg]
  Vector3 center_of_mass = Vector3::Zero();           ///< [m] in its frame
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< [kg m^2] about the center of mass, in its frame's axes
  std::vector<BodyShape> shapes;
  bool is_junction = false;                    ///< it joins cables where they branch; light, without a shape and not published
  double friction = 0;                         ///< Coulomb coefficient
  double linear_damping = 0;                   ///< [N s/m]
  double angular_damping = 0;                  ///< [N m s]
  BodyFluidDesc fluid;                         ///< what the scene's fluid does to it
  int frame = 0;                               ///< index into World::frames()
  Pose pose;                                   ///< of its frame
  Vector3 velocity = Vector3::Zero();          ///< [m/s] of its center of mass, fixed frame's axes
  Vector3 angular_velocity = Vector3::Zero();  ///< [rad/s] fixed frame's axes
};

/// [m] A measure of the size of a body: the root mean square distance of its mass from its center of mass.
inline double radius_of_gyration(const SimulatedBody& body) {
  return std::sqrt(body.inertia.trace() / (2 * body.mass));
}

}  // namespace verlet_cable
