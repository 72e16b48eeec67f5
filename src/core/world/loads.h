#pragma once

#include "target/boundary.h"
#include "world/state.h"

namespace verlet_cable {

/// Whether loads from outside act on a cable.
bool is_loaded(int cable, const State& state);

/// Sets the loads of a boundary of a cable to those on its nodes.
void load_nodes(int cable, const State& state, Boundary& boundary);

/// After a load on a cable or body was changed. In the last of the substeps that damp unresolved motion what begins or ends
/// within it makes energy (see Scheme): the cables that are stepped together with what is loaded damp one more before it.
void put_off_last_damped(const BodyId& loaded, State& state);

// Where a node of a cable is to go while its material stays

/// Takes the loads off it, until they are put on the node that they go on with.
void take_off(int cable, int node, State& state);
/// Those of the cable that were taken off.
void put_on(int cable, int node, State& state);

}  // namespace verlet_cable
