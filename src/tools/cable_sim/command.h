#pragma once

#include <string>
#include <vector>

namespace verlet_cable::cable_sim {

/// The whole program: arguments after its name, exit status back. Reports to standard output and standard error.
int run(const std::vector<std::string>& arguments);

}  // namespace verlet_cable::cable_sim
