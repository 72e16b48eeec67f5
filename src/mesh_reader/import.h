#pragma once

#include <string>
#include <vector>

#include "scene/mesh_protocol.h"

namespace verlet_cable::mesh_reader {

struct Mesh {
  std::vector<mesh_protocol::Vertex> vertices;
  std::vector<mesh_protocol::Triangle> triangles;
};

/// The triangles of a file of a format (stl, obj or dae), in its own units but for Collada's; vertices at the same place are one.
/// Files that it names are not opened. Throws Refused.
Mesh import(const std::string& format, const std::string& content);

}  // namespace verlet_cable::mesh_reader
