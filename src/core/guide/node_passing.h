#pragma once

#include "target/boundary.h"
#include "world/state.h"

namespace verlet_cable {

/// Whether a node carries more than its segments and what a cut left on an end weigh.
bool carries_payload(const SimulatedCable& cable, int node);

/// Whether an attachment or a guide holds a node; a wheel holds two.
bool is_attached(const State& state, int cable, int node);

/// Calls follow(node) for the nodes of a cable that attachments and targets hold, and that loads act on.
template <class Follow>
void renumber_held(int cable, const Follow& follow, State& state) {
  for (Attachment& a : state.attachments)
    if (a.body == cable_id(cable)) follow(a.node);
  for (Load& load : state.loads)
    if (load.body == cable_id(cable)) follow(load.node);
  for (KinematicTarget& h : state.cable_progress[cable].targets.nodes) follow(h.node);
  for (DirectionTarget& h : state.cable_progress[cable].targets.directions) follow(h.node);
}

/// Whether a node may be taken in: nothing holds it, and nothing hangs on it.
bool is_passable(const State& state, int cable, int node);

/// Whether a free end of the cable comes to a guide and is about to leave it.
bool runs_out(const Attachment& guide, const State& state);

/// Sets the flows of a boundary of a cable to what they are now; their places. What does not pass stops near the guide; so does a
/// free end, unless the cable `moves`: then it runs out.
void load_flows(int cable, bool moves, const State& state, Boundary& boundary);
int count_flows(int cable, const State& state);
/// Takes over what a substep has found of them.
void keep_flows(int cable, const Boundary& boundary, State& state);

/// Takes nodes that have come near a guide in, and gives them out on the other side: the segments beside a guide stay about as
/// long as the others. Mass, momentum and tensions stay. Targets and attachments follow. Where the cable `moves` its energy
/// stays, too: a node is given out where that is as before, and what still differs the guide holds. Loads go on with the
/// material. Whether there were any.
bool pass_nodes(int cable, bool moves, State& state);

/// What a cable has gained [J] as velocities were mended after nodes have passed, their guides take back, too.
void hold_gain(int cable, double gain, State& state);

/// What a new pin does to a cable that slides through guides: its velocities change by an impact, which no finite friction
/// withstands. Otherwise a span that is pulled straight would go on flowing between holders.
void stop_at_pin(int pin, State& state);

/// Makes the velocities of a cable those of its holders there, its lengths kept but for what flows through guides and what is
/// wound.
void move_with_holders(int cable, State& state);

}  // namespace verlet_cable
