#pragma once

#include "binding/world_methods.h"

namespace verlet_cable {

/// pin, unpin, cut, join, set_length, set_tension, set_state, move_attachment, tune, set_frame, add_frame; of World alone, as
/// Batch has them with an array for all worlds, apply_force and apply_wrench; and in the module what these return.
void add_edit_methods(pybind11::module_& module, pybind11::class_<PythonWorld>& world, WorldMethods& methods);

/// set_obstacle and remove_obstacle.
void add_obstacle_methods(WorldMethods& methods);

/// events, loads, contacts, ledger, save; and in the module what these return.
void add_report_methods(pybind11::module_& module, WorldMethods& methods);

}  // namespace verlet_cable
