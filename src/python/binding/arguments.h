#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "simulation/quantity.h"
#include "verlet_cable/core/types.h"

namespace verlet_cable {

namespace py = pybind11;

/// Real numbers of any type and layout, read as doubles.
class Numbers : public py::array_t<double, py::array::c_style | py::array::forcecast> {
 public:
  using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;
  using Doubles::Doubles;

  /// None where it is something else: text, None, complex numbers.
  static Numbers ensure(py::handle given);
};

/// "(3, 7)", as NumPy writes shapes.
std::string shape_text(const py::array& array);

/// Throws ValueError where the shape is not (size,).
void check_size(const char* name, const Numbers& numbers, py::ssize_t size);

/// From the last axis of an array: x, y, z, qx, qy, qz, qw. `name`: of the argument, with the index. Throws ValueError.
Pose read_pose(const double* numbers, const std::string& name);
/// Likewise, where it is one.
std::optional<Pose> sound_pose(const double* numbers);
Pose read_pose(const Numbers& position, const Numbers& quaternion_xyzw);

/// (3,). Throws ValueError where the shape is another.
Vector3 read_vector(const char* name, const Numbers& numbers);
/// Likewise, of the argument `point`.
std::optional<Vector3> read_point(const std::optional<Numbers>& point);

/// A count that is not negative. Throws ValueError.
std::int64_t read_count(const char* name, std::int64_t count, std::int64_t least);

/// "positions", ...; `argument`: of which they are. Throws ValueError.
std::vector<Quantity> read_quantities(const char* argument, const std::vector<py::str>& names);

/// What the method that reads it calls its argument.
inline const char* argument_of(Quantity quantity) {
  return quantity == Quantity::wrench ? "attachment" : "name";
}

/// A new array.
py::array_t<double> array_of(const Vector3& vector);
/// A new array, and what it is of.
py::array_t<double> array_of(const World& world, Quantity quantity, const std::string& name);

/// 16 hexadecimal digits, as in a summary.
std::string hash_text(std::uint64_t hash);

/// An array that is handed out: nobody takes what is written into a copy for a change of the world.
template <class Array>
Array read_only(Array array) {
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::dict energy_dict(const Energy& energy);
py::dict ledger_dict(const Ledger& ledger);

}  // namespace verlet_cable

namespace pybind11::detail {

template <>
struct handle_type_name<verlet_cable::Numbers> : handle_type_name<verlet_cable::Numbers::Doubles> {};

/// As that of array_t.
template <>
struct pyobject_caster<verlet_cable::Numbers> {
  bool load(handle given, bool convert) {
    if (!convert && !verlet_cable::Numbers::check_(given)) return false;
    value = verlet_cable::Numbers::ensure(given);
    return static_cast<bool>(value);
  }
  static handle cast(const handle& numbers, return_value_policy, handle) { return numbers.inc_ref(); }
  PYBIND11_TYPE_CASTER(verlet_cable::Numbers, handle_type_name<verlet_cable::Numbers>::name);
};

}  // namespace pybind11::detail
