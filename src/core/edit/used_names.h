#pragma once

#include <algorithm>
#include <string>

#include "world/state.h"

namespace verlet_cable {

/// Whether one of a list has a name.
template <class List>
bool any_has_name(const std::string& name, const List& list) {
  return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item.name == name; });
}

/// What of that which may touch obstacles has a name, in a word; null: nothing. Contacts and events tell all of these by it.
inline const char* kind_with_name(const std::string& name, const State& state) {
  const SceneDesc& scene = *state.scene;
  if (find(state.cables, name) >= 0 || any_has_name(name, scene.cables)) return "cable";
  if (any_has_name(name, scene.nets)) return "net";
  if (any_has_name(name, scene.bodies)) return "body";
  return any_has_name(name, scene.particles) ? "particle" : nullptr;
}

}  // namespace verlet_cable
