#include "binding/batch_class.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "binding/appearance.h"
#include "binding/arguments.h"
#include "binding/batch_arguments.h"
#include "binding/batch_arrays.h"
#include "binding/drawings.h"
#include "binding/motion_argument.h"
#include "binding/pickle_protocol.h"
#include "binding/text_arguments.h"
#include "simulation/edits.h"

namespace verlet_cable {
namespace {

constexpr int most_threads = 1024;
constexpr std::int64_t most_worlds = 1000000;

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

std::shared_ptr<PythonBatch> make_of(const PythonScene& first, const std::vector<std::shared_ptr<const SceneDesc>>& scenes,
                                     const py::object& motion, const py::object& loads, int threads, bool keeps_going = false) {
  const Motion tracks = read_motion(motion, *scenes.front());
  const LoadPlayer player = read_loads(loads, *scenes.front());
  const py::gil_scoped_release release;
  return std::make_shared<PythonBatch>(first, threads, Batch(scenes, tracks, player, threads, keeps_going));
}

std::shared_ptr<PythonBatch> make(const PythonScene& scene, std::int64_t count, const py::object& motion, int threads,
                                  const py::object& loads) {
  check_size(count, threads);
  return make_of(scene, std::vector<std::shared_ptr<const SceneDesc>>(static_cast<std::size_t>(count), scene.desc), motion, loads,
                 threads);
}

std::shared_ptr<PythonBatch> make_from_list(const std::vector<PythonScene>& scenes, const py::object& motion, int threads,
                                            const py::object& loads, bool keep_going) {
  if (scenes.empty()) throw py::value_error("scenes: none; allowed: at least one");
  check_size(static_cast<std::int64_t>(scenes.size()), threads);
  std::vector<std::shared_ptr<const SceneDesc>> descs;
  for (const PythonScene& scene : scenes) descs.push_back(scene.desc);
  std::shared_ptr<PythonBatch> batch = make_of(scenes.front(), descs, motion, loads, threads, keep_going);
  const std::vector<std::string>& errors = batch->batch.errors();
  batch->scene = scenes[static_cast<std::size_t>(std::find(errors.begin(), errors.end(), "") - errors.begin())];
  return batch;
}

std::shared_ptr<PythonBatch> make_of_world(PythonWorld& world, std::int64_t count, int threads) {
  check_size(count, threads);
  const InUse in_use(world.busy(), world.used());
  const py::gil_scoped_release release;
  return std::make_shared<PythonBatch>(world.scene(), threads, Batch(world.driven(), static_cast<std::size_t>(count), threads));
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
  const std::vector<Pose> all = read_poses(poses, use(batch));
  const InUse in_use(batch.busy, "batch");
  const py::gil_scoped_release release;
  batch.batch.set_frame(frame, all);
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
  world.world();
  const DrivenWorld from = world.driven();  // it may be one of them
  const InUse in_use(batch.busy, "batch");
  const py::gil_scoped_release release;
  batch.batch.set_worlds(indices, from);
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

/// For verlet_cable.camera, of all worlds, and their times [s].
py::tuple drawings(const PythonBatch& batch, const py::dict& given) {
  const Batch& worlds = use(batch);
  const Appearance appearance(given);
  Drawings all;
  py::list times;
  for (std::size_t i = 0; i < worlds.size(); ++i) {
    all.push_back(appearance.drawing_of(worlds[i].world()));
    times.append(worlds[i].world().time());
  }
  return py::make_tuple(capsule_of(std::move(all)), times);
}

py::object draw(const std::shared_ptr<PythonBatch>& batch, std::int64_t world, const py::object& path, const py::object& view,
                const py::object& size) {
  return py::cast(WorldsOfBatch{batch})[py::int_(world)].attr("draw")(path, view, size);
}

/// The method that reads a quantity.
template <Quantity quantity>
py::array_t<double> read(PythonBatch& batch, const py::str& name, std::optional<double> missing) {
  const InUse in_use(batch.busy, "batch");
  return array_of(batch.batch, quantity, text_of(name, argument_of(quantity)), missing);
}

py::array_t<double> observe(PythonBatch& batch, const std::vector<GivenPart>& parts, std::optional<double> missing) {
  const InUse in_use(batch.busy, "batch");
  return observations(batch.batch, parts, missing);
}

std::unique_ptr<PythonWorld> copied_world_at(const PythonBatch& batch, std::int64_t index) {
  const Batch& worlds = use(batch);
  std::unique_ptr<PythonWorld> world = own_world(batch.scene, worlds[read_world_index(index, worlds.size())]);
  world->driven().world().step_one_by_one(false);
  return world;
}

std::shared_ptr<PythonBatch> copied_batch(const PythonBatch& batch) {
  return std::make_shared<PythonBatch>(batch.scene, batch.threads, use(batch));
}

py::tuple pickled(const PythonBatch& batch) {
  py::list worlds, events;
  for (std::size_t i = 0; i < use(batch).size(); ++i) {
    worlds.append(py::bytes(batch.batch[i].save()));
    events.append(py::bytes(batch.batch.events(i).save()));
  }
  std::vector<int> status;
  for (const StepResult::Status one : batch.batch.status()) status.push_back(static_cast<int>(one));
  return py::make_tuple(parts_of(batch.scene), batch.threads, worlds, batch.batch.errors(), status, events);
}

std::shared_ptr<PythonBatch> unpickled(const py::tuple& parts) {
  PythonScene scene = scene_of_parts(parts[0]);
  std::vector<DrivenWorld> worlds;
  for (const py::handle& data : parts[2]) worlds.push_back(DrivenWorld::load(*scene.desc, data.cast<std::string>()));
  std::vector<StepResult::Status> status;
  for (const int number : parts[4].cast<std::vector<int>>()) status.push_back(static_cast<StepResult::Status>(number));
  const int threads = parts[1].cast<int>();
  auto batch = std::make_shared<PythonBatch>(
      std::move(scene), threads, Batch(std::move(worlds), parts[3].cast<std::vector<std::string>>(), std::move(status), threads));
  const auto events = parts[5].cast<std::vector<py::bytes>>();
  for (std::size_t i = 0; i < events.size(); ++i) batch->batch.events(i) = EventRecord(std::string(events[i]));
  return batch;
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

BatchClass add_batch_class(py::module_& module) {
  BatchClass batch(
      module, "Batch",
      "Worlds that differ only in numbers and are stepped together. This is faster than one after another and gives the same "
      "bytes as each alone, with any number of threads. Only one thread at a time may use a batch; other threads run while it "
      "steps.\n\nbatch.worlds[i] is one of the worlds with all methods of World. Methods whose first argument is `world` do the "
      "same for the world of that index; the others are of all worlds.\n\nThe first axis of arrays is that of the worlds. After "
      "a step with `record_every`, the second axis is that of the records, and the arrays are views; otherwise they are new "
      "copies. All of them are read-only. If some worlds have an array in another shape than the first one, since a cable broke "
      "or was cut, ValueError is raised, or with missing=0.0 this number is in their place.");
  batch
      .def(py::init(&make), py::arg("scene"), py::arg("count"), py::arg("motion") = py::none(), py::arg("threads") = 0,
           py::arg("loads") = py::none(),
           "`count` worlds of a scene. motion, loads: as for World, the same for all. threads: 0 is one per core.")
      .def(py::init(&make_from_list), py::arg("scenes"), py::arg("motion") = py::none(), py::arg("threads") = 0,
           py::arg("loads") = py::none(), py::kw_only(), py::arg("keep_going").noconvert() = false,
           "A world for each scene of a list. The scenes may differ only in numbers: their names, types, numbers of segments "
           "and time steps must be the same. keep_going: a scene that does not fit, or cannot start, is not an error, but is "
           "named in "
           "`errors`. Its world is a copy of the first one without error that is never stepped, with status 6, until set_world "
           "replaces it. SceneError is raised if no scene is right.")
      .def(py::init(&make_of_world), py::arg("world"), py::arg("count"), py::arg("threads") = 0,
           "`count` copies of a world in its present state, with its time, motion, poses that were set, and edits. Each "
           "continues with the same bytes as the world would.")
      .def("__repr__", represent)
      .def("_drawings", drawings)
      .def("draw", draw, py::arg("world"), py::arg("path") = py::none(), py::arg("view") = py::none(),
           py::arg("size") = py::make_tuple(800, 600), "As World.draw, of one of the worlds.")
      .def("__len__", [](const PythonBatch& batch) { return use(batch).size(); })
      .def(
          "__getitem__",
          [](const PythonBatch&, const py::object& index) {
            throw py::type_error("a Batch has no items; allowed: batch.worlds[" + ascii_text(index) +
                                 "] for one of its worlds, batch.world(index) for a copy of one");
          },
          py::arg("index"), "Not for use: `worlds` has the worlds.")
      .def_property_readonly(
          "worlds", [](const std::shared_ptr<PythonBatch>& batch) { return WorldsOfBatch{batch}; },
          "The worlds, each as a World that is not a copy: batch.worlds[3].pin('hose', node=5). A sequence that is as long as "
          "the "
          "batch. Changing one drops the records of the last step.")
      .def("set_world", set_world, py::arg("index"), py::arg("world"),
           "Replaces worlds by copies of `world`, with its time, motion and poses that were set: to restart some of them, or to "
           "give all a common start. index: an integer (negative ones count from the end), a sequence of integers, or a bool "
           "mask (count,). A copy takes less time than a step, however long it took to make the world. The records of the last "
           "step are dropped; `status` of these worlds is 0.\n\nRaises IndexError; ValueError for another kind of index, or if "
           "the scene of the world differs from that of the batch in more than numbers: names, types, numbers of segments and "
           "time "
           "step must be the same. Then nothing is changed.")
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
      .def("copy", copied_batch, "An independent copy, which continues from here with the same bytes.")
      .def("__copy__", copied_batch)
      .def(
          "__deepcopy__", [](const PythonBatch& batch, const py::dict&) { return copied_batch(batch); }, py::arg("memo"))
      .def(py::pickle(&pickled, &unpickled))
      .def("__reduce_ex__", reduce, py::arg("protocol"))
      .def("world", copied_world_at, py::arg("index"), "A copy of one of the worlds, without its earlier events.")
      .def("positions", read<Quantity::positions>, py::arg("name"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, n + 1, 3) or (count, records, n + 1, 3) [m].")
      .def("velocities", read<Quantity::velocities>, py::arg("name"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, n + 1, 3) or (count, records, n + 1, 3) [m/s].")
      .def("tension", read<Quantity::tension>, py::arg("name"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, n) or (count, records, n) [N].")
      .def("curvature", read<Quantity::curvature>, py::arg("name"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, n - 1) or (count, records, n - 1) [1/m].")
      .def("twist", read<Quantity::twist>, py::arg("name"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, n - 1) or (count, records, n - 1) [rad/m].")
      .def("plastic_curvature", read<Quantity::plastic_curvature>, py::arg("name"), py::kw_only(),
           py::arg("missing") = py::none(), "(count, n - 1) or (count, records, n - 1) [1/m].")
      .def("orientations", read<Quantity::orientations>, py::arg("name"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, n, 4) or (count, records, n, 4): x, y, z, w.")
      .def("wrench", read<Quantity::wrench>, py::arg("attachment"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, 6) or (count, records, 6) [N, N m].")
      .def("contact_force", read<Quantity::contact_force>, py::arg("name"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, 6) or (count, records, 6) [N, N m], as World.contact_force.")
      .def("body_pose", read<Quantity::body_pose>, py::arg("name"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, 7) or (count, records, 7).")
      .def("body_twist", read<Quantity::body_twist>, py::arg("name"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, 6) or (count, records, 6) [m/s, rad/s].")
      .def("observations", observe, py::arg("parts"), py::kw_only(), py::arg("missing") = py::none(),
           "(count, k) float64: for each world, the present values of all `parts`, flattened and concatenated. parts: "
           "[(quantity, name), ...], where the quantities are the names of the methods that read arrays, with their units and "
           "order: [('positions', 'rope'), ('wrench', 'left')]. ('positions', 'rope', 20), and velocities likewise, gives 20 "
           "points instead of nodes, evenly spaced from end to end along the cable that has this name now. This also works if "
           "the cables differ in their numbers of nodes because they slide through guides, were cut or changed in length, or "
           "broke. The array is new and in C order.\n\nRaises KeyError for names, ValueError for quantities and numbers of "
           "points, and if a world has not as many nodes as the others, unless `missing` is given as the number in their place.")
      .def(
          "energy", [](const PythonBatch& batch) { return energies(use(batch)); }, "Energies [J] as World.energy, (count,) each.")
      .def_property_readonly(
          "status", [](const PythonBatch& batch) { return statuses(use(batch)); },
          "(count,) int8, the worst status in the last call of step(): 0 ok, 1 jumped, 2 overstretched, 3 inside_obstacle, "
          "4 not_settled, 5 degraded, 6 fault.")
      .def_property_readonly(
          "errors", [](const PythonBatch& batch) { return use(batch).errors(); },
          "List of texts: what is wrong with the scene of each world, see keep_going; '' if nothing is.")
      .def_property_readonly(
          "time", [](const PythonBatch& batch) { return times(use(batch)); },
          "(count,) [s] Simulated time; it may differ between worlds after set_world.")
      .def_property_readonly(
          "state_hash", [](const PythonBatch& batch) { return state_hashes(use(batch)); },
          "List of the hashes of the worlds, as World.state_hash.");
  return batch;
}

}  // namespace verlet_cable
