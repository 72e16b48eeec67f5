#pragma once

#include "lanes/records.h"
#include "law/bend.h"

namespace verlet_cable {
// Without linkage: what is compiled for one processor is not to be used for another.
namespace {

/// How much of the change of directions goes along what turns with the material: see BendDamping.
template <class Real>
void turn_lanes(const LaneWork& w) {
  const int m = w.lane;
  const Real zero{};
  const VectorOf<Real> none{zero, zero, zero};
  const VectorOf<Real> beyond_middle = crossed_over(place_of<Real>(w, m).vector(LaneField::displacement_x));
  Real along = zero;
  VectorOf<Real> u = place_of<Real>(w, 0).vector(LaneField::displacement_x), before = none;
  for (int k = 0; k <= m; ++k) {
    const Place<Real> at = place_of<Real>(w, k);
    const VectorOf<Real> next = k < m ? place_of<Real>(w, k + 1).vector(LaneField::displacement_x) : beyond_middle;
    const VectorOf<Real> turned_on = at[LaneField::inverse_length] * without_pad(w, k, next - u);
    if (k > 0) {
      const BendDamping<Real> damper{at[LaneField::joint_damping], at.vector(LaneField::driven_x),
                                     at.vector(LaneField::turned_x)};
      along = along + damper.along(turned_on - before);
    }
    u = next;
    before = turned_on;
  }
  set_values(along, w.values->along);
}

}  // namespace
}  // namespace verlet_cable
