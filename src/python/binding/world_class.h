#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>

#include "binding/scene_class.h"
#include "simulation/driven_world.h"
#include "simulation/event_record.h"
#include "verlet_cable/core/sensitivity.h"

namespace verlet_cable {

/// What Python calls a World: one of its own, or one of a batch.
class PythonWorld {
 public:
  virtual ~PythonWorld() = default;

  /// Of which it was made.
  virtual const PythonScene& scene() = 0;
  virtual DrivenWorld& driven() = 0;
  virtual EventRecord& events() = 0;
  /// Whether a thread uses it that has let others run, see InUse; `used`: what it uses.
  virtual bool& busy() = 0;
  virtual const char* used() const = 0;
  /// To be called after each change but steps of a batch.
  virtual void has_changed() {}

  /// Derivatives that its steps carry along; nullptr where they cannot.
  virtual std::optional<Sensitivity>* tracked() { return nullptr; }

  /// For reading. Throws where another thread uses it.
  const World& world();
};

std::unique_ptr<PythonWorld> own_world(PythonScene scene, DrivenWorld world, EventRecord events = {});

pybind11::class_<PythonWorld> add_world_class(pybind11::module_& module);

}  // namespace verlet_cable
