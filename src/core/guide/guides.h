#pragma once

#include <vector>

#include "world/state.h"

namespace verlet_cable {

/// Gives a cable that starts, whose `state` has its lengths and masses, the guides that hold material of it at first: nodes are
/// where that is. Adds guides and attachments to the world's; indices of the attachments to `own`. `later`: attachments that will
/// be added to the world's once the cable has started.
void add_guides(const CableDesc& desc, int cable, const FrameIds& ids, const CableModel& model, CableState& cable_state,
                State& state, std::vector<int>& own, std::vector<Attachment>& later);

/// The attachment by which a guide, whose index is given, holds a cable; of what holds the guide, see Attachment::holder.
Attachment hold_by(const SimulatedGuide& guide, int index, int cable, int holder);

/// What flows through a guide stands, and nothing is left that drives it.
void stop_flow(SimulatedGuide& guide);

/// What flows through a cable's guides stands, and nothing is left that drives it.
void stop_flows(int cable, State& state);

/// Whether a segment of a cable lies on the wheel of a guide.
bool lies_on_wheel(const State& state, int cable, int segment);

/// [J] Of what flows through the guides of a cable, with their wheels, besides what the guides' nodes have.
double flow_energy(const State& state, int cable);

}  // namespace verlet_cable
