#pragma once

#include <vector>

#include "contact/moving_obstacle.h"

namespace verlet_cable {

/// An obstacle's surface near a point, over a step.
struct SurfaceNear {
  double distance = 0;                         ///< [m] of the point at the start of the step; below 0 inside
  Vector3 normal = Vector3::UnitZ();           ///< out of the obstacle
  Vector3 surface_velocity = Vector3::Zero();  ///< [m/s] of the obstacle there
};

/// The obstacle's surface as it is at a part of a step of h [s], seen from a point; points that are `reach` [m] or further
/// outside are told so early.
SurfaceNear surface_near(const MovingObstacle& moving, const Vector3& point, double part, double h, double reach);

/// A velocity after a bounce: the part across the surface turned round and multiplied by `restitution`, Coulomb friction along
/// it. What does not come nearer stays as it is.
Vector3 bounced(const Vector3& velocity, const SurfaceNear& surface, double restitution, double friction);

/// A node that may touch an obstacle in a step.
struct NodeContact {
  int node = 0;
  SurfaceNear surface;
  double friction = 0;
  double least_velocity = 0;         ///< [m/s] along the normal, relative to the surface, that the contact leaves it
  double pushed = 0;                 ///< [m/s] along the normal by the contact in this step
  Vector3 rubbed = Vector3::Zero();  ///< [m/s] along the surface likewise
};

/// Pushes a node's velocity [m/s] out of the surface, with friction (sequential impulses: Catto, Iterative Dynamics with Temporal
/// Coherence, 2005).
Vector3 press(const Vector3& velocity, NodeContact& contact);

}  // namespace verlet_cable
