#pragma once

#include <vector>

#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable {

/// Makes the best of triangles as they come:
/// 1. Those that are lines are left out, and so are copies of others, whichever way they face.
/// 2. Where the rest is not closed, what hangs together by edges of just two triangles faces the way most of its area faces, and
///    what is closed by itself faces outwards.
/// 3. All of them are turned round if the volume that they enclose is below 0. What is open counts as closed by a cone from the
///    middle of its border.
void orient(const std::vector<Vector3>& vertices, std::vector<TriangleMesh::Triangle>& triangles);

}  // namespace verlet_cable
