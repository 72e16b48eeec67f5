#include "binding/world_class.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "binding/appearance.h"
#include "binding/arguments.h"
#include "binding/contact_array.h"
#include "binding/drawing.h"
#include "binding/drawings.h"
#include "binding/edit_methods.h"
#include "binding/motion_argument.h"
#include "binding/pickle_protocol.h"
#include "binding/run_steps.h"
#include "binding/scene_class.h"
#include "binding/sensitivity_methods.h"
#include "binding/text_arguments.h"
#include "verlet_cable/core/name_list.h"
#include "verlet_cable/core/number_text.h"
#include "world_events/status_log.h"

namespace verlet_cable {
namespace {

class OwnWorld : public PythonWorld {
 public:
  OwnWorld(PythonScene scene, DrivenWorld world, EventRecord events)
      : scene_(std::move(scene)), driven_(std::move(world)), events_(std::move(events)) {}

  const PythonScene& scene() override { return scene_; }
  DrivenWorld& driven() override { return driven_; }
  EventRecord& events() override { return events_; }
  bool& busy() override { return busy_; }
  const char* used() const override { return "world"; }
  std::optional<Sensitivity>* tracked() override { return &tracked_; }

 private:
  PythonScene scene_;
  DrivenWorld driven_;
  EventRecord events_;
  bool busy_ = false;
  std::optional<Sensitivity> tracked_;
};

std::unique_ptr<PythonWorld> make(const PythonScene& scene, const py::object& motion, const py::object& loads) {
  const Motion tracks = read_motion(motion, *scene.desc);
  const LoadPlayer player = read_loads(loads, *scene.desc);
  const py::gil_scoped_release release;
  std::unique_ptr<PythonWorld> world = own_world(scene, DrivenWorld(scene.desc, tracks, player));
  world->events().observe_start(world->driven().world());
  return world;
}

std::unique_ptr<PythonWorld> copied_world(PythonWorld& world) {
  world.world();
  std::unique_ptr<PythonWorld> copied = own_world(world.scene(), world.driven(), world.events());
  copied->driven().world().step_one_by_one(false);
  return copied;
}

py::bytes saved(PythonWorld& world) {
  world.world();
  return world.driven().save();
}

std::unique_ptr<PythonWorld> load(const PythonScene& scene, const py::buffer& data) {
  const auto copied = py::reinterpret_steal<py::bytes>(PyBytes_FromObject(data.ptr()));
  if (!copied) throw py::error_already_set();
  const std::string bytes = copied;
  const py::gil_scoped_release release;
  std::unique_ptr<PythonWorld> world = own_world(scene, DrivenWorld::load(*scene.desc, bytes));
  world->events().observe_restored(world->driven().world());
  return world;
}

/// With the events that were not retrieved yet, as a copy has them.
py::tuple pickled(PythonWorld& world) {
  return py::make_tuple(parts_of(world.scene()), saved(world), py::bytes(world.events().save()));
}

std::unique_ptr<PythonWorld> unpickled(const py::tuple& parts) {
  std::unique_ptr<PythonWorld> world = load(scene_of_parts(parts[0]), py::bytes(parts[1]));
  world->events() = EventRecord(parts[2].cast<std::string>());
  return world;
}

const char* step(PythonWorld& world, std::int64_t steps) {
  read_count("steps", steps, 0);
  const InUse in_use(world.busy(), world.used());
  DrivenWorld& driven = world.driven();
  if (steps > 0) driven.require_placed_frames();
  std::optional<Sensitivity>* const tracked = world.tracked();
  const bool follows = tracked != nullptr && tracked->has_value();
  StepResult::Status worst = StepResult::Status::ok;
  world.has_changed();
  run_steps(steps, [&](std::int64_t some) {
    for (std::int64_t i = 0; i < some; ++i) {
      const StepResult result = follows ? (*tracked)->step(driven.world(), driven.next_inputs()) : driven.step();
      worst = std::max(worst, result.status);
      world.events().observe(driven.world(), result, driven.held_back(), driven.refused_loads());
    }
  });
  return name_of(worst);
}

bool settle(PythonWorld& world) {
  const InUse in_use(world.busy(), world.used());
  world.driven().require_placed_frames();
  world.has_changed();
  const py::gil_scoped_release release;
  const bool found = world.driven().world().settle();
  world.events().observe_start(world.driven().world());
  return found;
}

std::string represent(PythonWorld& world) {
  const World& simulated = world.world();
  NameList cables;
  for (const SimulatedCable& cable : simulated.cables()) cables.add(cable.model->name);
  return "<World at " + rounded_text(simulated.time(), 6) + " s, cables: " + cables.text("none") + ">";
}

py::object draw(const py::object& world, const py::object& path, const py::object& view, const py::object& size) {
  return py::module_::import("verlet_cable.drawing").attr("draw")(world, path, view, size);
}

/// For verlet_cable.camera, and the time [s].
py::tuple drawings(PythonWorld& world, const py::dict& appearance) {
  const World& simulated = world.world();
  py::list times;
  times.append(simulated.time());
  return py::make_tuple(capsule_of({Appearance(appearance).drawing_of(simulated)}), times);
}

/// The method that reads a quantity.
template <Quantity quantity>
py::array_t<double> read(PythonWorld& world, const py::str& name) {
  return array_of(world.world(), quantity, text_of(name, argument_of(quantity)));
}

/// An attribute with the names of all items; an empty one is left out.
template <class Items, class Name>
auto names_of(const Items& items, const Name& name) {
  return [=](PythonWorld& world) {
    std::vector<std::string> names;
    for (const auto& item : (world.world().*items)())
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
          [](PythonWorld& world) {
            world.world();
            return world.driven().frame_names();
          },
          "Names of the frames that set_frame can move, including those that pins and obstacles added.");
}

}  // namespace

const World& PythonWorld::world() {
  InUse::check(busy(), used());
  return driven().world();
}

std::unique_ptr<PythonWorld> own_world(PythonScene scene, DrivenWorld world, EventRecord events) {
  return std::make_unique<OwnWorld>(std::move(scene), std::move(world), std::move(events));
}

py::class_<PythonWorld> add_world_class(py::module_& module) {
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
      .def(
          "step", step, py::arg("steps") = 1,
          "Advances by a number of time steps. Returns their worst status, from good to bad 'ok', 'jumped', 'overstretched', "
          "'inside_obstacle', 'not_settled', 'degraded' or 'fault'. Other threads run meanwhile; Ctrl-C ends it between two "
          "steps.\n\nRaises ValueError if nothing has placed the frame of an attachment or guide; the message names all of them.")
      .def("settle", settle,
           "Puts the held cables into static equilibrium, with the frames where they are now: a pose that set_frame has set is "
           "that "
           "of the end of the next step, so make that step first. False if one of them does not reach it; the status is then "
           "'not_settled' until the next step is done. Raises ValueError as step().")
      .def("__repr__", represent)
      .def_static("load", load, py::arg("scene"), py::arg("data"),
                  "The world of which save() returned the bytes `data`, or the service save_state wrote them to a file: there, "
                  "frames then rest. `scene` may differ from its scene in numbers, such as materials, lengths and poses: cables, "
                  "nets and the "
                  "materials then have those of the bytes. Names, types, numbers of segments, and the time step must be the "
                  "same.\n\nRaises ValueError that says what is wrong with the bytes, or how the scenes differ.")
      .def(py::pickle(&pickled, &unpickled))
      .def("__reduce_ex__", reduce, py::arg("protocol"))
      .def_property_readonly(
          "scene", [](PythonWorld& world) { return world.scene(); },
          "The scene that the world was made of, without what tune() has changed.")
      .def("copy", copied_world, "An independent copy, which continues from here with the same bytes.")
      .def("__copy__", copied_world)
      .def(
          "__deepcopy__", [](PythonWorld& world, const py::dict&) { return copied_world(world); }, py::arg("memo"))
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
          "contact_force", read<Quantity::contact_force>, py::arg("name"),
          "(6,) force [N] and torque [N m] of the cables and bodies that touch an obstacle, a link of a robot (with all that "
          "follows its frame) or a body, on it, in the axes of the fixed frame, mean over the last step; the torque is about the "
          "origin of its frame.")
      .def("body_pose", read<Quantity::body_pose>, py::arg("name"), "(7,) x, y, z [m], qx, qy, qz, qw of the frame of a body.")
      .def(
          "body_twist", read<Quantity::body_twist>, py::arg("name"),
          "(6,) velocity [m/s] of the center of mass of a body and its angular velocity [rad/s], in the axes of the fixed frame.")
      .def(
          "energy", [](PythonWorld& world) { return energy_dict(world.world().energy()); },
          "Dict with kinetic, gravity, stretch, bend, twist and total [J], as in the summary of cable_sim.")
      .def("draw", draw, py::arg("path") = py::none(), py::arg("view") = py::none(), py::arg("size") = py::make_tuple(800, 600),
           "A picture of the cables, nets, particles, bodies and obstacles as they are now, by verlet_cable.camera where that is "
           "built, else by matplotlib with axes in metres; neither needs a display: written to the file `path`, whose name ends "
           "in "
           ".png, or without a path returned as the bytes of a PNG file. `view`: (elevation, azimuth) [degree] from which it is "
           "seen, the latter from +x towards +y; None: one that shows the cables from their broad side. `size`: (width, height) "
           "in "
           "pixels. Cables thinner than two pixels are drawn that thick; cables of the same color are told apart by others. "
           "Notebooks show a world by it.\n\nRaises ImportError without matplotlib, ValueError, OSError.")
      .def("_repr_png_", [](const py::object& world) { return world.attr("draw")(); })
      .def("_shapes", [](PythonWorld& world) { return drawn_shapes(world.world()); })
      .def("_drawings", drawings)
      .def_property_readonly(
          "time", [](PythonWorld& world) { return world.world().time(); }, "[s] Simulated time.")
      .def_property_readonly(
          "state_hash", [](PythonWorld& world) { return hash_text(world.world().hash()); },
          "Hash (16 hexadecimal digits) of everything in the world on which its future depends, as in the summary of cable_sim. "
          "It covers neither the motion nor poses that set_frame has set for the next step.");
  add_names(world);
  add_sensitivity_methods(world);
  return world;
}

}  // namespace verlet_cable
