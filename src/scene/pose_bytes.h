#pragma once

#include <cmath>
#include <stdexcept>

#include "verlet_cable/core/bytes.h"
#include "verlet_cable/core/types.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

inline void write_vector(const Vector3& vector, ByteWriter& bytes) {
  for (int axis = 0; axis < 3; ++axis) bytes(vector[axis]);
}

/// Throws std::invalid_argument where it is not finite.
inline Vector3 read_vector(ByteReader& bytes) {
  Vector3 vector;
  for (int axis = 0; axis < 3; ++axis) bytes(vector[axis]);
  if (!vector.allFinite()) throw std::invalid_argument("a vector is not finite");
  return vector;
}

inline void write_pose(const Pose& pose, ByteWriter& bytes) {
  write_vector(pose.position, bytes);
  for (int k = 0; k < 4; ++k) bytes(pose.orientation.coeffs()[k]);
}

/// Throws std::invalid_argument where it cannot be used (`is_sound`), or its orientation is no rotation.
inline Pose read_pose(ByteReader& bytes) {
  constexpr double tolerance = 1e-6;
  Pose pose;
  pose.position = read_vector(bytes);
  for (int k = 0; k < 4; ++k) bytes(pose.orientation.coeffs()[k]);
  if (!is_sound(pose)) throw std::invalid_argument("a pose is out of range");
  if (!(std::abs(pose.orientation.norm() - 1) <= tolerance)) throw std::invalid_argument("an orientation is no rotation");
  return pose;
}

}  // namespace verlet_cable
