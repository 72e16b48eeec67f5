#pragma once

#include <array>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Before a guide and after it.
constexpr std::array<int, 2> both_sides{0, 1};

/// One side of a guide: the node that is held there, and the way along the cable away from it.
struct Side {
  int node = 0;
  int away = -1;  ///< or 1
  int segment() const { return away < 0 ? node - 1 : node; }
  int neighbour() const { return node + away; }
};

inline Side side_of(const Attachment& attachment, int side) {
  if (side == 0) return {attachment.node, -1};
  return {last_node(attachment), 1};
}

/// [m] At rest, from the start of a cable to the middle of what is in a guide.
inline double arc_length_at(const Attachment& attachment, const CableState& cable) {
  return cable.length(0, attachment.node) + 0.5 * cable.length(attachment.node, last_node(attachment));
}

/// Of a segment: nodes are taken in and given out no further from a guide than this.
constexpr double most_ahead = 0.6;

}  // namespace verlet_cable
