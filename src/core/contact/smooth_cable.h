#pragma once

#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// [radii] By no more than this a smooth cable is taken to bulge out between two nodes: over what has edges, and over what is
/// round or another cable. A cable that is bent sharply in a node is no arc.
constexpr double largest_bulge = 0.08, largest_arc = 0.25;

/// [m] From the middle of a segment to the arc of a smooth cable through the nodes, by how the cable turns from the segment
/// before to the one after. Straight segments would mesh like the teeth of gears where wound layers press on each other.
Vector3 arc_height(const CableState& state, int segment);

/// [m] By how much the arc is ahead of the straight segment along a normal, at a fraction of it; `radius` [m]: of the cable.
double bulge_along(const Vector3& normal, const CableState& state, int segment, double fraction, double radius);

}  // namespace verlet_cable
