#pragma once

#include <array>
#include <vector>

#include "verlet_cable/core/net.h"

namespace verlet_cable {

/// [m] How long a net's links are, for the sizes of what shows it.
double link_length(const NetModel& model);
/// [m] How thick its links are shown.
double link_width(const NetModel& model);

/// The two triangles of each cell of a grid, of its nodes; none of other nets.
std::vector<std::array<int, 3>> triangles_of(const NetModel& model);

}  // namespace verlet_cable
