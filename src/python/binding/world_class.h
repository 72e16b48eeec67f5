#pragma once

#include <pybind11/pybind11.h>

#include "binding/scene_class.h"
#include "simulation/driven_world.h"
#include "simulation/event_record.h"

namespace verlet_cable {

/// What Python calls a World.
struct PythonWorld {
  PythonScene scene;
  DrivenWorld driven;
  EventRecord events;
  bool busy = false;  ///< in use by a thread that has let others run

  PythonWorld(PythonScene made_of, DrivenWorld world, EventRecord record = {})
      : scene(std::move(made_of)), driven(std::move(world)), events(std::move(record)) {}
};

void add_world_class(pybind11::module_& module);

}  // namespace verlet_cable
