#include "rod/rigid_motion.h"

#include <Eigen/LU>
#include <numeric>

namespace verlet_cable {

namespace {

/// Of the inertia, relative: straight chains have none about themselves.
constexpr double regularisation = 1e-12;

}  // namespace

Vector3 center_of_mass(const std::vector<double>& masses, const VectorArray& places) {
  Vector3 sum = Vector3::Zero();
  for (int i = 0; i < static_cast<int>(masses.size()); ++i) sum += masses[i] * get(places, i);
  return sum / std::accumulate(masses.begin(), masses.end(), 0.0);
}

RigidMotion rigid_motion(const std::vector<double>& masses, const VectorArray& places, const Vector3& momentum,
                         const Vector3& angular_momentum) {
  RigidMotion motion;
  motion.center = center_of_mass(masses, places);
  motion.velocity = momentum / std::accumulate(masses.begin(), masses.end(), 0.0);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  for (int i = 0; i < static_cast<int>(masses.size()); ++i) {
    const Vector3 arm = get(places, i) - motion.center;
    inertia += masses[i] * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  inertia += regularisation * inertia.trace() * Eigen::Matrix3d::Identity();
  motion.rate = inertia.inverse() * angular_momentum;
  return motion;
}

}  // namespace verlet_cable
