#pragma once

#include <vector>

#include "solve/surroundings.h"
#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Lays a cable down from what holds it: from each holder it goes down where nothing stands, along what does, and the part that
/// is left goes straight to the next holder. It goes through nothing, as long as it can. [m] A node, segments at rest length.
/// `held` ascends, at least one; `down`: unit.
std::vector<Vector3> laid_shape(const CableState& state, const std::vector<HeldNode>& held, const Vector3& down,
                                const Surroundings& surroundings);

/// Where a cable comes to rest among what stands there, without friction, from the shape that it has: the minimum of its
/// potential. Segments stretch by 1e-4 under the cable's weight, surfaces yield to that by 0.1 radii; bending is that of a
/// straight round cable. Newton's method on a convex model, bounded by inertia, its steps by what they lose and so that nothing
/// goes through a surface. As near as a bounded number of iterations leads; false if it finds no way on, as inside of something.
/// `gravity` [m/s^2], not zero.
bool rest_on(const SimulatedCable& cable, const Boundary& boundary, const Vector3& gravity, const Surroundings& surroundings,
             std::vector<Vector3>& positions);

}  // namespace verlet_cable
