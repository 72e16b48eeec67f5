#pragma once

#include "body/rigid_body_stepper.h"

namespace verlet_cable {

/// A body in a substep.
struct MovingBody {
  RigidBodyStepper stepper;
  MassProperties whole;  ///< with the nodes that it holds: a body moves as one with them
  double size = 0;       ///< [m] of it
};

using Matrix36 = Eigen::Matrix<double, 3, 6>;
using Matrix63 = Eigen::Matrix<double, 6, 3>;

/// By what a point moves with its body; `arm`: to it, from the center of mass.
inline Matrix36 point_motion(const Vector3& arm) {
  Matrix36 m;
  m << Eigen::Matrix3d::Identity(), -cross_matrix(arm);
  return m;
}

/// What a force on a point does to its body.
inline Matrix63 point_load(const Vector3& arm) {
  Matrix63 m;
  m << Eigen::Matrix3d::Identity(), cross_matrix(arm);
  return m;
}

/// What acts on bodies, and how they move.
enum class BodyStage {
  substep,    ///< displacements over the substep; forces act with the mean of their arms
  projection  ///< velocities at its end; impulses
};

/// Of a force on a point of a body.
inline Matrix63 load_of(const RigidBodyStepper& body, const Vector3& point, BodyStage stage) {
  return point_load(stage == BodyStage::substep ? body.force_arm(point) : body.end_arm(point));
}

}  // namespace verlet_cable
