#include "verlet_cable/core/rotation.h"

namespace verlet_cable {

Quaternion smallest_rotation(const Vector3& from, const Vector3& to) {
  return Quaternion::FromTwoVectors(from, to);
}

}  // namespace verlet_cable
