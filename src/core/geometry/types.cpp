#include "verlet_cable/core/types.h"

namespace verlet_cable {

Pose Pose::operator*(const Pose& child) const {
  return {position + orientation * child.position, (orientation * child.orientation).normalized()};
}

Pose between(const Pose& first, const Pose& last, double part) {
  return {first.position + part * (last.position - first.position), first.orientation.slerp(part, last.orientation)};
}

Pose Pose::inverse() const {
  const Quaternion back = orientation.conjugate();
  return {-(back * position), back};
}

Vector3 rotation_vector(const Quaternion& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Quaternion quaternion_from_rpy(const Vector3& rpy) {
  return Eigen::AngleAxisd(rpy.z(), Vector3::UnitZ()) * Eigen::AngleAxisd(rpy.y(), Vector3::UnitY()) *
         Eigen::AngleAxisd(rpy.x(), Vector3::UnitX());
}

}  // namespace verlet_cable
