#pragma once

#include "world/state.h"

namespace verlet_cable {

/// A node that has been given out on a side of a guide, on a cable that bends, is put where the cable has an energy but for its
/// motion [J]; if that is nowhere near, where it differs least. Lengths that were lost where nodes were taken in are there again,
/// in the direction `bulge`, and the strain stays.
void place_given_node(int cable, const Attachment& guide, int side, const Vector3& bulge, double energy, State& state);

/// Nodes that were given out, or taken in, have bent a cable at once: it yields to that, but where a wheel bends it.
void yield_to_given_nodes(int cable, State& state);

}  // namespace verlet_cable
