#pragma once

#include <string>
#include <vector>

#include "verlet_cable/core/scene_desc.h"

namespace verlet_cable {

/// What bodies, junctions and guides do at one place of a cable may be felt at others: where the cable bends through it, or
/// slides. The time of a step grows with the cube of the number of places that feel each other.
constexpr int most_coupled_places = 100;

/// A line for each cable of a sound scene that has more of them.
std::vector<std::string> too_many_coupled_places(const SceneDesc& scene);

}  // namespace verlet_cable
