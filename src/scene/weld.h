#pragma once

#include <vector>

#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable {

/// Makes vertices one that are no further apart than `tolerance` [m]: the first of them stays. Triangles that lose a corner by it
/// are left out.
void weld(double tolerance, std::vector<Vector3>& vertices, std::vector<TriangleMesh::Triangle>& triangles);

}  // namespace verlet_cable
