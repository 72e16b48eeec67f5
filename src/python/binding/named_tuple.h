#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

namespace verlet_cable {

/// A class of named tuples, in the module.
inline pybind11::object add_tuple(pybind11::module_& module, const char* name, const std::vector<std::string>& fields,
                                  const char* documentation) {
  using namespace pybind11::literals;
  const pybind11::object tuple =
      pybind11::module_::import("collections").attr("namedtuple")(name, fields, "module"_a = "verlet_cable.sim");
  tuple.attr("__doc__") = documentation;
  module.attr(name) = tuple;
  return tuple;
}

}  // namespace verlet_cable
