#include "binding/batch_class.h"

#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "binding/arguments.h"
#include "binding/batch_arguments.h"
#include "binding/batch_arrays.h"
#include "binding/contact_array.h"
#include "binding/edit_methods.h"
#include "binding/motion_argument.h"
#include "binding/run_steps.h"
#include "binding/scene_class.h"
#include "binding/text_arguments.h"
#include "binding/world_class.h"
#include "simulation/batch.h"
#include "simulation/edits.h"

namespace verlet_cable {
namespace {

constexpr int most_threads = 1024;
constexpr std::int64_t most_worlds = 1000000;

/// What Python calls a Batch.
struct PythonBatch {
  PythonScene scene;  ///< of the first world, when it began
  int threads = 0;    ///< as asked for
  Batch batch;
  bool busy = false;  ///< in use by a thread that has let others run

  PythonBatch(PythonScene made_of, int count, Batch worlds)
      : scene(std::move(made_of)), threads(count), batch(std::move(worlds)) {}
};

const Batch& use(const PythonBatch& batch) {
  InUse::check(batch.busy, "batch");
  return batch.batch;
}

void check_size(std::int64_t count, int threads) {
  if (count < 1 || count > most_worlds)
    throw py::value_error("count: " + std::to_string(count) + "; allowed: 1 to " + std::to_string(most_worlds));
  if (threads < 0 || threads > most_threads)
    throw py::value_error("threads: " + std::to_string(threads) + "; allowed: 0, as many as there are cores, to " +
                          std::to_string(most_threads));
}

std::unique_ptr<PythonBatch> make_of(const PythonScene& first, const std::vector<std::shared_ptr<const SceneDesc>>& scenes,
                                     const py::object& motion, const py::object& loads, int threads) {
  const Motion tracks = read_motion(motion, *scenes.front());
  const LoadPlayer player = read_loads(loads, *scenes.front());
  const py::gil_scoped_release release;
  return std::make_unique<PythonBatch>(first, threads, Batch(scenes, tracks, player, threads));
}

std::unique_ptr<PythonBatch> make(const PythonScene& scene, std::int64_t count, const py::object& motion, int threads,
                                  const py::object& loads) {
  check_size(count, threads);
  return make_of(scene, std::vector<std::shared_ptr<const SceneDesc>>(static_cast<std::size_t>(count), scene.desc), motion, loads,
                 threads);
}

std::unique_ptr<PythonBatch> make_from_list(const std::vector<PythonScene>& scenes, const py::object& motion, int threads,
                                            const py::object& loads) {
  if (scenes.empty()) throw py::value_error("scenes: none; allowed: at least one");
  check_size(static_cast<std::int64_t>(scenes.size()), threads);
  std::vector<std::shared_ptr<const SceneDesc>> descs;
  for (const PythonScene& scene : scenes) descs.push_back(scene.desc);
  return make_of(scenes.front(), descs, motion, loads, threads);
}

std::unique_ptr<PythonBatch> make_of_world(PythonWorld& world, std::int64_t count, int threads) {
  check_size(count, threads);
  const InUse in_use(world.busy, "world");
  const py::gil_scoped_release release;
  return std::make_unique<PythonBatch>(world.scene, threads, Batch(world.driven, static_cast<std::size_t>(count), threads));
}

void set_material(PythonBatch& batch, const py::str& name, const py::kwargs& fields) {
  const std::string material = text_of(name, "name");
  std::vector<MaterialChange> changes;
  for (const auto& [key, value] : fields) {
    const std::string field = text_of(key, "key");
    const Numbers numbers = Numbers::ensure(value);
    if (!numbers) throw py::value_error(field + ": " + ascii_text(value) + "; allowed: numbers");
    changes.push_back({field, read_values(field, numbers, use(batch).size())});
  }
  const InUse in_use(batch.busy, "batch");
  const py::gil_scoped_release release;
  batch.batch.set_material(material, changes);
}

void set_frames(PythonBatch& batch, const py::str& name, const Numbers& poses) {
  const std::string frame = text_of(name, "name");
  std::vector<std::vector<Pose>> all = read_poses(poses, use(batch).size());
  const InUse in_use(batch.busy, "batch");
  const py::gil_scoped_release release;
  batch.batch.set_frame(frame, std::move(all));
}

/// Calls visit(i) for each; errors name the world, where there are several.
template <class Visit>
void for_each_world(const Batch& batch, const Visit& visit) {
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const auto named = [&](const char* message) { return "world " + std::to_string(i) + ": " + message; };
    try {
      visit(i);
    } catch (const UnknownName& error) {
      throw UnknownName(named(error.what()));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument(named(error.what()));
    }
  }
}

void apply_force(PythonBatch& batch, const py::str& cable, std::int64_t node, const Numbers& forces, double duration,
                 const py::str& name) {
  const Batch& worlds = use(batch);
  const std::vector<Vector3> read = read_vectors("forces", forces, worlds.size());
  const std::string on = text_of(cable, "cable"), load_name = text_of(name, "name");
  std::vector<edit::ApplyLoad> loads;
  for_each_world(worlds, [&](std::size_t i) {
    loads.push_back(checked_force(on, node, {load_name, "", {}, read[i], Vector3::Zero(), duration}, worlds[i].world()));
  });
  batch.batch.apply(loads);
}

void apply_wrench(PythonBatch& batch, const py::str& body, const Numbers& forces, const std::optional<Numbers>& torques,
                  const std::optional<Numbers>& point, bool local, double duration, const py::str& name) {
  const Batch& worlds = use(batch);
  const std::vector<Vector3> read = read_vectors("forces", forces, worlds.size());
  std::vector<Vector3> turning(worlds.size(), Vector3::Zero());
  if (torques) turning = read_vectors("torques", *torques, worlds.size());
  const std::optional<Vector3> where = read_point(point);
  const std::string on = text_of(body, "body"), load_name = text_of(name, "name");
  std::vector<edit::ApplyLoad> loads;
  for_each_world(worlds, [&](std::size_t i) {
    loads.push_back(checked_wrench(on, local, {load_name, "", where, read[i], turning[i], duration}, worlds[i].world()));
  });
  batch.batch.apply(loads);
}

void set_world(PythonBatch& batch, const py::object& index, PythonWorld& world) {
  const std::vector<std::size_t> indices = read_world_indices(index, use(batch).size());
  const InUse in_use(batch.busy, "batch"), world_in_use(world.busy, "world");
  const py::gil_scoped_release release;
  batch.batch.set_worlds(indices, world.driven);
}

void step(PythonBatch& batch, std::int64_t steps, std::int64_t record_every, const std::vector<py::str>& fields) {
  read_count("steps", steps, 0);
  read_count("record_every", record_every, 0);
  if (record_every > 0 && steps % record_every != 0)
    throw py::value_error("record_every: " + std::to_string(record_every) + "; allowed: what divides steps, " +
                          std::to_string(steps));
  const std::vector<Quantity> quantities = read_quantities("fields", fields);
  const InUse in_use(batch.busy, "batch");
  if (steps > 0) batch.batch.require_placed_frames();
  batch.batch.begin_steps(steps, record_every, quantities);
  try {
    run_steps(steps, [&](std::int64_t some) { batch.batch.advance(some); });
  } catch (...) {
    batch.batch.drop_records();
    throw;
  }
}

/// The method that reads a quantity.
template <Quantity quantity>
py::array_t<double> read(PythonBatch& batch, const py::str& name) {
  const InUse in_use(batch.busy, "batch");
  return array_of(batch.batch, quantity, text_of(name, argument_of(quantity)));
}

py::array_t<double> observe(PythonBatch& batch, const std::vector<GivenPart>& parts) {
  const InUse in_use(batch.busy, "batch");
  return observations(batch.batch, parts);
}

std::unique_ptr<PythonWorld> world_at(const PythonBatch& batch, std::int64_t index) {
  const Batch& worlds = use(batch);
  auto world = std::make_unique<PythonWorld>(batch.scene, worlds[read_world_index(index, worlds.size())]);
  world->driven.world().step_one_by_one(false);
  return world;
}

std::unique_ptr<PythonBatch> copy(const PythonBatch& batch) {
  return std::make_unique<PythonBatch>(batch.scene, batch.threads, use(batch));
}

py::bytes save(const PythonBatch& batch, std::int64_t world) {
  const Batch& worlds = use(batch);
  return worlds[read_world_index(world, worlds.size())].save();
}

py::tuple pickled(const PythonBatch& batch) {
  py::list worlds;
  for (std::size_t i = 0; i < use(batch).size(); ++i) worlds.append(py::bytes(batch.batch[i].save()));
  return py::make_tuple(parts_of(batch.scene), batch.threads, worlds);
}

std::unique_ptr<PythonBatch> unpickled(const py::tuple& parts) {
  PythonScene scene = scene_of_parts(parts[0]);
  std::vector<DrivenWorld> worlds;
  for (const py::handle& data : parts[2]) worlds.push_back(DrivenWorld::load(*scene.desc, data.cast<std::string>()));
  const int threads = parts[1].cast<int>();
  return std::make_unique<PythonBatch>(std::move(scene), threads, Batch(std::move(worlds), threads));
}

py::array_t<bool> settle(PythonBatch& batch) {
  const InUse in_use(batch.busy, "batch");
  batch.batch.require_placed_frames();
  std::vector<char> found;
  {
    const py::gil_scoped_release release;
    found = batch.batch.settle();
    batch.batch.drop_records();
  }
  py::array_t<bool> array(static_cast<py::ssize_t>(found.size()));
  for (std::size_t i = 0; i < found.size(); ++i) array.mutable_at(i) = found[i] != 0;
  return read_only(std::move(array));
}

std::string represent(const PythonBatch& batch) {
  return "<Batch of " + std::to_string(use(batch).size()) + " worlds>";
}

}  // namespace

