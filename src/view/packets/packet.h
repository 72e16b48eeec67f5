#pragma once

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

/// Surfaces that rays meet, each another one.
struct FlatLanes {
  VectorLanes normal;  ///< unit
  Lanes height;        ///< [m] of the plane above the eye, along the normal
};
struct RoundLanes {
  VectorLanes start;  ///< [m] of the line's start, from the eye
  VectorLanes axis;   ///< [m] from there to its end
  Lanes radius;       ///< [m]
};

/// What the light is computed of.
struct LightLanes {
  VectorLanes color, second_color;  ///< of the paint, in proportion to light
  Lanes second;                     ///< 0 to 1: how much of the second one there is
  Lanes shininess;
  Lanes is_lit;  ///< 1: the sun reaches it, 0: it does not
};

}  // namespace verlet_cable::view
