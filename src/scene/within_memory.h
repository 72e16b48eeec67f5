#pragma once

#include <new>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// What `read` returns. Throws SceneError where memory does not suffice: a scene may ask for more than there is.
template <class Read>
auto within_memory(const Read& read) {
  try {
    return read();
  } catch (const std::bad_alloc&) {
    throw SceneError({"scene: needs more memory than there is"});
  }
}

}  // namespace verlet_cable