void add_batch_class(py::module_& module) {
  py::class_<PythonBatch>(
      module, "Batch",
      "Worlds that differ only in numbers and are stepped together. This is faster than one after another and gives the same "
      "bytes as each alone, with any number of threads. Only one thread at a time may use a batch; other threads run while it "
      "steps.\n\nThe first axis of arrays is that of the worlds. After a step with `record_every`, the second axis is that of "
      "the records, and the arrays are views; otherwise they are new copies. All of them are read-only.")
      .def(py::init(&make), py::arg("scene"), py::arg("count"), py::arg("motion") = py::none(), py::arg("threads") = 0,
           py::arg("loads") = py::none(),
           "`count` worlds of a scene. motion, loads: as for World, the same for all. threads: 0 is one per core.")
      .def(py::init(&make_from_list), py::arg("scenes"), py::arg("motion") = py::none(), py::arg("threads") = 0,
           py::arg("loads") = py::none(),
           "A world for each scene of a list. The scenes may differ only in numbers: their names, numbers of segments and time "
           "steps must be the same.")
      .def(py::init(&make_of_world), py::arg("world"), py::arg("count"), py::arg("threads") = 0,
           "`count` copies of a world in its present state, with its time, motion, poses that were set, and edits. Each "
           "continues with the same bytes as the world would.")
      .def("__repr__", represent)
      .def("__len__", [](const PythonBatch& batch) { return use(batch).size(); })
      .def("set_world", set_world, py::arg("index"), py::arg("world"),
           "Replaces worlds by copies of `world`, with its time, motion and poses that were set: to restart some of them, or to "
           "give all a common start. index: an integer (negative ones count from the end), a sequence of integers, or a bool "
           "mask (count,). A copy takes less time than a step, however long it took to make the world. The records of the last "
           "step are dropped; `status` of these worlds is 0.\n\nRaises IndexError; ValueError for another kind of index, or if "
           "the scene of the world differs from that of the batch in more than numbers: names, numbers of segments and time step "
           "must be the same. Then nothing is changed.")
      .def("set_material", set_material, py::arg("name"),
           "Changes keys of a material, such as linear_density=... or bending_stiffness=...; the values are a number, or "
           "(count,), or for bending_stiffness (count, 2). Worlds that were not yet stepped, settled or edited are started anew "
           "with it; for others, all keys except linear_density can be changed.\n\nRaises SceneError with all errors at once, "
           "ValueError, KeyError; then nothing is changed.")
      .def(
          "set_frames", set_frames, py::arg("name"), py::arg("poses"),
          "Sets the poses of a frame. (count, 7): at the end of the next step and after it; (count, steps, 7): at the end of "
          "each of the next steps, and the last one from then on. A pose is x, y, z [m], qx, qy, qz, qw in the fixed frame; "
          "quaternions are normalized, their norms must be from 0.5 to 2. As with World.set_frame, a frame that nothing else has "
          "placed is at its first pose from the start on.\n\nRaises KeyError, ValueError.")
      .def("apply_force", apply_force, py::arg("cable"), py::arg("node"), py::arg("forces"), py::kw_only(),
           py::arg("duration") = 0.0, py::arg("name") = "",
           "As World.apply_force in each world. forces: (count, 3), or (3,) for all [N].")
      .def("apply_wrench", apply_wrench, py::arg("body"), py::arg("forces"), py::arg("torques") = py::none(),
           py::arg("point") = py::none(), py::arg("local").noconvert() = false, py::kw_only(), py::arg("duration") = 0.0,
           py::arg("name") = "",
           "As World.apply_wrench in each world. forces: (count, 3), or (3,) for all [N]; torques likewise [N m], None: zero. If "
           "any of them cannot be applied, nothing is changed.")
      .def(
          "step", step, py::arg("steps") = 1, py::arg("record_every") = 0,
          py::arg("fields") = std::vector<std::string>{"positions", "velocities", "tension", "wrench", "body_pose", "body_twist"},
          "Advances all worlds by a number of time steps. record_every: a divisor of `steps`; the quantities in `fields` are "
          "recorded each time that many steps are done. Other threads run meanwhile; Ctrl-C ends it between two steps, without "
          "records. Raises ValueError as World.step, for the first world that lacks the pose of a frame.")
      .def("settle", settle, "As World.settle; (count,) bool.")
      .def("copy", copy, "An independent copy, which continues from here with the same bytes.")
      .def("__copy__", copy)
      .def(
          "__deepcopy__", [](const PythonBatch& batch, const py::dict&) { return copy(batch); }, py::arg("memo"))
      .def("save", save, py::arg("world"), "As World.save, of one of the worlds.")
      .def(py::pickle(&pickled, &unpickled))
      .def("world", world_at, py::arg("index"), "A copy of one of the worlds, without its earlier events.")
      .def(
          "events",
          [event_type = py::object(module.attr("Event"))](PythonBatch& self, std::int64_t world) {
            const std::size_t index = read_world_index(world, use(self).size());
            return take_events(self.batch.events(index), event_type);
          },
          py::arg("world"), "As World.events, of one of the worlds, since it began, was replaced or was asked for last.")
      .def(
          "loads",
          [load_type = py::object(module.attr("Load"))](const PythonBatch& self, std::int64_t world) {
            return load_list(use(self)[read_world_index(world, use(self).size())].world(), load_type);
          },
          py::arg("world"), "As World.loads, of one of the worlds.")
      .def("positions", read<Quantity::positions>, py::arg("name"), "(count, n + 1, 3) or (count, records, n + 1, 3) [m].")
      .def("velocities", read<Quantity::velocities>, py::arg("name"), "(count, n + 1, 3) or (count, records, n + 1, 3) [m/s].")
      .def("tension", read<Quantity::tension>, py::arg("name"), "(count, n) or (count, records, n) [N].")
      .def("curvature", read<Quantity::curvature>, py::arg("name"), "(count, n - 1) or (count, records, n - 1) [1/m].")
      .def("twist", read<Quantity::twist>, py::arg("name"), "(count, n - 1) or (count, records, n - 1) [rad/m].")
      .def("plastic_curvature", read<Quantity::plastic_curvature>, py::arg("name"),
           "(count, n - 1) or (count, records, n - 1) [1/m].")
      .def("orientations", read<Quantity::orientations>, py::arg("name"), "(count, n, 4) or (count, records, n, 4): x, y, z, w.")
      .def("wrench", read<Quantity::wrench>, py::arg("attachment"), "(count, 6) or (count, records, 6) [N, N m].")
      .def(
          "contacts",
          [](const PythonBatch& self, std::int64_t world) {
            return contact_array(use(self)[read_world_index(world, use(self).size())].world());
          },
          py::arg("world"), "As World.contacts, of one of the worlds.")
      .def("contact_force", read<Quantity::contact_force>, py::arg("name"),
           "(count, 6) or (count, records, 6) [N, N m], as World.contact_force.")
      .def("body_pose", read<Quantity::body_pose>, py::arg("name"), "(count, 7) or (count, records, 7).")
      .def("body_twist", read<Quantity::body_twist>, py::arg("name"), "(count, 6) or (count, records, 6) [m/s, rad/s].")
      .def("observations", observe, py::arg("parts"),
           "(count, k) float64: for each world, the present values of all `parts`, flattened and concatenated. parts: "
           "[(quantity, name), ...], where the quantities are the names of the methods that read arrays, with their units and "
           "order: [('positions', 'rope'), ('wrench', 'left')]. ('positions', 'rope', 20), and velocities likewise, gives 20 "
           "points instead of nodes, evenly spaced from end to end along the cable that has this name now. This also works if "
           "the cables differ in their numbers of nodes because they slide through guides, were cut or changed in length, or "
           "broke. The array is new and in C order.\n\nRaises KeyError for names, ValueError for quantities and numbers of "
           "points, and if a world has not as many nodes as the others.")
      .def(
          "ledger",
          [](const PythonBatch& self, std::int64_t world) {
            return ledger_dict(use(self)[read_world_index(world, use(self).size())].world().ledger());
          },
          py::arg("world"), "As World.ledger, of one of the worlds.")
      .def(
          "energy", [](const PythonBatch& batch) { return energies(use(batch)); }, "Energies [J] as World.energy, (count,) each.")
      .def_property_readonly(
          "status", [](const PythonBatch& batch) { return statuses(use(batch)); },
          "(count,) int8, the worst status in the last call of step(): 0 ok, 1 jumped, 2 overstretched, 3 inside_obstacle, "
          "4 not_settled, 5 degraded, 6 fault.")
      .def_property_readonly(
          "time", [](const PythonBatch& batch) { return times(use(batch)); },
          "(count,) [s] Simulated time; it may differ between worlds after set_world.")
      .def_property_readonly(
          "state_hash", [](const PythonBatch& batch) { return state_hashes(use(batch)); },
          "List of the hashes of the worlds, as World.state_hash.");
}

}  // namespace verlet_cable
