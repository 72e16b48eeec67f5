#pragma once

#include "binding/world_class.h"

namespace verlet_cable {

/// Adds what gives derivatives to World.
void add_sensitivity_methods(pybind11::class_<PythonWorld>& world);

}  // namespace verlet_cable
