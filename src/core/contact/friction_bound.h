#pragma once

#include <vector>

#include "contact/law.h"
#include "verlet_cable/core/cable.h"

namespace verlet_cable {

/// Bounds the friction of nodes that touch, from the `first` touch on, of one cable and obstacle, by the turn of the cable there.
/// `flat`: the obstacle is a plane, which has no edge to lean on where a cable is held behind it.
void bound_friction_of_nodes(const CableState& state, std::size_t first, bool flat, std::vector<Touch>& touches);

/// The same where segments touch, too: from the cable's direction before what touches to that behind. What touches at one corner
/// has the whole turn in common, and forces of one direction; other neighbours at a node share its turn in the ratio of their
/// last forces on it. `feet` [m]: on the obstacle's surface, one a touch; `pressed`: scratch.
void bound_friction_at_corners(const CableState& state, std::size_t first, const std::vector<Vector3>& feet,
                               std::vector<Touch>& touches, std::vector<std::size_t>& pressed);

}  // namespace verlet_cable
