#pragma once

#include <string>
#include <vector>

#include "options.h"

namespace verlet_cable::cable_fit {

/// Fits a cable of a scene to clouds of points. `errors`: those found so far. Returns the exit status.
int run_clouds(const Options& options, std::vector<std::string> errors);

}  // namespace verlet_cable::cable_fit
