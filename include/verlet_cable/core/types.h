#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>

// Whatever multiplies quaternions is compiled once, in types.cpp: Eigen's templates for it would cost every file half a second.

namespace verlet_cable {

constexpr double infinity = std::numeric_limits<double>::infinity();

using Vector3 = Eigen::Vector3d;
using Quaternion = Eigen::Quaterniond;

/// A rigid pose: position [m] and orientation of a frame in its parent.
struct Pose {
  Vector3 position = Vector3::Zero();
  Quaternion orientation = Quaternion::Identity();

  /// The pose `child`, which is given in this pose's frame, in this pose's parent.
  Pose operator*(const Pose& child) const;
  Pose inverse() const;
};

/// The pose at a part of the way from one to another, 0 to 1: straight on, turning at one rate.
Pose between(const Pose& first, const Pose& last, double part);

/// Velocity of a frame relative to the fixed frame.
struct FrameVelocity {
  Vector3 linear = Vector3::Zero();   ///< [m/s] of its origin
  Vector3 angular = Vector3::Zero();  ///< [rad/s]
};

/// The rotation as axis times angle [rad], with an angle of at most pi.
Vector3 rotation_vector(const Quaternion& rotation);

/// Rotation of fixed-axis roll, pitch and yaw [rad], as in URDF: Rz(yaw) Ry(pitch) Rx(roll).
Quaternion quaternion_from_rpy(const Vector3& rpy);

}  // namespace verlet_cable
