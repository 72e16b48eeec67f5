#pragma once

#include <string>
#include <string_view>

#include "world/state.h"

namespace verlet_cable {

/// All that the future depends on, after its hash.
std::string bytes_of(const State& state);

/// Makes `state`, which is that of a world with the same scene as the bytes are of, what `bytes_of` had. Meshes that it has are
/// kept. Throws std::invalid_argument with what is wrong with the bytes; the state is then of no use.
void restore(std::string_view bytes, State& state);

}  // namespace verlet_cable
