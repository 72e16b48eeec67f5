#pragma once

#include <pybind11/pybind11.h>

#include "simulation/driven_world.h"
#include "simulation/event_record.h"

namespace verlet_cable {

/// What Python calls a World.
struct PythonWorld {
  DrivenWorld driven;
  EventRecord events;
  bool busy = false;  ///< in use by a thread that has let others run

  explicit PythonWorld(DrivenWorld world, EventRecord record = {}) : driven(std::move(world)), events(std::move(record)) {}
};

void add_world_class(pybind11::module_& module);

}  // namespace verlet_cable
