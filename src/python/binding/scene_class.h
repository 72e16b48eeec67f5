#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// What Python calls a Scene: it does not change.
struct PythonScene {
  std::shared_ptr<const SceneDesc> desc;
};

void add_scene_class(pybind11::module_& module);

}  // namespace verlet_cable
