#include "camera/mesh_shelf.h"

#include <ros/console.h>

#include "scene/mesh_file.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

constexpr std::size_t most_meshes = 1000;

}  // namespace

std::shared_ptr<const TriangleMesh> MeshShelf::read(const std::string& uri, const Vector3& scale) {
  const Key key{uri, scale.x(), scale.y(), scale.z()};
  const auto known = meshes_.find(key);
  if (known != meshes_.end()) return known->second;
  if (meshes_.size() == most_meshes) meshes_.clear();
  std::shared_ptr<const TriangleMesh>& mesh = meshes_[key];
  try {
    mesh = read_mesh_file(file_of(uri, {}), scale);
  } catch (const ResourceError& error) {
    ROS_WARN("not seen: the mesh %s: %s; allowed: %s", in_quotes(uri).c_str(), error.what(), mesh_words);
  }
  return mesh;
}

}  // namespace verlet_cable
