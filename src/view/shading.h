#pragma once

#include <cstdint>

#include "stage_implementation.h"

namespace verlet_cable::view {

/// Three bytes, as an image has them, of light in proportion.
void write_color(const Vector3& light, std::uint8_t* pixel);

/// The light from what is seen. `direction`: of the line of sight, unit; `is_lit`: the sun reaches it.
Vector3 light_from(const Stage::Implementation& stage, const Sighting& seen, const Vector3& direction, bool is_lit);

}  // namespace verlet_cable::view
