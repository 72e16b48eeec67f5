#include "binding/edit_methods.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "binding/arguments.h"
#include "binding/named_tuple.h"
#include "binding/text_arguments.h"
#include "simulation/edits.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/core/scene_fields.h"

namespace verlet_cable {
namespace {

using OptionalNumbers = std::optional<Numbers>;

/// What is wrong with its numbers is said where they are used.
Pose read_offset(const OptionalNumbers& offset) {
  if (!offset) return {};
  if (offset->ndim() != 1 || (offset->shape(0) != 3 && offset->shape(0) != 7))
    throw py::value_error("offset: shape " + shape_text(*offset) + "; allowed: (7,), or (3,) without rotation");
  const double* p = offset->data();
  if (offset->shape(0) == 3) return {{p[0], p[1], p[2]}, Quaternion::Identity()};
  return {{p[0], p[1], p[2]}, Quaternion(p[6], p[3], p[4], p[5])};
}

RequestedPlace read_place(const py::str& cable, std::optional<std::int64_t> node, std::optional<double> arc_length,
                          const OptionalNumbers& point, const py::str& point_frame) {
  const int given = (node ? 1 : 0) + (arc_length ? 1 : 0) + (point ? 1 : 0);
  if (given != 1)
    throw py::value_error("node, arc_length, point: " + std::to_string(given) + " of them given; allowed: exactly one");
  const std::string frame = text_of(point_frame, "point_frame");
  if (!point && !frame.empty())
    throw py::value_error("point_frame: " + in_quotes(frame) + " without a point; allowed: together with one");
  RequestedPlace place;
  place.words = &python_words();
  place.cable = text_of(cable, "cable");
  place.point_frame = frame;
  if (node) place.node = *node;
  if (arc_length) {
    place.mode = RequestedPlace::at_arc_length;
    place.arc_length = *arc_length;
  }
  if (point) {
    check_size("point", *point, 3);
    place.mode = RequestedPlace::nearest;
    place.point = {point->at(0), point->at(1), point->at(2)};
  }
  return place;
}

std::optional<std::vector<Vector3>> read_vectors(const char* name, const OptionalNumbers& numbers) {
  if (!numbers) return std::nullopt;
  if (numbers->ndim() != 2 || numbers->shape(1) != 3)
    throw py::value_error(std::string(name) + ": shape " + shape_text(*numbers) + "; allowed: (n + 1, 3)");
  std::vector<Vector3> vectors;
  for (py::ssize_t k = 0; k < numbers->shape(0); ++k)
    vectors.emplace_back(numbers->at(k, 0), numbers->at(k, 1), numbers->at(k, 2));
  return vectors;
}

std::optional<Pose> read_body_pose(const std::string& name, const OptionalNumbers& numbers) {
  if (!numbers) return std::nullopt;
  check_size(name.c_str(), *numbers, 7);
  return read_pose(numbers->data(), name);
}

std::optional<std::array<Vector3, 2>> read_twist(const std::string& name, const OptionalNumbers& numbers) {
  if (!numbers) return std::nullopt;
  check_size(name.c_str(), *numbers, 6);
  const double* p = numbers->data();
  return std::array<Vector3, 2>{Vector3(p[0], p[1], p[2]), Vector3(p[3], p[4], p[5])};
}

/// `full`: with what it is of.
void read_key(const std::string& key, const std::string& full, const py::handle& value, NamedState& state) {
  const Numbers numbers = Numbers::ensure(value);
  if (!numbers) throw py::value_error(full + ": " + ascii_text(value) + "; allowed: numbers");
  if (key == "positions") {
    state.positions = read_vectors(full.c_str(), numbers);
  } else if (key == "velocities") {
    state.velocities = read_vectors(full.c_str(), numbers);
  } else if (key == "pose") {
    state.pose = read_body_pose(full, numbers);
  } else if (key == "twist") {
    state.twist = read_twist(full, numbers);
  } else if (key != "arc_length") {
    throw UnknownName(full + ": no such key; allowed: positions, velocities, pose, twist, arc_length");
  } else if (numbers.ndim() != 0) {
    throw py::value_error(full + ": shape " + shape_text(numbers) + "; allowed: a number");
  } else {
    state.arc_length = *numbers.data();
  }
}

/// Of the argument `states`.
std::vector<NamedState> read_states(const py::dict& states) {
  std::vector<NamedState> all;
  for (const auto& [name, keys] : states) {
    if (!py::isinstance<py::str>(name)) throw py::type_error("states: " + ascii_text(name) + "; allowed: names");
    NamedState& state = all.emplace_back();
    state.name = text_of(name, "states");
    const std::string path = "states[" + in_quotes(state.name) + "]";
    if (!py::isinstance<py::dict>(keys))
      throw py::type_error(path + ": " + ascii_text(keys) + "; allowed: a dict, such as {'pose': (7,)}");
    for (const auto& [key, value] : keys.cast<py::dict>()) {
      const std::string field = py::isinstance<py::str>(key) ? text_of(key, path) : ascii_text(key);
      read_key(field, path + "[" + in_quotes(field) + "]", value, state);
    }
  }
  return all;
}

void add_axes(const char* name, const OptionalNumbers& vector, std::vector<NumberChange>& changes) {
  if (!vector) return;
  check_size(name, *vector, 3);
  const char* axes[] = {"_x", "_y", "_z"};
  for (int axis = 0; axis < 3; ++axis) changes.push_back({std::string(name) + axes[axis], vector->at(axis)});
}

/// A number, or of a bending stiffness two.
void add_material_number(const NamedMaterial& material, const std::string& key, const Numbers& numbers,
                         std::vector<NumberChange>& changes) {
  const std::string name = material.name + "_" + key;
  const bool bends = key == bending_stiffness_field.key;
  const bool pair = bends && numbers.ndim() == 1 && numbers.shape(0) == 2;
  if (numbers.ndim() != 0 && !pair)
    throw py::value_error("materials[" + in_quotes(material.name) + "][" + in_quotes(key) + "]: shape " + shape_text(numbers) +
                          "; allowed: a number" + (bends ? ", or (2,)" : ""));
  if (!pair && (!bends || material.material.bending_stiffness.is_isotropic())) {
    changes.push_back({name, *numbers.data()});
    return;
  }
  changes.push_back({name + "_y", numbers.data()[0]});
  changes.push_back({name + "_z", numbers.data()[pair ? 1 : 0]});
}

void add_materials(const SceneDesc& scene, const std::map<std::string, std::map<std::string, Numbers>>& materials,
                   std::vector<NumberChange>& changes) {
  for (const auto& [name, keys] : materials) {
    const auto is_it = [&name = name](const NamedMaterial& material) { return material.name == name; };
    const auto material = std::find_if(scene.materials.begin(), scene.materials.end(), is_it);
    if (material == scene.materials.end())
      throw UnknownName("materials: " + in_quotes(name) + "; allowed: " + material_names(scene.materials));
    for (const auto& [key, numbers] : keys) add_material_number(*material, key, numbers, changes);
  }
}

void set_frame(PythonWorld& world, const py::str& name, const Numbers& position, const Numbers& quaternion_xyzw) {
  const int frame = world.driven().find_frame(text_of(name, "name"));
  const Pose pose = read_pose(position, quaternion_xyzw);
  if (!world.driven().set_frame(frame, &pose, 1)) return;
  world.events() = {};
  world.events().observe_start(world.driven().world());
}

void add_frame(PythonWorld& world, const py::str& name, const Numbers& position, const Numbers& quaternion_xyzw) {
  world.driven().add_frame(text_of(name, "name"), read_pose(position, quaternion_xyzw));
}

void tune_world(PythonWorld& world, const OptionalNumbers& gravity, const OptionalNumbers& wind,
                std::optional<double> contact_friction, const std::map<std::string, std::map<std::string, Numbers>>& materials) {
  DrivenWorld& driven = world.driven();
  std::vector<NumberChange> changes;
  add_axes("gravity", gravity, changes);
  add_axes("wind", wind, changes);
  if (contact_friction) changes.push_back({"contact_friction", *contact_friction});
  add_materials(driven.scene_at_first(), materials, changes);
  tune(changes, driven);
}

void apply(const edit::ApplyLoad& load, PythonWorld& world) {
  const EditResult result = world.driven().world().apply(load);
  if (!result.ok) throw py::value_error(result.message);
}

void apply_force(PythonWorld& world, const py::str& cable, std::int64_t node, const Numbers& force, double duration,
                 const py::str& name) {
  const RequestedLoad request{text_of(name, "name"), "", {}, read_vector("force", force), Vector3::Zero(), duration};
  apply(checked_force(text_of(cable, "cable"), node, request, world.world()), world);
}

void apply_wrench(PythonWorld& world, const py::str& body, const Numbers& force, const OptionalNumbers& torque,
                  const OptionalNumbers& point, bool local, double duration, const py::str& name) {
  const RequestedLoad request{text_of(name, "name"),
                              "",
                              read_point(point),
                              read_vector("force", force),
                              torque ? read_vector("torque", *torque) : Vector3(Vector3::Zero()),
                              duration};
  apply(checked_wrench(text_of(body, "body"), local, request, world.world()), world);
}

void add_cable_edits(py::module_& module, WorldMethods& methods) {
  const py::object pinned =
      add_tuple(module, "Pinned", {"name", "node"}, "Result of World.pin: the name of the attachment, and the node.");
  const py::object pieces = add_tuple(module, "Pieces", {"first", "second"},
                                      "Result of World.cut: the names of the pieces. The second one is '' if a net was cut.");
  methods.add_edit(
      "pin",
      [pinned](PythonWorld& self, const py::str& cable, std::optional<std::int64_t> node, std::optional<double> arc_length,
               const OptionalNumbers& point, const py::str& point_frame, const py::str& name, const py::str& frame_id,
               const OptionalNumbers& offset, bool clamp, bool keep_offset) {
        DrivenWorld& driven = self.driven();
        const RequestedPin request{read_place(cable, node, arc_length, point, point_frame),
                                   text_of(name, "name"),
                                   text_of(frame_id, "frame_id"),
                                   read_offset(offset),
                                   clamp,
                                   keep_offset};
        const PinAnswer answer = pin(request, driven, self.events());
        return pinned(answer.name, answer.node);
      },
      py::arg("cable") = "", py::kw_only(), py::arg("node") = py::none(), py::arg("arc_length") = py::none(),
      py::arg("point") = py::none(), py::arg("point_frame") = "", py::arg("name") = "", py::arg("frame_id") = "",
      py::arg("offset") = py::none(), py::arg("clamp").noconvert() = false, py::arg("keep_offset").noconvert() = false,
      "Holds a node of a cable or net, or the origin of a body (node=0), in a frame, as the service `pin` does. The node moves "
      "there smoothly.\n\ncable: a cable, net or body; '' together with `point`: the nearest one.\nnode, arc_length [m], point "
      "(3,) [m]: exactly one of them; the node itself, or the position whose nearest node is held. point_frame: the frame in "
      "which the point is given, '' for the fixed one.\nname: of the new attachment; '': one is generated.\nframe_id: '' is the "
      "fixed frame. A frame that the world does not have is added, at the origin or where the robot has a link of that name; "
      "set_frame moves it.\noffset: (7,) x, y, z [m], qx, qy, qz, qw in the frame, or (3,) without rotation; None: the origin "
      "of the frame.\nclamp: holds direction and roll, too. keep_offset: keeps the present pose relative to the frame; offset is "
      "then ignored.\n\nReturns Pinned(name, node). Raises ValueError, or KeyError for the name of a cable or frame that does "
      "not exist; then nothing is changed.");
  methods.add_edit(
      "cut",
      [pieces](PythonWorld& self, const py::str& cable, std::optional<std::int64_t> node, std::optional<double> arc_length,
               const OptionalNumbers& point, const py::str& point_frame) {
        DrivenWorld& driven = self.driven();
        const CutAnswer answer = cut(read_place(cable, node, arc_length, point, point_frame), driven, self.events());
        return pieces(answer.first, answer.second);
      },
      py::arg("cable") = "", py::kw_only(), py::arg("node") = py::none(), py::arg("arc_length") = py::none(),
      py::arg("point") = py::none(), py::arg("point_frame") = "",
      "Removes the segment that starts at the node, or contains the arc length or the nearest point, as the service `cut` does; "
      "from a net, the links at the node, or the link nearest to the point. The mass stays on the nodes, and each piece keeps at "
      "least one segment. The arguments are those of `pin`.\n\nReturns Pieces(first, second): the first one keeps the name. "
      "Raises ValueError, KeyError; then nothing is changed.");
}

void add_loads(py::class_<PythonWorld>& world) {
  world.def("apply_force", apply_force, py::arg("cable"), py::arg("node"), py::arg("force"), py::kw_only(),
            py::arg("duration") = 0.0, py::arg("name") = "",
            "Lets a force (3,) [N], in the axes of the fixed frame, act on a node of a cable until it is changed, or for a "
            "duration [s]. name: of the load, which replaces the one of that name; '': one of its own for each node. A zero "
            "force ends it. It follows its node when others are cut off, joined or wound; when a winch takes the node in, or its "
            "time has run out, it ends with the event 'LOAD_ENDED'.\n\nRaises ValueError, KeyError; then nothing is changed.");
  world.def("apply_wrench", apply_wrench, py::arg("body"), py::arg("force"), py::arg("torque") = py::none(),
            py::arg("point") = py::none(), py::arg("local").noconvert() = false, py::kw_only(), py::arg("duration") = 0.0,
            py::arg("name") = "",
            "Lets a force (3,) [N] and a torque (3,) [N m] act on a body until they are changed, or for a duration [s]. point: "
            "(3,) [m] where the force acts, from the origin of the body's frame in its axes; None: at its center of mass. local: "
            "in the axes of the body, with which they turn; otherwise in those of the fixed frame. name: as for apply_force; '': "
            "the name of the body. Zero force and torque end it.\n\nRaises ValueError, KeyError; then nothing is changed.");
}

}  // namespace

void add_edit_methods(py::module_& module, py::class_<PythonWorld>& world, WorldMethods& methods) {
  add_cable_edits(module, methods);
  add_loads(world);
  methods.add_edit(
      "unpin", [](PythonWorld& self, const py::str& name) { unpin(text_of(name, "name"), self.driven(), self.events()); },
      py::arg("name"), "Removes an attachment of the scene or a pin. Raises KeyError, ValueError; then nothing is changed.");
  methods.add_edit(
      "join",
      [](PythonWorld& self, const py::str& first, bool first_at_end, const py::str& second, bool second_at_end) {
        DrivenWorld& driven = self.driven();
        return join(text_of(first, "first"), first_at_end, text_of(second, "second"), second_at_end, driven, self.events());
      },
      py::arg("first"), py::arg("first_at_end").noconvert(), py::arg("second"), py::arg("second_at_end").noconvert(),
      "Welds two ends of cables of the same material, as the service `join` does; ends that are apart are pulled "
      "together.\n\nReturns the name of the joined cable, which is that of the first. Raises ValueError, KeyError; then nothing "
      "is changed.");
  methods.add_edit(
      "set_length",
      [](PythonWorld& self, const py::str& cable, bool at_end, double length, double speed, double max_tension) {
        set_length(text_of(cable, "cable"), at_end, length, speed, max_tension, self.driven());
      },
      py::arg("cable"), py::arg("at_end").noconvert(), py::arg("length"), py::arg("speed"), py::arg("max_tension") = 0.0,
      "Lets a winch at the end (at_end) or the start of a cable pay out or take in cable, until it has the length [m], at up to "
      "the speed [m/s], as the service `set_length` does; the number of nodes changes. Rather than pull more than max_tension "
      "[N] (0: any tension) it stops, or slips and lets cable out, until it is told something else. Raises ValueError, KeyError; "
      "then nothing is changed.");
  methods.add_edit(
      "set_tension",
      [](PythonWorld& self, const py::str& cable, bool at_end, double tension, double max_speed, double min_length,
         double max_length) {
        set_tension(text_of(cable, "cable"), {0, at_end, tension, max_speed, min_length, max_length}, self.driven());
      },
      py::arg("cable"), py::arg("at_end").noconvert(), py::arg("tension"), py::arg("max_speed"), py::arg("min_length"),
      py::arg("max_length"),
      "Lets a winch at the end (at_end) or the start of a cable pay out and take in cable so that it leaves the winch with the "
      "tension [N], at up to max_speed [m/s], while the cable is from min_length to max_length [m] long, as the service "
      "`set_tension` does, until it is told something else. Tension 0: a spool that turns freely. Raises ValueError, KeyError; "
      "then nothing is changed.");
  methods.add_edit(
      "set_state",
      [](PythonWorld& self, const py::str& cable, const OptionalNumbers& positions, const OptionalNumbers& velocities,
         const OptionalNumbers& pose, const OptionalNumbers& twist, std::optional<double> arc_length) {
        set_states({{text_of(cable, "cable"), read_vectors("positions", positions), read_vectors("velocities", velocities),
                     read_body_pose("pose", pose), read_twist("twist", twist), arc_length}},
                   self.driven());
      },
      py::arg("cable"), py::arg("positions") = py::none(), py::arg("velocities") = py::none(), py::kw_only(),
      py::arg("pose") = py::none(), py::arg("twist") = py::none(), py::arg("arc_length") = py::none(),
      "Puts a cable, a body or a guide, by its name, elsewhere, or gives it another velocity. What is not given stays.\n\n"
      "positions, velocities: (n + 1, 3) [m], [m/s] of the nodes of a cable. They are projected as those of a scene are: held "
      "nodes stay where their holders are, and what cannot stretch keeps its length.\npose, twist: (7,) x, y, z [m], qx, qy, qz, "
      "qw of a body that only cables hold (of another one, that which it has), and (6,) [m/s], [rad/s] as body_twist(). Its "
      "cables go with it; what of the velocity they do not allow, the next step takes away.\narc_length: [m] at rest from the "
      "start of the cable to what is in a guide; material goes through it, and nodes with it.\nStretches of cable between what "
      "holds them keep their shapes, deeper or flatter as far as their lengths ask for it.\n\nRaises ValueError, also where no "
      "shape near the positions has the "
      "cable's lengths, or the polyline through them is more than 5 % off the cable's length at rest and as it is strained now, "
      "and KeyError; then nothing is changed.");
  methods.add_edit(
      "set_states", [](PythonWorld& self, const py::dict& states) { set_states(read_states(states), self.driven()); },
      py::arg("states"),
      "As set_state of several things at once, where one alone is not possible, such as both loads on a rope over a sheave: "
      "{'left_load': {'pose': (7,), 'twist': (6,)}, 'rope': {'positions': (n + 1, 3)}, 'sheave': {'arc_length': 0.6}}. First "
      "bodies, then guides, then cables are set; positions are given for as many nodes as the cable then has. Raises as "
      "set_state; then nothing is changed.");
  methods.add_edit(
      "move_attachment",
      [](PythonWorld& self, const py::str& name, const Numbers& offset) {
        DrivenWorld& driven = self.driven();
        move_attachment(text_of(name, "name"), read_offset(offset), driven);
      },
      py::arg("name"), py::arg("offset"),
      "Gives an attachment another pose in its frame: (7,) x, y, z [m], qx, qy, qz, qw, or (3,) without rotation. What it "
      "holds is moved there in the next step, as with set_frame, so make small changes. Raises ValueError, KeyError; then "
      "nothing is changed.");
  methods.add_edit(
      "set_frame", set_frame, py::arg("name"), py::arg("position"), py::arg("quaternion_xyzw"),
      "Sets the pose of a frame at the end of the next step and after it: position (3,) [m] and quaternion (4,) in the "
      "fixed frame; the quaternion is normalized, its norm must be from 0.5 to 2. settle() knows it only once that step is done. "
      "The frame then no longer follows a motion. Links of a robot below this frame follow it, unless their own pose is set. A "
      "frame of an attachment or "
      "guide that has neither a motion nor an initial_pose must be set before the first step: there it is at the start, "
      "too.\n\nRaises KeyError for a name that is not in frame_names, ValueError.");
  methods.add_edit(
      "add_frame", add_frame, py::arg("name"), py::arg("position"), py::arg("quaternion_xyzw"),
      "Adds a frame for pins and obstacles, at position (3,) [m] and quaternion (4,) in the fixed frame until set_frame "
      "moves it; the quaternion is normalized, its norm must be from 0.5 to 2. Raises ValueError, also if a frame has that "
      "name already.");
  methods.add_edit(
      "tune", tune_world, py::kw_only(), py::arg("gravity") = py::none(), py::arg("wind") = py::none(),
      py::arg("contact_friction") = py::none(), py::arg("materials") = std::map<std::string, std::map<std::string, Numbers>>{},
      "Changes parameters of the running simulation, as the node's `~tuning` does: gravity (3,) [m/s^2] unless it is "
      "central; wind (3,) [m/s], the velocity of the fluid; the coefficient of friction between cables; and {material: "
      "{key: number}} for dampings, finite stiffnesses (bending_stiffness also as (2,), for a material with two different "
      "ones), drag, friction, rolling_friction, hardening, bending_friction, and a yield_curvature that is finite in the scene: "
      "what is .inf there stays so.\n\nRaises SceneError with all errors at once, under the names of "
      "`~tuning`; ValueError, KeyError; then nothing is changed.");
}

}  // namespace verlet_cable
