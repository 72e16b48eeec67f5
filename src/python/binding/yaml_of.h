#pragma once

#include <pybind11/pybind11.h>
#include <yaml-cpp/yaml.h>

#include <string>

namespace verlet_cable {

/// The tree of keys that dicts, lists, tuples, arrays, text, numbers, booleans and None mean. Throws TypeError for anything else,
/// ValueError where it is nested too deeply; `what` it is, for messages.
YAML::Node yaml_of(const pybind11::handle& value, const std::string& what);

}  // namespace verlet_cable
