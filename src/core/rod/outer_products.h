#pragma once

#include "rod/pair.h"

namespace verlet_cable {

/// m + (a b^T + b a^T) / 2
inline PairSymmetric plus_both(const PairSymmetric& m, const PairVector& a, const PairVector& b) {
  const PairVector p = both(0.5) * a;
  return {m.xx + a.x * b.x, m.xy + (p.x * b.y + p.y * b.x), m.xz + (p.x * b.z + p.z * b.x),
          m.yy + a.y * b.y, m.yz + (p.y * b.z + p.z * b.y), m.zz + a.z * b.z};
}

}  // namespace verlet_cable
