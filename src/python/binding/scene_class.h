#pragma once

#include <pybind11/pybind11.h>

#include <memory>

#include "verlet_cable/core/scene_desc.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {

/// What Python calls a Scene: it does not change.
struct PythonScene {
  std::shared_ptr<const SceneDesc> desc;
  std::string text;       ///< YAML, of which it was read
  std::string directory;  ///< absolute, at which files start that it names
};

/// As a pickle has it: its text and directory. Files that it names are read again.
pybind11::tuple parts_of(const PythonScene& scene);
PythonScene scene_of_parts(const pybind11::tuple& parts);

/// Files that a scene names without a directory start at `directory`, with None at the current one.
SceneSources sources_of(const pybind11::object& directory);

void add_scene_class(pybind11::module_& module);

}  // namespace verlet_cable
