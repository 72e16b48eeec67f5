#pragma once

#include "geometry/lane_algebra.h"

namespace verlet_cable {

/// Drag in proportion to the velocity against a fluid (material `drag`), of a node over a substep: for one number or a lane.
template <class Real>
struct LinearDrag {
  Real coefficient;      ///< [kg/s] the material's, times the length of cable
  VectorOf<Real> fluid;  ///< [m/s] its velocity
  double rate;           ///< [1/s] of displacement to velocity; 0 in statics

  /// [N] On a node that does not move.
  [[gnu::always_inline]] VectorOf<Real> load() const { return coefficient * fluid; }
  /// [N/m] By which a displacement lessens it.
  [[gnu::always_inline]] Real resistance() const { return rate * coefficient; }
  /// [J] That it takes in the substep from cable and fluid, for a displacement of `u` [m]; never negative.
  [[gnu::always_inline]] Real loss(const VectorOf<Real>& u) const { return coefficient / rate * dot(relative(u), relative(u)); }
  /// [J] Work of the fluid's motion.
  [[gnu::always_inline]] Real work(const VectorOf<Real>& u) const { return -(coefficient / rate * dot(relative(u), fluid)); }

 private:
  [[gnu::always_inline]] VectorOf<Real> relative(const VectorOf<Real>& u) const { return (Real{} + rate) * u - fluid; }
};

}  // namespace verlet_cable
