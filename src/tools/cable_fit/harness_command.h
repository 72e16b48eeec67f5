#pragma once

#include <string>
#include <vector>

#include "options.h"
#include "recording.h"

namespace verlet_cable::cable_fit {

/// Fits a harness as the command line says; the program's exit status. `errors`: what is wrong so far.
int run_harness(const Options& options, const std::vector<Recording>& recordings, std::vector<std::string> errors);

}  // namespace verlet_cable::cable_fit
