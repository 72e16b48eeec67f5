#include "binding/yaml_of.h"

#include <cmath>
#include <string>

#include "verlet_cable/core/number_text.h"

namespace verlet_cable {
namespace {

namespace py = pybind11;

constexpr int deepest = 32;  // as scenes that are text

std::string number_of(double number) {
  if (std::isnan(number)) return ".nan";
  if (std::isinf(number)) return number > 0 ? ".inf" : "-.inf";
  return number_text(number);
}

YAML::Node yaml_of(const py::handle& value, const std::string& what, int depth) {
  if (depth > deepest) throw py::value_error(what + ": nested deeper than " + std::to_string(deepest) + " levels; allowed: less");
  if (value.is_none()) return YAML::Node(YAML::NodeType::Null);
  if (py::isinstance<py::str>(value)) return YAML::Node(value.cast<std::string>());
  if (py::isinstance<py::bool_>(value)) return YAML::Node(value.cast<bool>() ? "true" : "false");
  if (py::isinstance<py::int_>(value)) return YAML::Node(py::str(value).cast<std::string>());
  if (py::isinstance<py::float_>(value)) return YAML::Node(number_of(value.cast<double>()));
  if (py::isinstance<py::dict>(value)) {
    YAML::Node map(YAML::NodeType::Map);
    for (const auto& [key, item] : py::reinterpret_borrow<py::dict>(value)) {
      if (!py::isinstance<py::str>(key))
        throw py::type_error(what + ": key " + py::repr(key).cast<std::string>() + "; allowed: text");
      map.force_insert(key.cast<std::string>(), yaml_of(item, what, depth + 1));
    }
    return map;
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    YAML::Node list(YAML::NodeType::Sequence);
    for (const py::handle& item : value) list.push_back(yaml_of(item, what, depth + 1));
    return list;
  }
  // NumPy's arrays and scalars
  if (py::hasattr(value, "tolist")) return yaml_of(value.attr("tolist")(), what, depth + 1);
  if (py::hasattr(value, "__fspath__")) return YAML::Node(py::str(value.attr("__fspath__")()).cast<std::string>());
  throw py::type_error(what + ": " + py::repr(py::type::of(value)).cast<std::string>() +
                       "; allowed: dicts, lists, text, numbers, booleans and None");
}

}  // namespace

YAML::Node yaml_of(const pybind11::handle& value, const std::string& what) {
  return yaml_of(value, what, 0);
}

}  // namespace verlet_cable
