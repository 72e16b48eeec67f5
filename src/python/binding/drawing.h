#pragma once

#include "binding/arguments.h"

namespace verlet_cable {

/// What src/python/verlet_cable/drawing.py draws: where everything is, as arrays, in colors that tell cables and nets apart.
py::dict drawn_shapes(const World& world);

}  // namespace verlet_cable
