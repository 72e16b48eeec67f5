#pragma once

#include "geometry/lane_algebra.h"
#include "law/angle_energy.h"

namespace verlet_cable {

/// The bend between two directions of a cable that bends alike about all axes, over a substep: for one number or a lane of them.
/// With e the difference of the directions and u = |e|^2 / 2 = 1 - cos(angle), its energy is EI / l psi(u), psi = angle^2 / 2 as
/// in angle_energy.h, l being the length of cable that it stands for. To first order in u that is Bergou et al., A Quadratic
/// Bending Model for Inextensible Surfaces, 2006; the higher ones make the moment proportional to the angle.
template <class Real>
struct Bend {
  VectorOf<Real> moment;  ///< [N m] on the change of e: its work is the change of the energy where forces are those of the middle
  Real slope;             ///< [N m] of the moment over e where forces are taken
};

/// `stiffness`: EI / l [N m]; `start`: e at the start, `start_square` its square; `change`: of e over the substep; `part`: where
/// in the substep forces are taken, 1/2 or 1.
template <class Real>
[[gnu::always_inline]] inline Bend<Real> bend(Factor<Real> stiffness, const VectorOf<Real>& start, Factor<Real> start_square,
                                              const VectorOf<Real>& change, double part) {
  const VectorOf<Real> end = start + change;
  const Real slope = stiffness * mean_slope<Real>(0.5 * start_square, 0.5 * dot(end, end));
  return {slope * (start + (Real{} + part) * change), slope};
}

/// [J]
template <class Real>
[[gnu::always_inline]] inline Real bend_energy(Factor<Real> stiffness, const VectorOf<Real>& e) {
  return stiffness * angle_energy<Real>(0.5 * dot(e, e));
}

/// What damps a bend over a substep. The material of a cable turns e without bending: by `driven` as clamps turn it, and by a
/// share of `turned`, by which it turned by itself in the substep before. The share, from none to all and the same of the whole
/// cable, is that with which damping is least:
///   potential = min over share of sum of damping |change - driven - share turned|^2 / 2,
/// which is convex, and zero where only clamps turn the material, so that damping takes energy whatever the changes are.
template <class Real>
struct BendDamping {
  Real damping;  ///< [N m] over the length of cable and the time of the substep
  VectorOf<Real> driven, turned;

  /// [N m] On the change of e.
  [[gnu::always_inline]] VectorOf<Real> moment(const VectorOf<Real>& change, const Real& share) const {
    return damping * (change - driven - share * turned);
  }
  /// Sums that tell the share: see `turned_share`.
  [[gnu::always_inline]] Real along(const VectorOf<Real>& change) const { return damping * dot(change - driven, turned); }
  [[gnu::always_inline]] Real square() const { return damping * dot(turned, turned); }
  /// [J] That it takes in the substep; never negative in their sum.
  [[gnu::always_inline]] Real loss(const VectorOf<Real>& change, const Real& share) const {
    return dot(moment(change, share), change - driven);
  }
};

/// `along`, `square`: sums over all bends of the cable.
inline double turned_share(double along, double square) {
  if (!(along > 0)) return 0;
  return along < square ? along / square : 1;
}

/// What a bend at a node adds to the matrix, times the identity [N/m]: of the node before, its own, of the node after, between
/// the first and the second two, and between the first and the last.
template <class Real>
struct BendStiffness {
  Real before, own, after, first_before, first_after, second;
};

/// `slope`: derivative of the moment by the change of e [N m]; 1 / length of the segments before and after the node [1/m].
template <class Real>
[[gnu::always_inline]] inline BendStiffness<Real> bend_stiffness(const Real& slope, const Real& inverse_before,
                                                                 const Real& inverse_after) {
  const Real both = inverse_before + inverse_after, before = slope * inverse_before, after = slope * inverse_after;
  return {before * inverse_before, slope * both * both, after * inverse_after,
          -(before * both),        -(after * both),     before * inverse_after};
}

}  // namespace verlet_cable
