#pragma once

#include <pybind11/pybind11.h>

#include "verlet_cable/scene/loads.h"
#include "verlet_cable/scene/motion.h"

namespace verlet_cable {

struct SceneDesc;

/// None, the path of a CSV file, or {frame: (times (k,), poses (k, 7))}. Throws SceneError for a file that cannot be used, or
/// that does not fit the scene, ValueError and KeyError for arrays and names.
Motion read_motion(const pybind11::object& motion, const SceneDesc& scene);

/// None, or the path of a CSV file. Throws SceneError likewise.
LoadPlayer read_loads(const pybind11::object& loads, const SceneDesc& scene);

}  // namespace verlet_cable
