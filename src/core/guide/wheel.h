#pragma once

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Where a cable comes to a wheel (`side` 0) or leaves it (1), in the wheel's axes [m]: there the straight line from or to
/// `neighbour` touches the circle. Of a neighbour inside the circle it is the direction of `near`.
Vector3 tangent_point(const Pose& wheel, const SimulatedGuide& guide, int side, const Vector3& neighbour, const Vector3& near);

/// [kg] That a wheel adds to the cable that moves with it.
inline double mass_on_rim(const SimulatedGuide& guide) {
  return guide.inertia / (guide.radius * guide.radius);
}

/// [m] of the circle, between the tangent points.
double arc_on_wheel(const SimulatedGuide& guide, const Attachment& attachment);

}  // namespace verlet_cable
