#pragma once

#include <pybind11/pybind11.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "binding/run_steps.h"
#include "binding/world_class.h"
#include "simulation/batch.h"

namespace verlet_cable {

/// What Python calls a Batch.
struct PythonBatch {
  PythonScene scene;  ///< of the first world, when it began
  int threads = 0;    ///< as asked for
  Batch batch;
  bool busy = false;  ///< in use by a thread that has let others run

  PythonBatch(PythonScene made_of, int count, Batch worlds)
      : scene(std::move(made_of)), threads(count), batch(std::move(worlds)) {}
};
using BatchClass = pybind11::class_<PythonBatch, std::shared_ptr<PythonBatch>>;

/// One of the worlds of a batch, which lives as long as this.
class WorldOfBatch : public PythonWorld {
 public:
  /// `index`: as Python has it, from the end where it is negative. Throws IndexError.
  WorldOfBatch(std::shared_ptr<PythonBatch> batch, std::int64_t index);

  const PythonScene& scene() override { return batch_->scene; }
  DrivenWorld& driven() override { return batch_->batch[index_]; }
  EventRecord& events() override { return batch_->batch.events(index_); }
  bool& busy() override { return batch_->busy; }
  const char* used() const override { return "batch"; }
  void has_changed() override { batch_->batch.note_change_of(index_); }

 private:
  std::shared_ptr<PythonBatch> batch_;
  std::size_t index_;
};

/// `Worlds` of the module: of a batch, each as a World.
struct WorldsOfBatch {
  std::shared_ptr<PythonBatch> batch;
};
void add_worlds_class(pybind11::module_& module);

}  // namespace verlet_cable
