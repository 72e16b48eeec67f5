#pragma once

#include <pybind11/pybind11.h>

#include <utility>
#include <vector>

#include "verlet_cable/view/drawing.h"

namespace verlet_cable {

/// What is seen of one world or of several, as _simulation hands it to _camera: an object that Python only passes on.
using Drawings = std::vector<view::Drawing>;

constexpr const char* drawings_name = "verlet_cable.drawings";

inline pybind11::capsule capsule_of(Drawings drawings) {
  return pybind11::capsule(new Drawings(std::move(drawings)), drawings_name, [](PyObject* capsule) {
    delete static_cast<Drawings*>(PyCapsule_GetPointer(capsule, drawings_name));
  });
}

/// Throws TypeError where it is something else.
inline const Drawings& drawings_in(const pybind11::capsule& capsule) {
  const void* drawings = PyCapsule_GetPointer(capsule.ptr(), drawings_name);
  if (!drawings) throw pybind11::error_already_set();
  return *static_cast<const Drawings*>(drawings);
}

}  // namespace verlet_cable
