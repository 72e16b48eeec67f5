// Meshes: what is checked before Assimp sees a file, and, where its format lets them pass, what is made of its triangles. The
// input's first byte is the format. The package reads meshes so in a process of its own, as Assimp is not to be relied on: where
// it goes wrong behind our checks, that process ends and the file is refused. Such a finding is Assimp's, and still worth a
// check.

#include <cstddef>
#include <cstdint>
#include <string>

#include "mesh_reader/file_checks.h"
#include "mesh_reader/import.h"
#include "require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace verlet_cable;
  if (size == 0) return 0;
  const char* const formats[] = {"stl", "obj", "dae"};
  const std::string format = formats[data[0] % 3];
  const std::string content(reinterpret_cast<const char*>(data + 1), size - 1);
  try {
    mesh_reader::check_file(format, content);
    const mesh_reader::Mesh mesh = mesh_reader::import(format, content);
    for (const auto& triangle : mesh.triangles)
      for (const std::int32_t vertex : triangle)
        fuzz::require(vertex >= 0 && static_cast<std::size_t>(vertex) < mesh.vertices.size(),
                      "the corners of triangles are there");
  } catch (const mesh_reader::Refused&) {
    // With its reason.
  }
  return 0;
}
