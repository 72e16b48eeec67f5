#include "verlet_cable/scene/mesh_file.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>
#include <vector>

#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

constexpr std::size_t most_triangles = 1'000'000;
constexpr std::size_t longest_message = 200;

/// Triangles whose vertices are found by their coordinates.
class TriangleList {
 public:
  explicit TriangleList(const Vector3& scale) : scale_(scale) {}

  void add(const aiMesh& mesh) {
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      TriangleMesh::Triangle triangle;
      for (int i = 0; i < 3; ++i) triangle[i] = index_of(mesh.mVertices[face.mIndices[i]]);
      // A triangle between two points: its neighbours on both sides are neighbours.
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
      triangles_.push_back(triangle);
      if (triangles_.size() > most_triangles)
        throw ResourceError("it has more than " + std::to_string(most_triangles) + " triangles");
    }
  }

  std::shared_ptr<const TriangleMesh> mesh() && {
    return std::make_shared<TriangleMesh>(std::move(vertices_), std::move(triangles_));
  }

 private:
  int index_of(const aiVector3D& vertex) {
    const std::array<float, 3> key{vertex.x, vertex.y, vertex.z};
    if (!std::isfinite(vertex.x + vertex.y + vertex.z)) throw ResourceError("a vertex is not finite");
    const auto [found, is_new] = indices_.emplace(key, static_cast<int>(vertices_.size()));
    if (is_new) vertices_.push_back(Vector3(vertex.x, vertex.y, vertex.z).cwiseProduct(scale_));
    return found->second;
  }

  Vector3 scale_;
  std::map<std::array<float, 3>, int> indices_;
  std::vector<Vector3> vertices_;
  std::vector<TriangleMesh::Triangle> triangles_;
};

}  // namespace

std::shared_ptr<const TriangleMesh> read_mesh_file(const std::string& path, const Vector3& scale) {
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, 1);
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate | aiProcess_PreTransformVertices);
  if (!scene) throw ResourceError("no mesh: " + escaped(importer.GetErrorString(), longest_message));
  TriangleList triangles(scale);
  for (unsigned i = 0; i < scene->mNumMeshes; ++i) triangles.add(*scene->mMeshes[i]);
  try {
    return std::move(triangles).mesh();
  } catch (const std::invalid_argument& error) {
    throw ResourceError(error.what());
  }
}

}  // namespace verlet_cable
