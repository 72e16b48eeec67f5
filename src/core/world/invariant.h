#pragma once

#include <string>

#include "world/state.h"

namespace verlet_cable {

/// What every edit leaves as it should be: arrays of nodes and of segments are as long as the cable, or empty where they may be;
/// a cable has frames where, and only where, is_whole_rod() says so; whatever is named by an index is there. Returns the first
/// violation, with the name of the cable or attachment; empty if there is none.
std::string violation(const State& state);

/// An assertion that says what is violated: a bug of ours.
void assert_no_violation(const State& state);

}  // namespace verlet_cable
