#pragma once

#include "verlet_cable/core/net.h"

namespace verlet_cable {

/// A net of a sound description, at rest where it was put.
SimulatedNet make_net(const NetDesc& desc);

}  // namespace verlet_cable
