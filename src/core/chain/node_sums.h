#pragma once

#include <vector>

#include "geometry/vector_array.h"

namespace verlet_cable {

/// Adds the first `count` elements of a list to those of another one.
inline void add(const std::vector<double>& more, int count, std::vector<double>& sum) {
  const double* from = more.data();
  double* to = sum.data();
#pragma GCC ivdep
  for (int i = 0; i < count; ++i) to[i] += from[i];
}

/// Of the first `count` elements of two lists.
inline double dot(const std::vector<double>& a, const std::vector<double>& b, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

/// Likewise of vectors: of all x, then of all y, then of all z.
inline double dot(const VectorArray& a, const VectorArray& b, int count) {
  double sum = 0;
  for (auto component : {&VectorArray::x, &VectorArray::y, &VectorArray::z})
    for (int i = 0; i < count; ++i) sum += (a.*component)[i] * (b.*component)[i];
  return sum;
}

}  // namespace verlet_cable
