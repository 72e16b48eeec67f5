#pragma once

#include "binding/batch_world.h"

namespace verlet_cable {

/// Without the methods that it has of World.
BatchClass add_batch_class(pybind11::module_& module);

}  // namespace verlet_cable
