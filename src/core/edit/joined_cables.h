#pragma once

#include <vector>

#include "verlet_cable/core/edit.h"
#include "world/state.h"

namespace verlet_cable {

inline bool gives_something(const edit::SetState::OfCable& of) {
  return of.positions || of.velocities;
}

/// The attachments by which a cable is joined at the junctions that it has placed, as the first of theirs, and that nothing but
/// cables holds: they go with it.
std::vector<int> joints_that_go_with(int cable, const State& state);

/// Cables that what is set takes along: joined at such a junction, and given no positions themselves.
std::vector<char> cables_that_follow(const std::vector<edit::SetState::OfCable>& set, const State& state);

/// In the order in which they were joined: what a junction goes with comes before what it holds.
std::vector<const edit::SetState::OfCable*> trunks_first(const std::vector<edit::SetState::OfCable>& set, const State& state);

}  // namespace verlet_cable
