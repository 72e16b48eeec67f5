#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "verlet_cable/core/triangle_mesh.h"

namespace verlet_cable {

/// Meshes that messages name, each read once.
class MeshShelf {
 public:
  /// None where there is no such mesh, which is logged once.
  std::shared_ptr<const TriangleMesh> read(const std::string& uri, const Vector3& scale);

 private:
  using Key = std::tuple<std::string, double, double, double>;  ///< URI and scale

  std::map<Key, std::shared_ptr<const TriangleMesh>> meshes_;  ///< null: could not be read
};

}  // namespace verlet_cable
