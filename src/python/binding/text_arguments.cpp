#include "binding/text_arguments.h"

#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

namespace py = pybind11;

std::string bytes_of(const py::object& bytes) {
  return {PyBytes_AS_STRING(bytes.ptr()), static_cast<std::size_t>(PyBytes_GET_SIZE(bytes.ptr()))};
}

}  // namespace

std::string ascii_text(const py::handle& value) {
  const auto text = py::reinterpret_steal<py::object>(PyObject_ASCII(value.ptr()));
  if (!text) throw py::error_already_set();
  return escaped(bytes_of(py::reinterpret_steal<py::object>(PyUnicode_AsASCIIString(text.ptr()))));
}

std::string text_of(const py::handle& text, const std::string& argument) {
  const auto bytes = py::reinterpret_steal<py::object>(PyUnicode_AsUTF8String(text.ptr()));
  if (bytes) return bytes_of(bytes);
  PyErr_Clear();
  throw py::value_error(argument + ": " + ascii_text(text) + "; allowed: text that UTF-8 can hold");
}

std::string path_of(const py::handle& path, const std::string& argument) {
  const auto name = py::reinterpret_steal<py::object>(PyOS_FSPath(path.ptr()));
  if (!name) {
    if (!PyErr_ExceptionMatches(PyExc_TypeError)) throw py::error_already_set();
    PyErr_Clear();
    throw py::type_error(argument + ": " + ascii_text(py::type::of(path)) + "; allowed: a path as text, bytes or os.PathLike");
  }
  // Text stands for any bytes of a name, which Python escapes as surrogates.
  PyObject* encoded = nullptr;
  if (PyUnicode_FSConverter(name.ptr(), &encoded) == 0) {
    PyErr_Clear();
    throw py::value_error(argument + ": " + ascii_text(name) + "; allowed: paths that files can have");
  }
  return bytes_of(py::reinterpret_steal<py::object>(encoded));
}

}  // namespace verlet_cable
