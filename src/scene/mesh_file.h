#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>

#include "verlet_cable/core/triangle_mesh.h"
#include "verlet_cable/scene/resource.h"

namespace verlet_cable {

/// How long reading may take, in all.
struct Patience {
  std::chrono::steady_clock::time_point until = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  const std::atomic<bool>* cancelled = nullptr;  ///< another thread may set it, and reading ends early

  void check() const;  ///< throws ResourceError when it is at its end
};

/// Reads an STL, OBJ or Collada (.dae) file, its vertices multiplied by `scale`; no file that it names is opened. As in rviz,
/// Collada's unit counts, its up axis does not. Vertices at the same place are one; where the mesh is not closed then, vertices
/// that differ by rounding are, too: by up to four units in the last place of single precision at its largest coordinate, and a
/// thousandth of its size. Triangles that end as lines are left out. Factors below 0 mirror the mesh.
///
/// The file is read by the program `mesh_reader`, so that neither memory, time nor a crash of the library that parses it are this
/// process's. May be called by any thread, and blocks it. Throws ResourceError where there is no mesh, or not in time.
std::shared_ptr<const TriangleMesh> read_mesh_file(const std::string& path, const Vector3& scale, const Patience& patience = {});

/// For messages.
constexpr const char* mesh_words = "a file with a mesh, STL, OBJ or DAE, as package://PACKAGE/PATH or file:///PATH";

}  // namespace verlet_cable
