#include "binding/scene_class.h"

#include <pybind11/stl.h>

#include <filesystem>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "binding/pickle_protocol.h"
#include "binding/text_arguments.h"
#include "binding/yaml_of.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {
namespace {

namespace py = pybind11;

/// With a warning of all that is doubtful in it.
template <class Reader>
PythonScene scene_of(const std::string& directory, const Reader& read) {
  PythonScene scene;
  scene.directory = directory;
  {
    const py::gil_scoped_release release;
    scene.desc = std::make_shared<SceneDesc>(read(scene.text));
  }
  for (const std::string& line : warnings_of(*scene.desc))
    if (PyErr_WarnEx(PyExc_UserWarning, line.c_str(), 1) != 0) throw py::error_already_set();
  return scene;
}

PythonScene load(const py::object& path) {
  const std::string file = path_of(path, "path");
  std::error_code error;  // of an empty name, which cannot be read below
  const FileAccess beside{true, std::filesystem::absolute(file, error).parent_path().string()};
  return scene_of(beside.directory, [&](std::string& text) {
    text = scene_file_text(file);
    return read_scene_text(text, {beside, {}});
  });
}

PythonScene from_yaml(const py::str& given, const py::object& directory) {
  const std::string given_text = text_of(given, "text");
  const SceneSources sources = sources_of(directory);
  return scene_of(sources.files.directory, [&](std::string& text) {
    text = given_text;
    return read_scene_text(text, sources);
  });
}

PythonScene from_dict(const py::dict& keys, const py::object& directory) {
  const SceneSources sources = sources_of(directory);
  const YAML::Node root = yaml_of(keys);
  return scene_of(sources.files.directory, [&](std::string& text) {
    SceneDesc scene = read_scene(root, {}, sources);
    text = YAML::Dump(root);
    return scene;
  });
}

template <class Items>
std::vector<std::string> names_of(const Items& items) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(item.name);
  return names;
}

template <class Items>
void append_names(const Items& items, std::vector<std::string>& names) {
  for (const auto& item : items) names.push_back(item.name);
}

std::vector<std::string> attachment_names(const SceneDesc& scene) {
  std::vector<std::string> names;
  for (const CableDesc& cable : scene.cables) append_names(cable.attachments, names);
  for (const NetDesc& net : scene.nets) append_names(net.attachments, names);
  for (const BodyDesc& body : scene.bodies) append_names(body.attachments, names);
  return names;
}

std::vector<std::string> moving_frame_names(const SceneDesc& scene) {
  std::vector<std::string> names = frame_names(scene);
  names.erase(names.begin());
  return names;
}

}  // namespace

SceneSources sources_of(const py::object& directory) {
  const py::module_ os = py::module_::import("os");
  const py::bytes start = directory.is_none() ? os.attr("getcwdb")() : py::bytes(path_of(directory, "directory"));
  return {FileAccess{true, py::bytes(os.attr("path").attr("abspath")(start))}, {}};
}

py::tuple parts_of(const PythonScene& scene) {
  return py::make_tuple(py::bytes(scene.text), py::bytes(scene.directory));
}

PythonScene scene_of_parts(const py::tuple& parts) {
  PythonScene scene;
  scene.text = parts[0].cast<std::string>();
  scene.directory = parts[1].cast<std::string>();
  const py::gil_scoped_release release;
  scene.desc = std::make_shared<SceneDesc>(read_scene_text(scene.text, {FileAccess{true, scene.directory}, {}}));
  return scene;
}

void add_scene_class(py::module_& module) {
  py::class_<PythonScene>(
      module, "Scene",
      "A scene that has been read and validated. It is immutable; worlds are made from it. A pickle, also of a "
      "world or batch, has its text and the path of its directory, from which meshes and a robot "
      "are read again where it is loaded: on another machine they must be there, too.")
      .def(py::init([](const py::object&) -> PythonScene {
             throw py::type_error(
                 "Scene is not made by calling it; allowed: Scene.load(path) for a file, Scene.from_yaml(text), "
                 "Scene.from_dict(keys)");
           }),
           py::arg("path") = py::none(), "Not for use: load, from_yaml and from_dict make scenes.")
      .def(py::pickle(&parts_of, &scene_of_parts))
      .def("__reduce_ex__", reduce, py::arg("protocol"))
      .def("__copy__", [](const PythonScene& scene) { return scene; })
      .def(
          "__deepcopy__", [](const PythonScene& scene, const py::dict&) { return scene; }, py::arg("memo"))
      .def("__repr__",
           [](const PythonScene& scene) {
             NameList cables;
             for (const CableDesc& cable : scene.desc->cables) cables.add(cable.name);
             return "<Scene with cables: " + cables.text("none") + ">";
           })
      .def_static("load", load, py::arg("path"),
                  "Reads a YAML file. Relative paths in it refer to its directory. Raises SceneError with all errors at once.")
      .def_static("from_yaml", from_yaml, py::arg("text"), py::arg("directory") = py::none(),
                  "Reads YAML text. Relative paths in it refer to `directory`, by default the current one. Raises SceneError.")
      .def_static("from_dict", from_dict, py::arg("keys"), py::arg("directory") = py::none(),
                  "Reads a scene from dicts and lists with the keys of a scene file. Raises SceneError.")
      .def_property_readonly(
          "frame_id", [](const PythonScene& scene) { return scene.desc->frame_id; }, "Name of the fixed frame.")
      .def_property_readonly(
          "frame_names", [](const PythonScene& scene) { return moving_frame_names(*scene.desc); },
          "Names of the frames in the scene except the fixed one, in order of appearance.")
      .def_property_readonly(
          "cable_names", [](const PythonScene& scene) { return names_of(scene.desc->cables); }, "Names of the cables.")
      .def_property_readonly(
          "net_names", [](const PythonScene& scene) { return names_of(scene.desc->nets); }, "Names of the nets.")
      .def_property_readonly(
          "particle_names", [](const PythonScene& scene) { return names_of(scene.desc->particles); }, "Names of the particles.")
      .def_property_readonly(
          "body_names", [](const PythonScene& scene) { return names_of(scene.desc->bodies); }, "Names of the rigid bodies.")
      .def_property_readonly(
          "guide_names", [](const PythonScene& scene) { return names_of(scene.desc->guides); }, "Names of the guides.")
      .def_property_readonly(
          "material_names", [](const PythonScene& scene) { return names_of(scene.desc->materials); },
          "Names of the materials that the cables have.")
      .def_property_readonly(
          "attachment_names", [](const PythonScene& scene) { return attachment_names(*scene.desc); },
          "Names of the attachments of cables, nets and bodies.")
      .def_property_readonly(
          "time_step", [](const PythonScene& scene) { return scene.desc->time_step; }, "[s] Time step.")
      .def_property_readonly(
          "warnings", [](const PythonScene& scene) { return warnings_of(*scene.desc); },
          "What the scene allows and probably does not mean, one text each: sections that whole segments do not fit, "
          "or what its robot does without. Each was a UserWarning when the scene was read.");
}

}  // namespace verlet_cable
