#pragma once

#include <vector>

#include "world/state.h"

namespace verlet_cable {

/// Makes room for what is remembered of a cable's limits, if one of its materials has any.
void watch_limits(SimulatedCable& cable);

/// Adds where cables have come beyond their materials' limits in this step. All nodes beyond a limit that are next to each other,
/// or to where it was exceeded in the last tenth of a second, are of one excursion, which is told once, by its worst node.
void find_excursions(State& state, std::vector<Excursion>& found);

}  // namespace verlet_cable
