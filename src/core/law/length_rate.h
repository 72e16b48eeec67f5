#pragma once

#include "geometry/lane_algebra.h"

namespace verlet_cable {

/// Rows of the tridiagonal system whose solution are the impulses over length [kg/s] along segments that end all change of their
/// lengths: J W J^T impulse = J v, with W the nodes' inverse masses. For one number or a lane of them.
/// Relative, added to the diagonal for spans that are pulled straight.
constexpr double length_rate_regularisation = 1e-9;

/// `square`: of the segment's length [m^2]; `mobility`: sum of the inverse masses of its nodes [1/kg].
template <class Real>
[[gnu::always_inline]] inline Real length_rate_diagonal(const Real& square, const Real& mobility,
                                                        double regularisation = length_rate_regularisation) {
  return square * mobility * (1 + regularisation);
}

/// To the next segment's row. `product`: d . d_next [m^2]; `mobility`: inverse mass of the node between them [1/kg].
template <class Real>
[[gnu::always_inline]] inline Real length_rate_coupling(const Real& product, const Real& mobility) {
  return -mobility * product;
}

}  // namespace verlet_cable
