#pragma once

#include "sensitivity/plain_equations.h"
#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// A number times a vector.
inline ColumnVector times(double a, const ColumnVector& v) {
  return {a * v.x, a * v.y, a * v.z};
}

inline void add_slope(int k, const Vector3& slope, ColumnVector& v) {
  v.x.slope[k] += slope.x();
  v.y.slope[k] += slope.y();
  v.z.slope[k] += slope.z();
}

/// As the function of this name of numbers.
inline Column losing_share(const Column& known, const Column& along, const Column& square) {
  if (known.value + along.value >= square.value) return 1;
  const Column inside = along * along + 4 * square * known;
  if (inside.value <= 0) return 0;
  const Column both = root(inside);
  return along.value < 0 ? 2 * known / (both - along) : (along + both) / (2 * square);
}

inline bool damps_bending(const MaterialDesc& material) {
  return material.bending_damping > 0;
}
inline bool bends(const MaterialDesc& material) {
  return material.bending_stiffness.largest() > 0 || damps_bending(material);
}
inline bool stretches(const MaterialDesc& material) {
  return material.axial_stiffness < infinity;
}

}  // namespace verlet_cable
