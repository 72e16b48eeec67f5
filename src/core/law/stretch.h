#pragma once

#include "geometry/lane_algebra.h"

namespace verlet_cable {

/// A segment's row of the linear system (see KktSystem): direction . (change of d) - compliance * (change of density) = gap, d
/// being the segment, density its multiplier 2 T / (s + s') [N/m], s and s' its lengths at the start and the end of a substep.
/// For one number or a lane of them.
template <class Real>
struct LengthRow {
  Real gap;         ///< [m^2]
  Real compliance;  ///< [m^3/N]
};

/// What does not stretch, but for a `compliance` that makes its tension unique where it is held at both ends.
/// `square`: of its length at the end [m^2]; `length` [m]: that it is to have.
template <class Real>
[[gnu::always_inline]] inline LengthRow<Real> inextensible_row(const Real& square, const Real& length, const Real& compliance,
                                                               const Real& density) {
  return {0.5 * (length * length - square) + compliance * density, compliance};
}

/// [m^3/N] Of a segment of a `length` [m] whose axial stiffness is as large as a `stiffness` [N].
inline double taut_compliance(double length, double stiffness) {
  return length * length * length / stiffness;
}

/// [J] That it stores then.
inline double taut_energy(double compliance, double density) {
  return 0.5 * compliance * density * density;
}

/// [J] That its tension takes in as the square of its length [m^2] grows.
inline double work_of_length(double density, double start_square, double end_square) {
  return 0.5 * density * (end_square - start_square);
}

/// What stretches with a `tension` [N] that rises by `rise` [N/m] with the length at the end. `mean` [m]: the length where forces
/// are taken, at `part` of the substep (1/2 or 1); `end` [m]: that at the end. Its density times the mean is to be the tension.
template <class Real>
[[gnu::always_inline]] inline LengthRow<Real> elastic_row(const Real& tension, const Real& rise, const Real& density,
                                                          const Real& mean, const Real& end, double part) {
  const Real by_slope = end / (rise - part * density);
  return {(density * mean - tension) * by_slope, mean * by_slope};
}

}  // namespace verlet_cable
