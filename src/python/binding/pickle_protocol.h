#pragma once

#include <pybind11/pybind11.h>

#include <algorithm>

namespace verlet_cable {

/// `__reduce_ex__` of a class that has py::pickle. By protocols 0 and 1, Python makes objects of the class's base, which none can
/// be made of; what it does by protocol 2 holds in all.
inline pybind11::object reduce(const pybind11::object& self, int protocol) {
  return pybind11::module_::import("builtins").attr("object").attr("__reduce_ex__")(self, std::max(protocol, 2));
}

}  // namespace verlet_cable
