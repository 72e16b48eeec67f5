#pragma once

#include "geometry/lane_algebra.h"
#include "geometry/vector_array.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

inline VectorOf<double> numbers_of(const Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

inline VectorOf<double> numbers_at(const VectorArray& array, int i) {
  return {array.x[i], array.y[i], array.z[i]};
}

inline Vector3 vector_of(const VectorOf<double>& v) {
  return {v.x, v.y, v.z};
}

}  // namespace verlet_cable
