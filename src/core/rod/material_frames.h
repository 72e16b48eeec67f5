#pragma once

#include <vector>

#include "geometry/vector_array.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Carries a vector normal to `from` to one normal to `to`, by the smallest rotation that takes the one direction to the other.
inline Vector3 parallel_transport(const Vector3& normal, const Vector3& from, const Vector3& to) {
  return normal - normal.dot(to) / std::max(1 + from.dot(to), 1e-9) * (from + to);
}

/// The material's y axis on every segment (n), carried along the cable from its reference and turned by its twist. `segment`: n
/// [m].
void carry_directors(const CableState& state, const VectorArray& segment, VectorArray& director);

}  // namespace verlet_cable
