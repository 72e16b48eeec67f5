#include "body/group_momenta.h"

#include <Eigen/LU>

namespace verlet_cable {

namespace {

Eigen::Matrix3d inertia_of(double mass, const Vector3& arm) {
  return mass * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
}

}  // namespace

void GroupMomenta::expect(double mass, const Vector3& start, const Vector3& displacement, const Vector3& velocity,
                          const Vector3& gain) {
  if (!any_) origin_ = start;
  any_ = true;
  const Vector3 arm = start - origin_;
  momentum_ += mass * (velocity + gain);
  angular_ += mass * (arm.cross(velocity) + (arm + displacement).cross(gain));
}

void GroupMomenta::add(double mass, const Vector3& place, const Vector3& velocity) {
  const Vector3 arm = place - origin_;
  momentum_ -= mass * velocity;
  angular_ -= mass * arm.cross(velocity);
  mass_ += mass;
  moment_ += mass * arm;
  inertia_ += inertia_of(mass, arm);
}

void GroupMomenta::add_spin(const Eigen::Matrix3d& inertia, const Vector3& angular_momentum) {
  inertia_ += inertia;
  angular_ -= angular_momentum;
}

RigidMotion GroupMomenta::missing() const {
  RigidMotion motion;
  const Vector3 arm = moment_ / mass_;
  motion.center = origin_ + arm;
  motion.velocity = momentum_ / mass_;
  const Eigen::Matrix3d inertia = inertia_ - inertia_of(mass_, arm);
  motion.rate = inertia.inverse() * (angular_ - arm.cross(momentum_));
  return motion;
}

}  // namespace verlet_cable
