#include "binding/arguments.h"

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <utility>

#include "binding/text_arguments.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

std::string numbers_text(const double* numbers, int count) {
  std::string text;
  for (int i = 0; i < count; ++i) text += (i == 0 ? "" : ", ") + number_text(numbers[i]);
  return "(" + text + ")";
}

/// Whether an array has nothing but real numbers, of its own types or Python's.
bool has_numbers(const py::array& array) {
  const char kind = array.dtype().kind();
  if (kind != 'O') return kind == 'b' || kind == 'i' || kind == 'u' || kind == 'f';
  for (const py::handle& item : array.attr("ravel")())
    if (PyNumber_Check(item.ptr()) == 0 || PyComplex_Check(item.ptr()) != 0) return false;
  return true;
}

Pose pose_of(const double* position, const double* orientation) {
  return {{position[0], position[1], position[2]}, Quaternion(orientation[3], orientation[0], orientation[1], orientation[2])};
}

/// `position` and `orientation`: names for messages.
Pose read_pose(const double* position, const std::string& position_name, const double* orientation,
               const std::string& orientation_name) {
  Pose pose = pose_of(position, orientation);
  if (!is_sound({pose.position, Quaternion::Identity()}))
    throw py::value_error(position_name + ": " + numbers_text(position, 3) +
                          "; allowed: finite numbers [m] (from -1e+09 to 1e+09)");
  if (!is_sound({Vector3::Zero(), pose.orientation}))
    throw py::value_error(orientation_name + ": " + numbers_text(orientation, 4) +
                          "; allowed: quaternions x, y, z, w of length 1 (from 0.5 to 2 is brought to 1)");
  pose.orientation.normalize();
  return pose;
}

}  // namespace

Numbers Numbers::ensure(py::handle given) {
  const py::array array = py::array::ensure(given);
  if (!array || !has_numbers(array)) return py::reinterpret_steal<Numbers>(py::handle());
  return py::reinterpret_steal<Numbers>(Doubles::ensure(array).release());
}

void check_size(const char* name, const Numbers& numbers, py::ssize_t size) {
  if (numbers.ndim() != 1 || numbers.shape(0) != size)
    throw py::value_error(std::string(name) + ": shape " + shape_text(numbers) + "; allowed: (" + std::to_string(size) + ",)");
}

std::string shape_text(const py::array& array) {
  std::string text;
  for (py::ssize_t i = 0; i < array.ndim(); ++i) text += (i == 0 ? "" : ", ") + std::to_string(array.shape(i));
  return "(" + text + (array.ndim() == 1 ? ",)" : ")");
}

Pose read_pose(const double* numbers, const std::string& name) {
  return read_pose(numbers, name, numbers + 3, name);
}

std::optional<Pose> sound_pose(const double* numbers) {
  Pose pose = pose_of(numbers, numbers + 3);
  if (!is_sound(pose)) return std::nullopt;
  pose.orientation.normalize();
  return pose;
}

Pose read_pose(const Numbers& position, const Numbers& quaternion_xyzw) {
  check_size("position", position, 3);
  check_size("quaternion_xyzw", quaternion_xyzw, 4);
  return read_pose(position.data(), "position", quaternion_xyzw.data(), "quaternion_xyzw");
}

Vector3 read_vector(const char* name, const Numbers& numbers) {
  check_size(name, numbers, 3);
  return {numbers.at(0), numbers.at(1), numbers.at(2)};
}

std::optional<Vector3> read_point(const std::optional<Numbers>& point) {
  if (!point) return std::nullopt;
  return read_vector("point", *point);
}

std::int64_t read_count(const char* name, std::int64_t count, std::int64_t least) {
  if (count < least)
    throw py::value_error(std::string(name) + ": " + std::to_string(count) + "; allowed: " + std::to_string(least) + " or above");
  return count;
}

std::vector<Quantity> read_quantities(const char* argument, const std::vector<py::str>& names) {
  std::vector<Quantity> quantities;
  for (const py::str& given : names) {
    const std::string name = text_of(given, argument);
    std::size_t i = 0;
    while (i < quantity_names.size() && name != quantity_names[i]) ++i;
    if (i == quantity_names.size())
      throw py::value_error(std::string(argument) + ": " + in_quotes(name) + "; allowed: " + NameList(quantity_names).text());
    quantities.push_back(static_cast<Quantity>(i));
  }
  return quantities;
}

py::array_t<double> array_of(const World& world, Quantity quantity, const std::string& name) {
  const QuantityShape shape = shape_of(world, quantity, name);
  std::vector<std::size_t> sizes{shape.rows};
  if (shape.columns > 0) sizes.push_back(shape.columns);
  py::array_t<double> array(sizes);
  copy_quantity(world, quantity, name, array.mutable_data());
  return read_only(std::move(array));
}

py::array_t<double> array_of(const Vector3& vector) {
  py::array_t<double> array(3);
  std::copy_n(vector.data(), 3, array.mutable_data());
  return read_only(std::move(array));
}

std::string hash_text(std::uint64_t hash) {
  char text[17];
  std::snprintf(text, sizeof text, "%016" PRIx64, hash);
  return text;
}

py::dict ledger_dict(const Ledger& ledger) {
  py::dict work, dissipated, dict;
  for (const auto& [name, place] : EnergyBalance::Work::fields) work[name] = ledger.balance.work.*place;
  for (const auto& [name, place] : EnergyBalance::Dissipated::fields) dissipated[name] = ledger.balance.dissipated.*place;
  dict["work"] = work;
  dict["dissipated"] = dissipated;
  dict["change"] = ledger.change;
  dict["unaccounted"] = ledger.unaccounted();
  dict["unaccounted_steps"] = ledger.unaccounted_steps;
  return dict;
}

py::dict energy_dict(const Energy& energy) {
  py::dict dict;
  dict["kinetic"] = energy.kinetic;
  dict["gravity"] = energy.gravity;
  dict["stretch"] = energy.stretch;
  dict["bend"] = energy.bend;
  dict["twist"] = energy.twist;
  dict["total"] = energy.total();
  return dict;
}

}  // namespace verlet_cable
