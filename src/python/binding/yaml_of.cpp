#include "binding/yaml_of.h"

#include <cmath>
#include <string>

#include "binding/text_arguments.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {
namespace {

namespace py = pybind11;

constexpr int deepest = 32;  // as scenes that are text

std::string number_of(double number) {
  if (std::isnan(number)) return ".nan";
  if (std::isinf(number)) return number > 0 ? ".inf" : "-.inf";
  return number_text(number);
}

/// What no key can be: the reader refuses it where it comes to it, with the key and what is allowed there.
YAML::Node unreadable(const std::string& text) {
  YAML::Node node(YAML::NodeType::Null);
  node.SetTag(text);
  return node;
}

YAML::Node text_node(const py::handle& text) {
  try {
    return YAML::Node(text_of(text, {}));
  } catch (const py::value_error&) {
    return unreadable(ascii_text(text));
  }
}

YAML::Node boolean_node(bool value) {
  YAML::Node node(value ? "true" : "false");
  node.SetTag(boolean_tag);
  return node;
}

/// Numbers as Python writes them.
bool is_written_number(const py::handle& value) {
  return py::isinstance<py::int_>(value) || py::isinstance(value, py::module_::import("decimal").attr("Decimal"));
}

YAML::Node yaml_of(const py::handle& value, const std::string& key, int depth) {
  // At once, as what contains itself has no end.
  if (depth > deepest) throw SceneError({key + ": nested deeper than " + std::to_string(deepest) + " levels; allowed: less"});
  if (value.is_none()) return YAML::Node(YAML::NodeType::Null);
  if (py::isinstance<py::str>(value)) return text_node(value);
  if (py::isinstance<py::bool_>(value)) return boolean_node(value.cast<bool>());
  if (py::isinstance<py::float_>(value)) return YAML::Node(number_of(value.cast<double>()));
  if (py::isinstance<py::dict>(value)) {
    YAML::Node map(YAML::NodeType::Map);
    for (const auto& [name, item] : py::reinterpret_borrow<py::dict>(value)) {
      const YAML::Node name_node = py::isinstance<py::str>(name) ? text_node(name) : unreadable(ascii_text(name));
      const std::string text = name_node.IsScalar() ? name_node.Scalar() : name_node.Tag();
      map.force_insert(name_node, yaml_of(item, key.empty() ? text : key + "." + text, depth + 1));
    }
    return map;
  }
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    YAML::Node list(YAML::NodeType::Sequence);
    std::size_t index = 0;
    for (const py::handle& item : value) list.push_back(yaml_of(item, key + "[" + std::to_string(index++) + "]", depth + 1));
    return list;
  }
  if (is_written_number(value)) return text_node(py::str(value));
  // NumPy's arrays and scalars
  if (py::hasattr(value, "tolist")) return yaml_of(value.attr("tolist")(), key, depth + 1);
  if (py::hasattr(value, "__fspath__")) return yaml_of(value.attr("__fspath__")(), key, depth + 1);
  return unreadable(ascii_text(py::type::of(value)));
}

}  // namespace

YAML::Node yaml_of(const py::handle& value) {
  return yaml_of(value, {}, 0);
}

}  // namespace verlet_cable
