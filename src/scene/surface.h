#pragma once

#include <vector>

#include "verlet_cable/core/shape.h"
#include "verlet_cable/core/world.h"

namespace verlet_cable {

/// What a program that draws sees of a solid.
struct Surface {
  std::vector<Vector3> points;          ///< [m]
  std::vector<std::vector<int>> faces;  ///< indices of points, counterclockwise from outside
};

/// Of a solid in its own frame. Round ones are facetted; a plane is a square of twice `plane_reach` [m].
Surface surface_of(const Shape& shape, double plane_reach);

/// [m] How far a plane should reach to lie below all that the world simulates: whole metres.
double plane_reach(const World& world);

}  // namespace verlet_cable
