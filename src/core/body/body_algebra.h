#pragma once

#include <Eigen/Core>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The skew matrix of a cross product with v on the left.
inline Eigen::Matrix3d cross_matrix(const Vector3& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

/// By what the torque of a force that stays as it is changes as its arm turns.
inline Eigen::Matrix3d turned_torque(const Vector3& arm, const Vector3& force) {
  return arm * force.transpose() - arm.dot(force) * Eigen::Matrix3d::Identity();
}

}  // namespace verlet_cable
