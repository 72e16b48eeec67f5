#pragma once

#include "verlet_cable/core/body.h"
#include "verlet_cable/core/body_desc.h"

namespace verlet_cable {

/// A body of a sound scene, whose frame has that index. Without a pose of its own it is at the fixed frame's.
SimulatedBody make_body(const BodyDesc& desc, int frame);

}  // namespace verlet_cable
