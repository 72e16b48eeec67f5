#pragma once

#include <string>
#include <string_view>

#include "verlet_cable/core/world.h"
#include "world/state.h"

namespace verlet_cable {

/// All that the future depends on, after its hash, and those findings that are no events. `told_unsettled`: of
/// Findings::unsettled, those that a step has told.
std::string bytes_of(const State& state, const Findings& findings, std::size_t told_unsettled);

/// Makes `state`, which is that of a world with the same scene as the bytes are of, what `bytes_of` had. Meshes that it has are
/// kept; `findings` has what is saved of them, and nothing else. Throws std::invalid_argument with what is wrong with the bytes;
/// all of them are then of no use.
void restore(std::string_view bytes, State& state, Findings& findings, std::size_t& told_unsettled);

}  // namespace verlet_cable
