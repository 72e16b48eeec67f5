#include "binding/batch_class.h"

#include <pybind11/stl.h>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "binding/arguments.h"
#include "binding/motion_argument.h"
#include "binding/run_steps.h"
#include "binding/scene_class.h"
#include "binding/world_class.h"
#include "simulation/batch.h"

namespace verlet_cable {
namespace {

constexpr int most_threads = 1024;

/// What Python calls a Batch.
struct PythonBatch {
  Batch batch;
  bool busy = false;  ///< in use by a thread that has let others run

  explicit PythonBatch(Batch worlds) : batch(std::move(worlds)) {}
};

const Batch& use(const PythonBatch& batch) {
  InUse::check(batch.busy, "batch");
  return batch.batch;
}

std::unique_ptr<PythonBatch> make_of(std::vector<std::shared_ptr<const SceneDesc>> scenes, const py::object& motion,
                                     int threads) {
  if (threads < 0 || threads > most_threads)
    throw py::value_error("threads: " + std::to_string(threads) + "; allowed: 0, as many as there are cores, to " +
                          std::to_string(most_threads));
  const Motion tracks = read_motion(motion, *scenes.front());
  const py::gil_scoped_release release;
  return std::make_unique<PythonBatch>(Batch(std::move(scenes), tracks, threads));
}

std::unique_ptr<PythonBatch> make(const PythonScene& scene, std::int64_t count, const py::object& motion, int threads) {
  read_count("count", count, 1);
  return make_of(std::vector<std::shared_ptr<const SceneDesc>>(static_cast<std::size_t>(count), scene.desc), motion, threads);
}

std::unique_ptr<PythonBatch> make_from_list(const std::vector<PythonScene>& scenes, const py::object& motion, int threads) {
  if (scenes.empty()) throw py::value_error("scenes: none; allowed: at least one");
  std::vector<std::shared_ptr<const SceneDesc>> descs;
  for (const PythonScene& scene : scenes) descs.push_back(scene.desc);
  return make_of(std::move(descs), motion, threads);
}

/// A number for all worlds, one a world, or of a stiffness two a world.
std::vector<BendingStiffness> read_values(const std::string& name, const Numbers& numbers, std::size_t count) {
  const auto worlds = static_cast<py::ssize_t>(count);
  std::vector<BendingStiffness> values;
  if (numbers.ndim() == 0) {
    values.assign(count, BendingStiffness(*numbers.data()));
  } else if (numbers.ndim() == 1 && numbers.shape(0) == worlds) {
    for (py::ssize_t i = 0; i < worlds; ++i) values.emplace_back(numbers.at(i));
  } else if (name == "bending_stiffness" && numbers.ndim() == 2 && numbers.shape(0) == worlds && numbers.shape(1) == 2) {
    for (py::ssize_t i = 0; i < worlds; ++i) values.emplace_back(numbers.at(i, 0), numbers.at(i, 1));
  } else {
    throw py::value_error(name + ": shape " + shape_text(numbers) + "; allowed: (" + std::to_string(count) + ",)" +
                          (name == "bending_stiffness" ? ", (" + std::to_string(count) + ", 2)" : "") + " or a number");
  }
  return values;
}

void set_material(PythonBatch& batch, const std::string& name, const py::kwargs& fields) {
  std::vector<MaterialChange> changes;
  for (const auto& [key, value] : fields) {
    const std::string field = py::str(key);
    changes.push_back({field, read_values(field, Numbers(py::reinterpret_borrow<py::object>(value)), use(batch).size())});
  }
  const InUse in_use(batch.busy, "batch");
  const py::gil_scoped_release release;
  batch.batch.set_material(name, changes);
}

void set_frames(PythonBatch& batch, const std::string& name, const Numbers& poses) {
  const auto worlds = static_cast<py::ssize_t>(use(batch).size());
  const bool rollout = poses.ndim() == 3;
  if ((poses.ndim() != 2 && !rollout) || poses.shape(0) != worlds || poses.shape(poses.ndim() - 1) != 7 ||
      (rollout && poses.shape(1) == 0))
    throw py::value_error("poses: shape " + shape_text(poses) + "; allowed: (" + std::to_string(worlds) + ", 7) or (" +
                          std::to_string(worlds) + ", steps, 7)");
  const int frame = batch.batch[0].find_frame(name);
  const py::ssize_t steps = rollout ? poses.shape(1) : 1;
  std::vector<std::vector<Pose>> read(static_cast<std::size_t>(worlds));
  for (py::ssize_t i = 0; i < worlds; ++i) {
    for (py::ssize_t k = 0; k < steps; ++k) {
      const std::string index = "poses[" + std::to_string(i) + (rollout ? ", " + std::to_string(k) : "") + "]";
      read[i].push_back(read_pose(poses.data() + (i * steps + k) * 7, index));
    }
  }
  for (std::size_t i = 0; i < read.size(); ++i) batch.batch[i].set_frame(frame, std::move(read[i]));
}

void step(PythonBatch& batch, std::int64_t steps, std::int64_t record_every, const std::vector<std::string>& fields) {
  read_count("steps", steps, 0);
  read_count("record_every", record_every, 0);
  if (record_every > 0 && steps % record_every != 0)
    throw py::value_error("record_every: " + std::to_string(record_every) + "; allowed: what divides steps, " +
                          std::to_string(steps));
  const std::vector<Quantity> quantities = read_quantities(fields);
  const InUse in_use(batch.busy, "batch");
  batch.batch.begin_steps(steps, record_every, quantities);
  try {
    run_steps(steps, [&](std::int64_t some) { batch.batch.advance(some); });
  } catch (...) {
    batch.batch.drop_records();
    throw;
  }
}

py::array_t<double> read_records(const Record& record, std::size_t worlds, std::size_t records) {
  for (std::size_t i = 0; i < worlds; ++i)
    if (record.changed[i])
      throw py::value_error(
          std::string(name_of(record.quantity)) + " of " + record.name + ": world " + std::to_string(i) +
          " has not as many nodes as at its start, since cable broke, or slides through a guide; allowed: worlds whose "
          "cables keep their nodes");
  std::vector<std::size_t> sizes{worlds, records, record.shape.rows};
  if (record.shape.columns > 0) sizes.push_back(record.shape.columns);
  auto* owner = new std::shared_ptr<double>(record.numbers);
  const py::capsule capsule(owner, [](void* pointer) { delete static_cast<std::shared_ptr<double>*>(pointer); });
  py::array_t<double> array(sizes, record.numbers.get(), capsule);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::array_t<double> read_now(const Batch& batch, Quantity quantity, const std::string& name) {
  const QuantityShape shape = shape_of(batch[0].world(), quantity, name);
  std::vector<std::size_t> sizes{batch.size(), shape.rows};
  if (shape.columns > 0) sizes.push_back(shape.columns);
  py::array_t<double> array(sizes);
  for (std::size_t i = 0; i < batch.size(); ++i) {
    if (shape_of(batch[i].world(), quantity, name) != shape)
      throw py::value_error(std::string(name_of(quantity)) + " of " + name + ": world " + std::to_string(i) +
                            " has not as many nodes as world 0; allowed: worlds whose cables keep their nodes");
    copy_quantity(batch[i].world(), quantity, name, array.mutable_data() + i * shape.size());
  }
  return array;
}

/// The method that reads a quantity: its records where the last call recorded.
template <Quantity quantity>
py::array_t<double> read(const PythonBatch& python, const std::string& name) {
  const Batch& batch = use(python);
  const Records& records = batch.records();
  if (records.count() == 0) return read_now(batch, quantity, name);
  shape_of(batch[0].world(), quantity, name);  // throws for an unknown name
  const Record* record = records.find(quantity, name);
  if (!record)
    throw py::value_error(std::string(name_of(quantity)) + ": not recorded; allowed: what `fields` of the last step named");
  return read_records(*record, batch.size(), records.count());
}

std::unique_ptr<PythonWorld> world_at(const PythonBatch& batch, std::int64_t index) {
  const auto size = static_cast<std::int64_t>(use(batch).size());
  if (index < -size || index >= size)
    throw py::index_error("index: " + std::to_string(index) + "; allowed: 0 to " + std::to_string(size - 1));
  auto world = std::make_unique<PythonWorld>(batch.batch[static_cast<std::size_t>(index < 0 ? index + size : index)]);
  world->driven.world().step_one_by_one(false);
  return world;
}

py::array_t<std::int8_t> status(const PythonBatch& batch) {
  const auto& all = use(batch).status();
  py::array_t<std::int8_t> array(static_cast<py::ssize_t>(all.size()));
  for (std::size_t i = 0; i < all.size(); ++i) array.mutable_at(i) = static_cast<std::int8_t>(all[i]);
  return array;
}

py::array_t<bool> settle(PythonBatch& batch) {
  const InUse in_use(batch.busy, "batch");
  std::vector<char> found;
  {
    const py::gil_scoped_release release;
    found = batch.batch.settle();
    batch.batch.drop_records();
  }
  py::array_t<bool> array(static_cast<py::ssize_t>(found.size()));
  for (std::size_t i = 0; i < found.size(); ++i) array.mutable_at(i) = found[i] != 0;
  return array;
}

py::dict energy(const PythonBatch& batch) {
  const Batch& worlds = use(batch);
  py::dict all;
  for (std::size_t i = 0; i < worlds.size(); ++i)
    for (const auto& [key, value] : energy_dict(worlds[i].world().energy())) {
      if (!all.contains(key)) all[key] = py::array_t<double>(static_cast<py::ssize_t>(worlds.size()));
      py::array_t<double>(py::reinterpret_borrow<py::object>(all[key])).mutable_at(i) = value.cast<double>();
    }
  return all;
}

std::vector<std::string> state_hashes(const PythonBatch& batch) {
  const Batch& worlds = use(batch);
  std::vector<std::string> hashes;
  for (std::size_t i = 0; i < worlds.size(); ++i) hashes.push_back(hash_text(worlds[i].world().hash()));
  return hashes;
}

}  // namespace

void add_batch_class(py::module_& module) {
  py::class_<PythonBatch>(
      module, "Batch",
      "Worlds that are alike but for numbers, stepped together: sooner than one after another, with the same bytes "
      "as each alone, whatever the number of threads. One thread at a time may use a batch; others run while it "
      "steps.\n\nArrays begin with an axis of the worlds. After a step with `record_every` they have an axis of "
      "records next, and are read-only views; else they are new ones.")
      .def(py::init(&make), py::arg("scene"), py::arg("count"), py::arg("motion") = py::none(), py::arg("threads") = 0,
           "So many worlds of a scene. motion: as of World, of all of them. threads: 0 is one a core.")
      .def(py::init(&make_from_list), py::arg("scenes"), py::arg("motion") = py::none(), py::arg("threads") = 0,
           "A world for each of a list of scenes, which differ in numbers only: names, numbers of segments and time step are the "
           "same.")
      .def("__len__", [](const PythonBatch& batch) { return use(batch).size(); })
      .def("set_material", set_material, py::arg("name"),
           "Changes keys of a material: linear_density=..., bending_stiffness=...; a number, or (count,), or for "
           "bending_stiffness "
           "(count, 2). Before the first step the worlds begin anew with it; later all but linear_density can be "
           "changed.\n\nRaises "
           "SceneError with every error at once, ValueError, KeyError; then nothing is changed.")
      .def("set_frames", set_frames, py::arg("name"), py::arg("poses"),
           "(count, 7): where a frame is at the end of the next step, and from then on; (count, steps, 7): at the end of each of "
           "the next "
           "steps, then as at the last. x, y, z [m], qx, qy, qz, qw in the fixed frame.\n\nRaises KeyError, ValueError.")
      .def(
          "step", step, py::arg("steps") = 1, py::arg("record_every") = 0,
          py::arg("fields") = std::vector<std::string>{"positions", "velocities", "tension", "wrench", "body_pose", "body_twist"},
          "Advances all worlds by so many time steps. record_every: what `fields` names is recorded after every so many of them, "
          "which "
          "must divide `steps`. Other threads run meanwhile; Ctrl-C ends it between two steps, without records.")
      .def("settle", settle, "As of World, (count,) bool.")
      .def(
          "copy",
          [](const PythonBatch& batch) {
            use(batch);
            return std::make_unique<PythonBatch>(batch.batch);
          },
          "A batch that goes on from here by itself, with the same bytes.")
      .def("world", world_at, py::arg("index"), "A copy of one of the worlds.")
      .def("positions", read<Quantity::positions>, py::arg("name"), "(count, n + 1, 3) or (count, records, n + 1, 3) [m].")
      .def("velocities", read<Quantity::velocities>, py::arg("name"), "(count, n + 1, 3) or (count, records, n + 1, 3) [m/s].")
      .def("tension", read<Quantity::tension>, py::arg("name"), "(count, n) or (count, records, n) [N].")
      .def("curvature", read<Quantity::curvature>, py::arg("name"), "(count, n - 1) or (count, records, n - 1) [1/m].")
      .def("twist", read<Quantity::twist>, py::arg("name"), "(count, n - 1) or (count, records, n - 1) [rad/m].")
      .def("orientations", read<Quantity::orientations>, py::arg("name"), "(count, n, 4) or (count, records, n, 4): x, y, z, w.")
      .def("wrench", read<Quantity::wrench>, py::arg("attachment"), "(count, 6) or (count, records, 6) [N, N m].")
      .def("body_pose", read<Quantity::body_pose>, py::arg("name"), "(count, 7) or (count, records, 7).")
      .def("body_twist", read<Quantity::body_twist>, py::arg("name"), "(count, 6) or (count, records, 6) [m/s, rad/s].")
      .def("energy", energy, "Energies [J] as of World, (count,) each.")
      .def_property_readonly("status", status,
                             "(count,) int8, the worst of the last step(): 0 ok, 1 overstretched, 2 jumped, 3 degraded, 4 fault.")
      .def_property_readonly(
          "time", [](const PythonBatch& batch) { return use(batch)[0].world().time(); }, "[s] simulated.")
      .def_property_readonly("state_hash", state_hashes, "List of the worlds' hashes, as of World.");
}

}  // namespace verlet_cable
