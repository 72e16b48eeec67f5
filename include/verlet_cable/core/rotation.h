#pragma once

#include "verlet_cable/core/types.h"

namespace verlet_cable {

/// The smallest rotation that takes the direction of `from` to that of `to`; about any axis where they are opposite. Compiled
/// once: behind it is a singular value decomposition, which takes seconds to compile wherever it is written.
Quaternion smallest_rotation(const Vector3& from, const Vector3& to);

}  // namespace verlet_cable
