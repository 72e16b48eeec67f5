#pragma once

#include <pybind11/pybind11.h>
#include <yaml-cpp/yaml.h>

namespace verlet_cable {

/// The tree of keys that dicts, lists, tuples, arrays, text, paths, numbers, booleans and None mean. Anything else becomes
/// nothing, its tag saying what it was: readers refuse it. Throws SceneError where it is larger or nested
/// deeper than a scene may be, before more is built of it.
YAML::Node yaml_of(const pybind11::handle& value);

}  // namespace verlet_cable
