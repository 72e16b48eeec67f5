#pragma once

#include <cmath>

#include "verlet_cable/core/types.h"

namespace verlet_cable::bench {

/// Where the driven end of a cable of 1 m is, whose other end is held at the origin: 0.1 m to and fro along x at 1 Hz, from rest.
inline Vector3 driven_hand(double t) {
  constexpr double pi = 3.14159265358979323846;
  return {0.6 - 0.1 * std::cos(2 * pi * t), 0, 0};
}

}  // namespace verlet_cable::bench
