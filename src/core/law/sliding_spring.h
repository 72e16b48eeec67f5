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
  // 1983).
  constexpr int most_iterations = 60;
  constexpr double rounding = 1e-15;
  double multiplier = 0, y_give = 0, z_give = 0, give = 0;
  AboutAxes nearest;
  for (int i = 0; i < most_iterations; ++i) {
    y_give = 1 / (y_stiffness + multiplier);
    z_give = 1 / (z_stiffness + multiplier);
    nearest = {y_stiffness * y_give * strain.y, z_stiffness * z_give * strain.z};
    give = y_give * nearest.y * nearest.y + z_give * nearest.z * nearest.z;
    const double size_square = dot(nearest, nearest);
    const double step = size_square / give * (std::sqrt(size_square) / limit - 1);
    if (!(step > rounding * (multiplier + std::fmin(y_stiffness, z_stiffness)))) break;
    multiplier += step;
  }
  // Its derivative: as if it moved on with the strain, less what would leave the disc.
  const double y = y_stiffness * y_give, z = z_stiffness * z_give;
  const double along_y = y * nearest.y, along_z = z * nearest.z;
  Slide slide{(limit / std::sqrt(dot(nearest, nearest))) * nearest};
  slide.yy = y * y_stiffness - along_y * along_y / give;
  slide.yz = -along_y * along_z / give;
  slide.zz = z * z_stiffness - along_z * along_z / give;
  return slide;
}

}  // namespace verlet_cable
