#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "contact/law.h"

namespace verlet_cable {

/// Segments of two cables, or of one, that may touch in the next substep.
struct NearPair {
  CablePoint first, second;
  Vector3 normal;                        ///< from the second to the first
  double gap = 0;                        ///< [m] between the surfaces
  double radius = 0;                     ///< [m] of the thinner one
  std::uint64_t key = 0, other_key = 0;  ///< of the touch
};

/// Where a segment of that radius and length [m] can be touched by more than this many of others that are as thin and as short as
/// that [m], they are in each other: around it there is no more room.
std::size_t room_around(double radius, double length, double thinnest, double shortest);

/// Leaves so many of the pairs of a segment, in their order: the nearest, and of those that are equally near the first.
void keep_nearest_pairs(std::size_t most, std::vector<NearPair>& pairs);

/// Of the touches from `first` on, which are those of a cable of so many nodes and segments with obstacles: once they are many on
/// average, the nearest of each node and segment, in their order. So they take no more memory, however many obstacles there are
/// in one place.
void keep_nearest_obstacles(std::size_t first, std::size_t elements, std::vector<Touch>& touches);

}  // namespace verlet_cable
