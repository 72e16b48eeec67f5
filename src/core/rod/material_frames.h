#pragma once

#include <algorithm>
#include <vector>

#include "geometry/vector_array.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Carries a vector normal to `from` to one normal to `to`, by the smallest rotation that takes the one direction to the other.
inline Vector3 parallel_transport(const Vector3& normal, const Vector3& from, const Vector3& to) {
  return normal - normal.dot(to) / std::max(1 + from.dot(to), 1e-9) * (from + to);
}

/// Of 1 + cos(angle): a cable that is folded back on itself has no binormal.
constexpr double smallest_turn = 1e-6;

/// Curvature binormal of two directions: 2 tan(angle / 2), about the axis of the turn.
inline Vector3 curvature_binormal(const Vector3& before, const Vector3& after) {
  return 2 / std::max(1 + before.dot(after), smallest_turn) * before.cross(after);
}

/// Rotation vector of the small rotation from one orientation to another [rad].
Vector3 rotation_between(const Quaternion& from, const Quaternion& to);

/// The material's y axis on every segment (n), carried along the cable from its reference and turned by its twist. `segment`: n
/// [m].
void carry_directors(const CableState& state, const VectorArray& segment, VectorArray& director);

}  // namespace verlet_cable
