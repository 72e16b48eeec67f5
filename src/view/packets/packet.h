#pragma once

#include <cstdint>

namespace verlet_cable::view {

constexpr int side = 4;  // of the squares of pixels whose rays are followed together
constexpr int rays = side * side;

/// A number of each ray of a square.
struct alignas(64) Lanes {
  double values[rays];

  double& operator[](int i) { return values[i]; }
  double operator[](int i) const { return values[i]; }
};

/// A vector of each ray, in the fixed frame.
struct VectorLanes {
  Lanes x, y, z;
};

/// A round line of each ray, from the eye: neighbours often see different segments of a cable.
struct LineLanes {
  VectorLanes start, axis;  ///< [m]
  Lanes radius;             ///< [m] 0 where something else is seen
};

/// Which rays of a square see one of its surfaces: those whose number in `of_ray` is `index`. What passes find of a surface they
/// write for these only.
struct Viewers {
  const std::int64_t* of_ray;
  std::int64_t index;

  bool has(int i) const { return of_ray[i] == index; }
};

}  // namespace verlet_cable::view
