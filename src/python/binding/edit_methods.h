#pragma once

#include "binding/world_class.h"

namespace verlet_cable {

/// What has happened since the last call, as Event of the module.
pybind11::list take_events(EventRecord& record, const pybind11::object& event_type);

/// The loads that act, as Load of the module.
pybind11::list load_list(const World& world, const pybind11::object& load_type);

/// pin, unpin, cut, join, set_length, set_tension, move_attachment, tune, events, add_frame; and in the module what these return.
void add_edit_methods(pybind11::module_& module, pybind11::class_<PythonWorld>& world);

/// set_obstacle and remove_obstacle.
void add_obstacle_methods(pybind11::class_<PythonWorld>& world);

}  // namespace verlet_cable
