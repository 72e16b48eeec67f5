#pragma once

#include "verlet_cable/core/bytes.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

inline void write_vector(const Vector3& vector, ByteWriter& bytes) {
  for (int axis = 0; axis < 3; ++axis) bytes(vector[axis]);
}

inline Vector3 read_vector(ByteReader& bytes) {
  Vector3 vector;
  for (int axis = 0; axis < 3; ++axis) bytes(vector[axis]);
  return vector;
}

inline void write_pose(const Pose& pose, ByteWriter& bytes) {
  write_vector(pose.position, bytes);
  for (int k = 0; k < 4; ++k) bytes(pose.orientation.coeffs()[k]);
}

inline Pose read_pose(ByteReader& bytes) {
  Pose pose;
  pose.position = read_vector(bytes);
  for (int k = 0; k < 4; ++k) bytes(pose.orientation.coeffs()[k]);
  return pose;
}

}  // namespace verlet_cable
