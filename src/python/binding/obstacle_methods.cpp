#include "binding/arguments.h"
#include "binding/edit_methods.h"
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
  const InUse in_use(world.busy(), world.used());
  const py::gil_scoped_release release;
  set_obstacle(read_obstacle(node, sources), world.driven());
}

void remove_by_name(PythonWorld& world, const py::str& name) {
  remove_obstacle(text_of(name, "name"), world.driven());
}

}  // namespace

void add_obstacle_methods(WorldMethods& methods) {
  methods.add_edit(
      "set_obstacle", set_from_keys, py::arg("name"), py::kw_only(), py::arg("directory") = py::none(),
      "Adds an obstacle, or replaces the one with that name. An obstacle can be moved in this way, and cables that lie on "
      "it stay in contact. The other arguments are the keys of obstacles in a scene: type='sphere', pose=[x, y, z, roll, "
      "pitch, yaw] [m, rad], radius=..., ...\n\nReplacing an obstacle gives it no velocity: to carry or push what it "
      "touches, move its frame with set_frame. A frame that the world does not have is added at initial_pose, or where the "
      "robot has a link of that name, or at the origin. directory: to which the path of a mesh refers, by default the "
      "current one.\n\nRaises SceneError with all errors at once; then nothing is changed.");
  methods.add_edit("remove_obstacle", remove_by_name, py::arg("name"),
                   "Removes an obstacle of the scene or of set_obstacle. Raises KeyError if there is none of that name.");
}

}  // namespace verlet_cable
