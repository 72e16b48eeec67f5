#pragma once

#include "verlet_cable/core/body.h"
#include "verlet_cable/core/body_desc.h"

namespace verlet_cable {

/// A body of a sound scene; it has no frame yet. Without a pose of its own it is at the fixed frame's.
SimulatedBody make_body(const BodyDesc& desc);

}  // namespace verlet_cable
