#pragma once

#include <string>
#include <vector>

#include "target/boundary.h"
#include "verlet_cable/core/cable.h"
#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// Of the material around a node, from the motion of the nodes next to it [rad/s].
Vector3 spin_at(const CableState& state, int node);

/// Lays loops where one junction holds two nodes of a cable and its shape leaves them apart, or where one that was not given and
/// that bends would be folded; then carries it to what holds it (`held`, without junctions). False if there were any.
bool close_loops(const std::vector<Attachment>& attachments, BodyId body, bool is_given, const std::vector<HeldNode>& held,
                 const Vector3& gravity, SimulatedCable& cable);

}  // namespace verlet_cable
