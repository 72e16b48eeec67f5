#pragma once

#include <Eigen/Core>

#include "rod/rigid_motion.h"

namespace verlet_cable {

/// The momenta of bodies and the cables that they hold, over a substep: what the forces leave of them, and what velocities have
/// at the end.
class GroupMomenta {
 public:
  void begin() { *this = {}; }
  /// A frame holds a part of it: nothing is to be kept.
  void hold() { is_free_ = false; }
  bool is_free() const { return is_free_; }
  /// A mass [kg] that was at `start` with a velocity and has been displaced; `gain` [m/s]: what the forces have added.
  void expect(double mass, const Vector3& start, const Vector3& displacement, const Vector3& velocity, const Vector3& gain);
  void expect_spin(const Vector3& angular_momentum) { angular_ += angular_momentum; }
  /// A mass at the end.
  void add(double mass, const Vector3& place, const Vector3& velocity);
  void add_spin(const Eigen::Matrix3d& inertia, const Vector3& angular_momentum);
  /// The motion as a rigid body that has what is missing.
  RigidMotion missing() const;

 private:
  bool is_free_ = true, any_ = false;
  Vector3 origin_ = Vector3::Zero();  ///< of moments [m]
  // What is missing, about `origin_`
  Vector3 momentum_ = Vector3::Zero(), angular_ = Vector3::Zero();
  double mass_ = 0;
  Vector3 moment_ = Vector3::Zero();                   ///< of the masses [kg m]
  Eigen::Matrix3d inertia_ = Eigen::Matrix3d::Zero();  ///< about `origin_`
};

}  // namespace verlet_cable
