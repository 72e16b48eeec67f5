#pragma once

#include "geometry/lane_algebra.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

inline VectorOf<double> numbers_of(const Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

inline Vector3 vector_of(const VectorOf<double>& v) {
  return {v.x, v.y, v.z};
}

}  // namespace verlet_cable
