#pragma once

#include <pybind11/pybind11.h>

namespace verlet_cable {

void add_batch_class(pybind11::module_& module);

}  // namespace verlet_cable
