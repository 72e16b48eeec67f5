#pragma once

#include <pybind11/pybind11.h>

#include "simulation/driven_world.h"

namespace verlet_cable {

/// What Python calls a World.
struct PythonWorld {
  DrivenWorld driven;
  bool busy = false;  ///< in use by a thread that has let others run

  explicit PythonWorld(DrivenWorld world) : driven(std::move(world)) {}
};

void add_world_class(pybind11::module_& module);

}  // namespace verlet_cable
