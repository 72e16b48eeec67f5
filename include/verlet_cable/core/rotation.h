#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The smallest rotation that takes the direction of `from` to that of `to`; about any normal axis if they are opposite. Compiled
/// only once, because it contains a singular value decomposition, which takes seconds to compile.
Quaternion smallest_rotation(const Vector3& from, const Vector3& to);

}  // namespace verlet_cable
