#pragma once

#include <cstddef>
#include <vector>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Three component arrays of one vector quantity.
struct VectorArray {
  std::vector<double> x, y, z;

  void assign(std::size_t count, double value) {
    x.assign(count, value);
    y.assign(count, value);
    z.assign(count, value);
  }
};

inline void set(VectorArray& array, int i, const Vector3& v) {
  array.x[i] = v.x();
  array.y[i] = v.y();
  array.z[i] = v.z();
}

inline Vector3 get(const VectorArray& array, int i) {
  return {array.x[i], array.y[i], array.z[i]};
}

}  // namespace verlet_cable
