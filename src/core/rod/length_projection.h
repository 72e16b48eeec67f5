#pragma once

#include <vector>

#include "target/boundary.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Moves the free nodes as little as possible (by mass) until every segment of an inextensible cable has the length that its
/// holders allow; held nodes are put where they are held. Elastic cables: only the held nodes move. False if no such shape was
/// found from here; the positions are then finite, but of other lengths.
bool project_positions(const CableModel& model, const std::vector<HeldNode>& held, CableState& state);

/// Takes away the velocities along the segments of an inextensible cable by impulses of the segments; held nodes have the
/// velocities of their holders.
void project_velocities(const CableModel& model, const std::vector<HeldNode>& held, CableState& state);

/// The same where material flows through guides and rest lengths change: what flows is moved by the impulses, too, if nothing
/// holds it; segments that grow do so on.
void project_velocities(const CableModel& model, Boundary& boundary, CableState& state);

/// Moves the nodes that are not held, each the less the heavier it is, until the segments have the lengths [m], one a segment.
/// False if that was not reached.
bool project_lengths(const std::vector<HeldNode>& held, const std::vector<double>& lengths, CableState& state);

}  // namespace verlet_cable
