#pragma once

#include "geometry/lane_algebra.h"

namespace verlet_cable {

/// A spring and a dashpot side by side (Kelvin and Voigt), over a substep: the law of stretch, of twist and of a bend about one
/// axis, for one number or a lane of them. A strain is a length [m], an angle [rad], or one of these over the element's length; a
/// stress is what does work on it.
template <class Real>
struct Resistance {
  Real stiffness;  ///< [N/m, N m] EA / l, GJ / l, EI / l of an element; of strains over its length l: EA l, GJ l
  Real damping;    ///< [N/m, N m] likewise, over the time of the substep

  /// `strain`: where forces are taken; `change`: over the substep.
  [[gnu::always_inline]] Real stress(const Real& strain, const Real& change) const {
    return stiffness * strain + damping * change;
  }
  /// The derivative of the stress by the strain at the end. `part`: where in the substep forces are taken, 1/2 or 1.
  [[gnu::always_inline]] Real slope(double part) const { return part * stiffness + damping; }
  /// [J]
  [[gnu::always_inline]] Real energy(const Real& strain) const { return 0.5 * stiffness * strain * strain; }
  /// [J] That damping takes in the substep; never negative.
  [[gnu::always_inline]] Real loss(const Real& change) const { return damping * change * change; }
};

}  // namespace verlet_cable
