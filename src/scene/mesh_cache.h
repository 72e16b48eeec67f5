#pragma once

#include <cstdint>
#include <list>
#include <memory>
#include <string>
#include <tuple>

#include "mesh_file.h"

namespace verlet_cable {

/// Meshes that were read last, as long as their files stay as they are.
class MeshCache {
 public:
  /// As `read_mesh_file`.
  std::shared_ptr<const TriangleMesh> read(const std::string& path, const Vector3& scale, const Patience& patience);

 private:
  /// Path, scale, inode, size, time of its last change [ns].
  using Key = std::tuple<std::string, double, double, double, std::uint64_t, std::int64_t, std::int64_t>;
  struct Entry {
    Key key;
    std::shared_ptr<const TriangleMesh> mesh;
  };

  static Key key_of(const std::string& path, const Vector3& scale);

  std::list<Entry> entries_;  ///< last used first
};

}  // namespace verlet_cable
