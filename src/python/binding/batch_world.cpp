#include "binding/batch_world.h"

#include <string>

#include "binding/batch_arguments.h"
#include "binding/pickle_protocol.h"

namespace verlet_cable {
namespace {

std::unique_ptr<PythonWorld> world_at(const WorldsOfBatch& worlds, std::int64_t index) {
  return std::make_unique<WorldOfBatch>(worlds.batch, index);
}

py::list all_of(const WorldsOfBatch& worlds) {
  py::list all;
  for (std::size_t i = 0; i < worlds.batch->batch.size(); ++i) all.append(world_at(worlds, static_cast<std::int64_t>(i)));
  return all;
}

}  // namespace

WorldOfBatch::WorldOfBatch(std::shared_ptr<PythonBatch> batch, std::int64_t index)
    : batch_(std::move(batch)), index_(read_world_index(index, batch_->batch.size())) {}

void add_worlds_class(py::module_& module) {
  py::class_<WorldsOfBatch>(
      module, "Worlds",
      "The worlds of a batch, in their order: Batch.worlds. Each is a World that is not a copy: what is done "
      "to it is done to the batch, and it is what the batch has made of it. An integer is the index of one, "
      "from the end where it is negative.")
      .def("__reduce_ex__", reduce, py::arg("protocol"))
      .def("__len__", [](const WorldsOfBatch& worlds) { return worlds.batch->batch.size(); })
      .def("__getitem__", world_at, py::arg("index"), "Raises IndexError.")
      .def("__iter__", [](const WorldsOfBatch& worlds) { return py::iter(all_of(worlds)); })
      .def("__repr__", [](const WorldsOfBatch& worlds) {
        return "<the " + std::to_string(worlds.batch->batch.size()) + " worlds of a Batch>";
      });
}

}  // namespace verlet_cable
