#pragma once

#include <string>

namespace verlet_cable::tools {

/// How much of a time [s] is done: "6 of 1667 min"
std::string progress_text(double done, double amount);
/// "35 min"
std::string duration_text(double seconds);

}  // namespace verlet_cable::tools
