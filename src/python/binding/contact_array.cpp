#include "binding/contact_array.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace verlet_cable {
namespace {

/// Names are as long as the world's longest, so that the type stays as long as the world has its names.
py::object contact_type(const World& world) {
  std::size_t longest = 1;
  for (const std::string& name : solid_names(world)) longest = std::max(longest, name.size());
  for (const SimulatedCable& cable : world.cables()) longest = std::max(longest, cable.model->name.size());
  const std::string text = "U" + std::to_string(longest);
  py::list fields;
  const auto add = [&](const char* name, const std::string& type) { fields.append(py::make_tuple(name, type)); };
  const auto add_vector = [&](const char* name) { fields.append(py::make_tuple(name, "<f8", py::make_tuple(3))); };
  add("cable", text);
  add("segment", "<u4");
  for (const char* name : {"position", "normal", "force"}) add_vector(name);
  add("other", text);
  return py::module_::import("numpy").attr("dtype")(fields);
}

}  // namespace

py::object contact_array(const World& world) {
  const std::vector<SimulatedContact> contacts = contacts_of_both(world);
  py::object array = py::module_::import("numpy").attr("zeros")(contacts.size(), contact_type(world));
  py::list cables, others;
  py::array_t<std::uint32_t> segments(static_cast<py::ssize_t>(contacts.size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    cables.append(world.cables()[contacts[i].cable].model->name);
    others.append(world.touched_name(contacts[i]));
    segments.mutable_at(i) = static_cast<std::uint32_t>(contacts[i].segment);
  }
  array["cable"] = cables;
  array["segment"] = segments;
  array["other"] = others;
  const auto set = [&](const char* field, Vector3 SimulatedContact::*vector) {
    py::array_t<double> numbers(std::vector<std::size_t>{contacts.size(), 3});
    for (std::size_t i = 0; i < contacts.size(); ++i)
      std::copy_n((contacts[i].*vector).data(), 3, numbers.mutable_data() + 3 * i);
    array[field] = numbers;
  };
  set("position", &SimulatedContact::position);
  set("normal", &SimulatedContact::normal);
  set("force", &SimulatedContact::force);
  return read_only(std::move(array));
}

}  // namespace verlet_cable
