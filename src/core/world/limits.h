#pragma once

#include <string>
#include <vector>

#include "world/state.h"

namespace verlet_cable {

/// Of a section by something, in this step.
struct Squeeze {
  int segment = 0;
  double force = 0;  ///< [N/m]
  const std::string* other = nullptr;
};

/// Makes room for what is remembered of a cable's limits, if one of its materials has any.
void watch_limits(SimulatedCable& cable);

/// Adds where cables have come beyond their materials' limits in this step. All nodes beyond a limit that are next to each other,
/// or to where it was exceeded in the last tenth of a second, are of one excursion, which is told once, by its worst node.
/// `contacts`: of this step. `squeezes`: scratch.
void find_excursions(const std::vector<SimulatedContact>& contacts, State& state, std::vector<Squeeze>& squeezes,
                     std::vector<Excursion>& found);

}  // namespace verlet_cable
