#pragma once

#include <array>
#include <cstdint>

#include "packets/passes.h"

namespace verlet_cable::view {

/// The bytes of amounts of light in steps of 1 / `last_step_of_light` (IEC 61966-2-1).
extern const std::array<std::uint8_t, last_step_of_light + 1> bytes_of_light;

}  // namespace verlet_cable::view
