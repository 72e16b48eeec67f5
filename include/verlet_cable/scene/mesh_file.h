#pragma once

#include <memory>
#include <string>

#include "verlet_cable/core/triangle_mesh.h"
#include "verlet_cable/scene/resource.h"

namespace verlet_cable {

/// Reads a mesh (STL, Collada, OBJ, ... what Assimp reads), its vertices multiplied by `scale`; vertices at the same place are
/// one. As in rviz, Collada's unit counts, its up axis does not. Throws ResourceError where there is no closed mesh.
std::shared_ptr<const TriangleMesh> read_mesh_file(const std::string& path, const Vector3& scale);

/// For messages.
constexpr const char* mesh_words = "a file with a closed mesh, as package://PACKAGE/PATH or file:///PATH";

}  // namespace verlet_cable
