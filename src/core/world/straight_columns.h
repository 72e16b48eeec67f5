#pragma once

#include "world/state.h"

namespace verlet_cable {

/// What is pushed together along an exactly straight line would stay on it, in an equilibrium that does not last. Spans between
/// holders get velocities aside: those that cannot shorten as soon as frames push them together, as large as their lengths ask for;
/// those that can when they carry more than their Euler load (Euler, De curvis elasticis, 1744), tiny ones, from which they buckle
/// by themselves. To be called when frames are at the end of the step.
void disturb_straight_columns(State& state);

}  // namespace verlet_cable
