#pragma once

#include <algorithm>

#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// [m] Past a node, from the one before it to the one after it; an end has one beside it.
inline Vector3 way_past(const CableState& state, int node) {
  return state.positions[std::min(node + 1, state.segments())] - state.positions[std::max(node - 1, 0)];
}

/// Of a segment, a unit vector.
inline Vector3 segment_direction(const CableState& state, int segment) {
  return (state.positions[segment + 1] - state.positions[segment]).normalized();
}

}  // namespace verlet_cable
