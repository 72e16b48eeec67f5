#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "binding/batch_class.h"
#include "binding/edit_methods.h"
#include "binding/scene_class.h"
#include "binding/world_class.h"
#include "simulation/quantity.h"

namespace {

namespace py = pybind11;
using verlet_cable::SceneError;
using verlet_cable::UnknownName;

/// Made once and never freed: exceptions may come until the interpreter's end.
PyObject* scene_error = nullptr;

/// For messages: paths, and what files have written, may be no UTF-8.
py::object text_of(const std::string& message) {
  return py::reinterpret_steal<py::object>(
      PyUnicode_DecodeUTF8(message.data(), static_cast<Py_ssize_t>(message.size()), "backslashreplace"));
}

void translate(std::exception_ptr thrown) {
  try {
    std::rethrow_exception(thrown);
  } catch (const SceneError& error) {
    py::object instance = py::reinterpret_borrow<py::object>(scene_error)(text_of(error.what()));
    py::list lines;
    for (const std::string& line : error.errors()) lines.append(text_of(line));
    instance.attr("errors") = lines;
    PyErr_SetObject(scene_error, instance.ptr());
  } catch (const UnknownName& error) {
    PyErr_SetObject(PyExc_KeyError, text_of(error.what()).ptr());
  }
}

/// What pybind11 calls for the memory of an object whose constructor has not run: it would use it as it is, with anything in it.
void* refuse_without_constructor(std::size_t) {
  throw py::type_error("the object was not made: call its class, not its __new__");
}

/// Every class of the module: what `__new__` alone has made is an error wherever it is used.
void refuse_objects_without_constructor(const py::module_& module) {
  for (const auto& item : module.attr("__dict__").cast<py::dict>()) {
    if (!PyType_Check(item.second.ptr())) continue;
    if (auto* type = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(item.second.ptr())))
      type->operator_new = &refuse_without_constructor;
  }
}

}  // namespace

PYBIND11_MODULE(_simulation, module) {
  module.doc() = "The compiled part of verlet_cable.sim.";
  module.attr("__version__") = VERLET_CABLE_VERSION;
  scene_error = PyErr_NewExceptionWithDoc(
      "verlet_cable.sim.SceneError",
      "All errors of a scene or a motion. The message has a line for each; `errors` is the list of these lines.",
      PyExc_ValueError, nullptr);
  if (!scene_error) throw py::error_already_set();
  module.attr("SceneError") = py::handle(scene_error);
  py::register_exception_translator(translate);
  verlet_cable::add_scene_class(module);
  py::class_<verlet_cable::PythonWorld> world = verlet_cable::add_world_class(module);
  verlet_cable::BatchClass batch = verlet_cable::add_batch_class(module);
  verlet_cable::add_worlds_class(module);
  verlet_cable::WorldMethods methods(world, batch);
  verlet_cable::add_edit_methods(module, world, methods);
  verlet_cable::add_obstacle_methods(methods);
  verlet_cable::add_report_methods(module, methods);
  for (const char* name : {"Scene", "World", "Batch", "Worlds"}) module.attr(name).attr("__module__") = "verlet_cable.sim";
  refuse_objects_without_constructor(module);
  const py::object explain = py::module_::import("verlet_cable.wrong_arguments").attr("explain");
  explain(module.attr("Batch"), module.attr("Scene"), module.attr("World"), module.attr("Worlds"));
}
