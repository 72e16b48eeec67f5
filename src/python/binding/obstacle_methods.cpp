#include "binding/arguments.h"
#include "binding/edit_methods.h"
#include "binding/run_steps.h"
#include "binding/scene_class.h"
#include "binding/text_arguments.h"
#include "binding/yaml_of.h"
#include "simulation/edits.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {
namespace {

void set_from_keys(PythonWorld& world, const py::str& name, const py::object& directory, const py::kwargs& keys) {
  const SceneSources sources = sources_of(directory);
  YAML::Node node = yaml_of(keys);
  node["name"] = text_of(name, "name");
  const InUse in_use(world.busy, "world");
  const py::gil_scoped_release release;
  set_obstacle(read_obstacle(node, sources), world.driven);
}

void remove_by_name(PythonWorld& world, const py::str& name) {
  InUse::check(world.busy, "world");
  remove_obstacle(text_of(name, "name"), world.driven);
}

}  // namespace

void add_obstacle_methods(py::class_<PythonWorld>& world) {
  world.def(
      "set_obstacle", set_from_keys, py::arg("name"), py::kw_only(), py::arg("directory") = py::none(),
      "Adds an obstacle, or replaces the one of that name, which is how one is moved: what lies on it goes on lying. The "
      "other arguments are the keys of a scene's obstacles: type='sphere', pose=[x, y, z, roll, pitch, yaw] [m, rad], "
      "radius=..., ...\n\nIt has no velocity from being set: one that carries or pushes what it touches moves with its frame. A "
      "frame that the world does not have begins at initial_pose, else at the origin; of a robot's "
      "link where that is. set_frame moves it. directory: where a mesh's path starts, by default the current one.\n\nRaises "
      "SceneError with every error at once; then nothing is changed.");
  world.def("remove_obstacle", remove_by_name, py::arg("name"),
            "Takes an obstacle away, of the scene or one that was set. Raises KeyError for a name that none has.");
}

}  // namespace verlet_cable
