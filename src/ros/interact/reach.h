#pragma once

#include <string>

#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// The place nearest to `place` [m], about, where a node of a cable can be held: an inextensible cable must reach it from
/// everything else that holds it. `except` names an attachment that does not count. Of an elastic cable, `place`.
Vector3 within_reach(const World& world, int cable, int node, const std::string& except, const Vector3& place);

}  // namespace verlet_cable
