#pragma once

#include <functional>
#include <string>
#include <type_traits>
#include <utility>

#include "binding/arguments.h"
#include "binding/batch_world.h"

namespace verlet_cable {

/// Adds methods to World, and with the index of one of its worlds in front to Batch.
class WorldMethods {
 public:
  WorldMethods(py::class_<PythonWorld>& world, BatchClass& batch) : world_(world), batch_(batch) {}

  /// `extras`: as of pybind11's def, with World's documentation.
  template <class Method, class... Extras>
  void add_reader(const char* name, Method method, const Extras&... extras) {
    add<false>(name, std::function(std::move(method)), extras...);
  }

  /// Of a method that changes the world.
  template <class Method, class... Extras>
  void add_edit(const char* name, Method method, const Extras&... extras) {
    add<true>(name, std::function(std::move(method)), extras...);
  }

 private:
  template <bool changes, class Result, class... Arguments, class... Extras>
  void add(const char* name, const std::function<Result(PythonWorld&, Arguments...)>& method, const Extras&... extras) {
    world_.def(
        name,
        [method](PythonWorld& world, Arguments... arguments) -> Result {
          return call<changes>(method, world, std::forward<Arguments>(arguments)...);
        },
        extras...);
    // Of two documentations the last one is taken.
    const std::string as_of_world = std::string("As World.") + name + ", of one of the worlds.";
    batch_.def(
        name,
        [method](const std::shared_ptr<PythonBatch>& batch, std::int64_t index, Arguments... arguments) -> Result {
          WorldOfBatch world(batch, index);
          return call<changes>(method, world, std::forward<Arguments>(arguments)...);
        },
        py::arg("world"), extras..., as_of_world.c_str());
  }

  template <bool changes, class Method, class... Arguments>
  static auto call(const Method& method, PythonWorld& world, Arguments&&... arguments) {
    InUse::check(world.busy(), world.used());
    if constexpr (!changes) {
      return method(world, std::forward<Arguments>(arguments)...);
    } else if constexpr (std::is_void_v<typename Method::result_type>) {
      method(world, std::forward<Arguments>(arguments)...);
      world.has_changed();
    } else {
      auto result = method(world, std::forward<Arguments>(arguments)...);
      world.has_changed();
      return result;
    }
  }

  py::class_<PythonWorld>& world_;
  BatchClass& batch_;
};

}  // namespace verlet_cable
