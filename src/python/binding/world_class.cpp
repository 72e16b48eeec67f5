#include "binding/world_class.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "binding/arguments.h"
#include "binding/contact_array.h"
#include "binding/drawing.h"
#include "binding/edit_methods.h"
#include "binding/motion_argument.h"
#include "binding/run_steps.h"
#include "binding/scene_class.h"
#include "binding/text_arguments.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "world_events/status_log.h"

namespace verlet_cable {
namespace {

const World& use(const PythonWorld& world) {
  InUse::check(world.busy, "world");
  return world.driven.world();
}

std::unique_ptr<PythonWorld> make(const PythonScene& scene, const py::object& motion, const py::object& loads) {
  const Motion tracks = read_motion(motion, *scene.desc);
  const LoadPlayer player = read_loads(loads, *scene.desc);
  const py::gil_scoped_release release;
  auto world = std::make_unique<PythonWorld>(scene, DrivenWorld(scene.desc, tracks, player));
  world->events.observe_start(world->driven.world());
  return world;
}

std::unique_ptr<PythonWorld> copy(const PythonWorld& world) {
  use(world);
  return std::make_unique<PythonWorld>(world.scene, world.driven, world.events);
}

py::bytes save(const PythonWorld& world) {
  use(world);
  return world.driven.save();
}

std::unique_ptr<PythonWorld> load(const PythonScene& scene, const py::bytes& data) {
  const std::string bytes = data;
  const py::gil_scoped_release release;
  return std::make_unique<PythonWorld>(scene, DrivenWorld::load(*scene.desc, bytes));
}

void set_frame(PythonWorld& world, const py::str& name, const Numbers& position, const Numbers& quaternion_xyzw) {
  use(world);
  const int frame = world.driven.find_frame(text_of(name, "name"));
  if (!world.driven.set_frame(frame, {read_pose(position, quaternion_xyzw)})) return;
  world.events = {};
  world.events.observe_start(world.driven.world());
}

const char* step(PythonWorld& world, std::int64_t steps) {
  read_count("steps", steps, 0);
  const InUse in_use(world.busy, "world");
  if (steps > 0) world.driven.require_placed_frames();
  StepResult::Status worst = StepResult::Status::ok;
  run_steps(steps, [&](std::int64_t some) {
    for (std::int64_t i = 0; i < some; ++i) {
      const StepResult result = world.driven.step();
      worst = std::max(worst, result.status);
      world.events.observe(world.driven.world(), result, world.driven.held_back(), world.driven.refused_loads());
    }
  });
  return name_of(worst);
}

bool settle(PythonWorld& world) {
  const InUse in_use(world.busy, "world");
  world.driven.require_placed_frames();
  const py::gil_scoped_release release;
  const bool found = world.driven.world().settle();
  world.events.observe_start(world.driven.world());
  return found;
}

std::string represent(const PythonWorld& world) {
  const World& simulated = use(world);
  NameList cables;
  for (const SimulatedCable& cable : simulated.cables()) cables.add(cable.model->name);
  return "<World at " + rounded_text(simulated.time(), 6) + " s, cables: " + cables.text("none") + ">";
}

py::object draw(const py::object& world, const py::object& path, const py::object& view, const py::object& size) {
  return py::module_::import("verlet_cable.drawing").attr("draw")(world, path, view, size);
}

/// The method that reads a quantity.
template <Quantity quantity>
py::array_t<double> read(const PythonWorld& world, const py::str& name) {
  return array_of(use(world), quantity, text_of(name, argument_of(quantity)));
}

/// An attribute with the names of all items; an empty one is left out.
template <class Items, class Name>
auto names_of(const Items& items, const Name& name) {
  return [=](const PythonWorld& world) {
    std::vector<std::string> names;
    for (const auto& item : (use(world).*items)())
      if (const std::string& text = name(item); !text.empty()) names.push_back(text);
    return names;
  };
}

void add_names(py::class_<PythonWorld>& world) {
  world
      .def_property_readonly("cable_names", names_of(&World::cables, [](const SimulatedCable& c) { return c.model->name; }),
                             "Names of the present cables: those of the scene, then pieces from cuts and breaks.")
      .def_property_readonly("net_names", names_of(&World::nets, [](const SimulatedNet& net) { return net.model.name; }),
                             "Names of the nets.")
      .def_property_readonly("particle_names",
                             names_of(&World::particles, [](const SimulatedParticle& particle) { return particle.desc.name; }),
                             "Names of the particles.")
      .def_property_readonly(
          "body_names",
          names_of(&World::bodies, [](const SimulatedBody& body) { return body.is_junction ? std::string() : body.name; }),
          "Names of the rigid bodies.")
      .def_property_readonly("guide_names", names_of(&World::guides, [](const SimulatedGuide& guide) { return guide.name; }),
                             "Names of the guides.")
      .def_property_readonly(
          "attachment_names",
          names_of(&World::attachments, [](const Attachment& a) { return is_named(a) ? a.name : std::string(); }),
          "Names of the present attachments of cables, nets and bodies, including pins.")
      .def_property_readonly("obstacle_names",
                             names_of(&World::obstacles, [](const Obstacle& obstacle) { return obstacle.name; }),
                             "Names of the present obstacles, including the links of a robot.")
      .def_property_readonly(
          "frame_names",
          [](const PythonWorld& world) {
            use(world);
            return world.driven.frame_names();
          },
          "Names of the frames that set_frame can move, including those that pins and obstacles added.");
}

}  // namespace

void add_world_class(py::module_& module) {
  py::class_<PythonWorld> world(module, "World",
                                "A simulated scene. Frames follow the motion until set_frame moves them; those that the motion "
                                "does not name are at rest. Every returned array is a new copy, and read-only. Only one thread "
                                "at a time may use a world; other threads run while it steps.");
  world
      .def(py::init(&make), py::arg("scene"), py::arg("motion") = py::none(), py::arg("loads") = py::none(),
           "motion: the path of a CSV file as for cable_sim --motion, or {frame: (times (k,) [s], poses (k, 7))}; poses are x, "
           "y, z [m], qx, qy, qz, qw in the fixed frame. Quaternions are normalized; their norm must be from 0.5 to 2, or in a "
           "file just not 0.\n\nloads: the path of a CSV file as for cable_sim --loads.\n\nRaises SceneError, ValueError, "
           "KeyError.")
      .def("set_frame", set_frame, py::arg("name"), py::arg("position"), py::arg("quaternion_xyzw"),
           "Sets the pose of a frame at the end of the next step and after it: position (3,) [m] and quaternion (4,) in the "
           "fixed frame; the quaternion is normalized, its norm must be from 0.5 to 2. The frame then no longer follows a "
           "motion. Links of a robot below this frame follow it, unless their own pose is set. A frame of an attachment or guide "
           "that has neither a motion nor an initial_pose must be set before the first step: there it is at the start, too.\n\n"
           "Raises KeyError for a name that is not in frame_names, ValueError.")
      .def(
          "step", step, py::arg("steps") = 1,
          "Advances by a number of time steps. Returns their worst status, from good to bad 'ok', 'jumped', 'overstretched', "
          "'inside_obstacle', 'not_settled', 'degraded' or 'fault'. Other threads run meanwhile; Ctrl-C ends it between two "
          "steps.\n\nRaises ValueError if nothing has placed the frame of an attachment or guide; the message names all of them.")
      .def(
          "settle", settle,
          "Puts the held cables into static equilibrium, with the frames where they are. False if one of them does not reach it; "
          "the status is then 'not_settled' until the next step is done. Raises ValueError as step().")
      .def("__repr__", represent)
      .def("save", save,
           "The world as bytes, from which load() goes on with the same bytes as a copy would: its state, motion and poses that "
           "were set, but not its events. They are for this version of the package on this kind of machine. A pickle has them "
           "with the scene.")
      .def_static("load", load, py::arg("scene"), py::arg("data"),
                  "The world of which save() returned the bytes `data`, or the service save_state wrote them to a file: there, "
                  "frames then rest. `scene` may differ from its scene in numbers, which are those that it had.\n\nRaises "
                  "ValueError that says what is wrong with the bytes.")
      .def(py::pickle([](const PythonWorld& world) { return py::make_tuple(parts_of(world.scene), save(world)); },
                      [](const py::tuple& parts) { return load(scene_of_parts(parts[0]), py::bytes(parts[1])); }))
      .def_property_readonly(
          "scene", [](const PythonWorld& world) { return world.scene; },
          "The scene that the world was made of, without what tune() has changed.")
      .def("copy", copy, "An independent copy, which continues from here with the same bytes.")
      .def("__copy__", copy)
      .def(
          "__deepcopy__", [](const PythonWorld& world, const py::dict&) { return copy(world); }, py::arg("memo"))
      .def("positions", read<Quantity::positions>, py::arg("name"),
           "(n + 1, 3) [m] of the nodes of a cable; likewise of a net or a particle.")
      .def("velocities", read<Quantity::velocities>, py::arg("name"),
           "(n + 1, 3) [m/s] of the nodes of a cable; likewise of a net or a particle.")
      .def("tension", read<Quantity::tension>, py::arg("name"),
           "(n,) [N] of the segments of a cable or the links of a net, mean over the last step; tension is positive.")
      .def("curvature", read<Quantity::curvature>, py::arg("name"), "(n - 1,) [1/m] at the inner nodes of a cable.")
      .def("twist", read<Quantity::twist>, py::arg("name"), "(n - 1,) [rad/m] at the inner nodes of a cable.")
      .def("plastic_curvature", read<Quantity::plastic_curvature>, py::arg("name"),
           "(n - 1,) [1/m] at the inner nodes of a cable: by which yielding has bent what carries no moment; 0 where nothing can "
           "yield.")
      .def("orientations", read<Quantity::orientations>, py::arg("name"),
           "(n, 4) quaternions x, y, z, w of the segments of a cable: the x axis along the segment, with the roll of the "
           "material.")
      .def("wrench", read<Quantity::wrench>, py::arg("attachment"),
           "(6,) force [N] and torque [N m] on the holder, in the axes of the fixed frame, mean over the last step; the torque "
           "is about the point of the attachment.")
      .def(
          "contacts", [](const PythonWorld& world) { return contact_array(use(world)); },
          "Where cables touched obstacles, bodies and cables in the last step: a structured array with the fields of Contact.msg "
          "after that of the cable: cable, segment, position (3,) [m] on its centre line, normal (3,) out of what is touched, "
          "force (3,) [N] on the cable, mean over the step, and other, the name of what is touched. Contacts of cables with "
          "cables are there twice, once for each. After an edit there are none until the next step.")
      .def(
          "contact_force", read<Quantity::contact_force>, py::arg("name"),
          "(6,) force [N] and torque [N m] of the cables and bodies that touch an obstacle, a link of a robot (with all that "
          "follows its frame) or a body, on it, in the axes of the fixed frame, mean over the last step; the torque is about the "
          "origin of its frame.")
      .def("body_pose", read<Quantity::body_pose>, py::arg("name"), "(7,) x, y, z [m], qx, qy, qz, qw of the frame of a body.")
      .def(
          "body_twist", read<Quantity::body_twist>, py::arg("name"),
          "(6,) velocity [m/s] of the center of mass of a body and its angular velocity [rad/s], in the axes of the fixed frame.")
      .def(
          "energy", [](const PythonWorld& world) { return energy_dict(use(world).energy()); },
          "Dict with kinetic, gravity, stretch, bend, twist and total [J], as in the summary of cable_sim.")
      .def(
          "ledger", [](const PythonWorld& world) { return ledger_dict(use(world).ledger()); },
          "Where energy [J] has come from and gone since the start: a dict with the dicts work (attachments, winches, obstacles, "
          "applied) and dissipated (axial, bending, torsional, yielding, drag, contact, guides, bodies, unresolved, edits), "
          "change (of energy()['total']), unaccounted (change - work + dissipated: rounding and tolerances) and "
          "unaccounted_steps (in which that was too much).")
      .def("draw", draw, py::arg("path") = py::none(), py::arg("view") = py::none(), py::arg("size") = py::make_tuple(800, 600),
           "A picture of the cables, nets, particles, bodies and obstacles as they are now, by matplotlib, which needs no "
           "display: "
           "written to the file `path`, whose name ends in .png, or without a path returned as the bytes of a PNG file. `view`: "
           "(elevation, azimuth) [degree] from which it is seen, the latter from +x towards +y; None: one that shows the cables "
           "from their broad side. `size`: (width, height) in pixels. Axes are equal, in metres; cables thinner than two pixels "
           "are "
           "drawn that thick. Notebooks show a world by it.\n\nRaises ImportError without matplotlib, ValueError, OSError.")
      .def("_repr_png_", [](const py::object& world) { return world.attr("draw")(); })
      .def("_shapes", [](const PythonWorld& world) { return drawn_shapes(use(world)); })
      .def_property_readonly(
          "time", [](const PythonWorld& world) { return use(world).time(); }, "[s] Simulated time.")
      .def_property_readonly(
          "state_hash", [](const PythonWorld& world) { return hash_text(use(world).hash()); },
          "Hash (16 hexadecimal digits) of everything in the world on which its future depends, as in the summary of cable_sim. "
          "It covers neither the motion nor poses that set_frame has set for the next step.");
  add_names(world);
  add_edit_methods(module, world);
  add_obstacle_methods(world);
}

}  // namespace verlet_cable
