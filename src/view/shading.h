#pragma once

#include <array>
#include <cstdint>

#include "stage_implementation.h"

namespace verlet_cable::view {

/// As an image has it, of light in proportion.
std::array<std::uint8_t, 3> pixel_color(const Vector3& light);

/// The light from what is seen. `direction`: of the line of sight, unit; `is_lit`: the sun reaches it.
Vector3 light_from(const Stage::Implementation& stage, const Sighting& seen, const Vector3& direction, bool is_lit);

}  // namespace verlet_cable::view
