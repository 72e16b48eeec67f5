#pragma once

#include <vector>

#include "world/state.h"

namespace verlet_cable {

/// Gives a cable that starts, whose `state` has its lengths and masses, the guides that hold material of it at first: nodes are
/// where that is. Adds guides and attachments to the world's; indices of the attachments to `own`.
void add_guides(const CableDesc& desc, int cable, const FrameIds& ids, const CableModel& model, CableState& cable_state,
                State& state, std::vector<int>& own);

/// What flows through a cable's guides stands.
void stop_flows(int cable, State& state);

/// [J] Of what flows, with its wheels, besides what the guides' nodes have.
double flow_energy(const State& state);

}  // namespace verlet_cable
