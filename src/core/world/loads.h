#pragma once

#include "target/boundary.h"
#include "world/state.h"

namespace verlet_cable {

/// Whether loads from outside act on a cable.
bool is_loaded(int cable, const State& state);

/// Sets the loads of a boundary of a cable to those on its nodes.
void load_nodes(int cable, const State& state, Boundary& boundary);

// Where a node of a cable is to go while its material stays

/// Takes the loads off it, until they are put on the node that they go on with.
void take_off(int cable, int node, State& state);
/// Those of the cable that were taken off.
void put_on(int cable, int node, State& state);

}  // namespace verlet_cable
