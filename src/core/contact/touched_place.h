#pragma once

#include <cstdint>

namespace verlet_cable {

/// Where a cable touches a solid, in the order along it: a node, or of the segment behind it where a face of the solid begins to
/// be under it, its deepest place, and where the face ends.
enum class Place : std::uint64_t { node, face_begins, deepest, face_ends };
constexpr std::uint64_t places = 4;

/// Which numbers contacts with solids by: those of a cable ascend along it.
constexpr std::uint64_t place_key(int first_node, Place place) {
  return places * static_cast<std::uint64_t>(first_node) + static_cast<std::uint64_t>(place);
}
constexpr int first_node_of(std::uint64_t key) {
  return static_cast<int>(key / places);
}
constexpr bool is_node(std::uint64_t key) {
  return key % places == static_cast<std::uint64_t>(Place::node);
}
/// Of a node, itself.
constexpr int last_node_of(std::uint64_t key) {
  return first_node_of(key) + (is_node(key) ? 0 : 1);
}

}  // namespace verlet_cable
