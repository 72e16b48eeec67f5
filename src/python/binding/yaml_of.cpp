#include "binding/yaml_of.h"

#include <pybind11/numpy.h>

#include <cmath>
#include <string>

#include "binding/text_arguments.h"
#include "scene/scene_size.h"
#include "verlet_cable/core/number_text.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {
namespace {

namespace py = pybind11;

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

/// [byte] at least, in UTF-8.
std::size_t size_of(const py::handle& text) {
  return static_cast<std::size_t>(PyUnicode_GET_LENGTH(text.ptr()));
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

/// Python refuses to write very long ones.
YAML::Node written_number_node(const py::handle& value) {
  const auto text = py::reinterpret_steal<py::object>(PyObject_Str(value.ptr()));
  if (text) return text_node(text);
  PyErr_Clear();
  return unreadable(ascii_text(py::type::of(value)));
}

class Converter {
 public:
  YAML::Node node_of(const py::handle& value, const std::string& key, std::size_t level) {
    const bool is_text = py::isinstance<py::str>(value);
    size_.add(key, level, is_text ? size_of(value) : 0);
    if (value.is_none()) return YAML::Node(YAML::NodeType::Null);
    if (is_text) return text_node(value);
    if (py::isinstance<py::bool_>(value)) return boolean_node(value.cast<bool>());
    if (py::isinstance<py::float_>(value)) return YAML::Node(number_of(value.cast<double>()));
    if (py::isinstance<py::dict>(value)) return map_of(py::reinterpret_borrow<py::dict>(value), key, level);
    if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) return list_of(value, key, level);
    if (is_written_number(value)) return written_number_node(value);
    // NumPy's arrays and scalars
    if (py::isinstance<py::array>(value))
      size_.expect(key, static_cast<std::size_t>(py::reinterpret_borrow<py::array>(value).size()));
    for (const char* const plain : {"tolist", "__fspath__"})
      if (py::hasattr(value, plain)) return node_of(value.attr(plain)(), key, level + 1);
    return unreadable(ascii_text(py::type::of(value)));
  }

 private:
  YAML::Node map_of(const py::dict& items, const std::string& key, std::size_t level) {
    YAML::Node map(YAML::NodeType::Map);
    for (const auto& [name, item] : items) {
      const bool is_text = py::isinstance<py::str>(name);
      if (is_text) size_.add(key, level, size_of(name));
      const YAML::Node name_node = is_text ? text_node(name) : unreadable(ascii_text(name));
      const std::string text = escaped(name_node.IsScalar() ? name_node.Scalar() : name_node.Tag());
      map.force_insert(name_node, node_of(item, key.empty() ? text : key + "." + text, level + 1));
    }
    return map;
  }

  YAML::Node list_of(const py::handle& items, const std::string& key, std::size_t level) {
    YAML::Node list(YAML::NodeType::Sequence);
    std::size_t index = 0;
    for (const py::handle& item : items) list.push_back(node_of(item, key + "[" + std::to_string(index++) + "]", level + 1));
    return list;
  }

  SceneSize size_;
};

}  // namespace

YAML::Node yaml_of(const py::handle& value) {
  return Converter().node_of(value, {}, 0);
}

}  // namespace verlet_cable
