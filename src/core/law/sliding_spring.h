#pragma once

#include <cmath>

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// Bends of a joint about the material's y and z axes [rad], or moments about them [N m].
struct AboutAxes {
  double y = 0, z = 0;
};
inline AboutAxes operator+(const AboutAxes& a, const AboutAxes& b) {
  return {a.y + b.y, a.z + b.z};
}
inline AboutAxes operator-(const AboutAxes& a, const AboutAxes& b) {
  return {a.y - b.y, a.z - b.z};
}
inline AboutAxes operator*(double s, const AboutAxes& a) {
  return {s * a.y, s * a.z};
}
inline double dot(const AboutAxes& a, const AboutAxes& b) {
  return a.y * b.y + a.z * b.z;
}

/// What a spring that slides is bent by, its moments' derivative by the bend that it was tried with.
struct Slide {
  AboutAxes strain;               ///< [rad] of the spring, after it has slid
  double yy = 0, yz = 0, zz = 0;  ///< [N m / rad]
};

/// A spring that slides before it is bent by more than a limit (Prandtl's element; Masing, 1926; Iwan, 1967), about two axes:
/// what yields of a bend, beside what only stretches (kinematic hardening; Prager, 1956), and friction between strands.
///
/// Over a substep the strain e becomes that of the disc |e| <= limit which is nearest to e + change, by the spring's own energy
/// (closest point projection; Simo and Hughes, Computational Inelasticity, 1998, 3.3). The moment K (e + e') / 2, or K e' where
/// forces are taken at the end, is the derivative of a convex function of the change, an incremental potential; and as -e is in
/// the disc, too, the loss (e + e') . K slid / 2 is never negative.
struct SlidingSpring {
  double y_stiffness = 0, z_stiffness = 0;  ///< [N m / rad]; 0: there is none
  double limit = infinity;                  ///< [rad]
  AboutAxes slid;                           ///< [rad] at the start of the substep

  /// [N m]
  AboutAxes moment(const AboutAxes& strain) const { return {y_stiffness * strain.y, z_stiffness * strain.z}; }
  /// [J]
  double energy(const AboutAxes& strain) const { return 0.5 * dot(strain, moment(strain)); }
  /// `strain` [rad]: if it did not slide.
  Slide slide(const AboutAxes& strain) const;
};

inline Slide SlidingSpring::slide(const AboutAxes& strain) const {
  const double square = dot(strain, strain);
  if (!(y_stiffness > 0 && z_stiffness > 0 && square > limit * limit)) return {strain, y_stiffness, 0, z_stiffness};
  // The nearest place x on the disc's edge has K (x - strain) = -multiplier x. Newton's method on 1 / |x|, which comes from one
  // side, and for a spring that is alike about both axes is there at once (Moré and Sorensen, Computing a Trust Region Step,
  // 1983). In parts of the strain, and x times the softer axis' resistance, so that the smallest of limits has a place, too.
  constexpr int most_iterations = 60;
  constexpr double rounding = 1e-15;
  const double size = std::sqrt(square), part = limit / size;
  const AboutAxes resisted{y_stiffness * strain.y / size, z_stiffness * strain.z / size};
  const double softer = std::fmin(y_stiffness, z_stiffness);
  double resistance = softer, y_give = 0, z_give = 0, give = 0, length = 0;  // resistance: of the softer axis, and the multiplier
  AboutAxes along;
  for (int i = 0; i < most_iterations; ++i) {
    y_give = 1 / (1 + (y_stiffness - softer) / resistance);
    z_give = 1 / (1 + (z_stiffness - softer) / resistance);
    along = {y_give * resisted.y, z_give * resisted.z};
    give = y_give * along.y * along.y + z_give * along.z * along.z;
    length = std::sqrt(dot(along, along));
    const double step = length * length / give * (length / part - resistance);
    if (!(step > rounding * resistance)) break;
    resistance += step;
  }
  // Its derivative: as if it moved on with the strain, less what would leave the disc.
  const double y = y_stiffness * y_give, z = z_stiffness * z_give;
  const double along_y = y * along.y, along_z = z * along.z;
  Slide slide{(limit / length) * along};
  slide.yy = (y * y_stiffness - along_y * along_y / give) / resistance;
  slide.yz = -along_y * along_z / give / resistance;
  slide.zz = (z * z_stiffness - along_z * along_z / give) / resistance;
  return slide;
}

}  // namespace verlet_cable
