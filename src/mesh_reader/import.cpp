#include "import.h"

#include <assimp/BaseImporter.h>
#include <assimp/MemoryIOWrapper.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <utility>

#include "file_checks.h"

namespace verlet_cable::mesh_reader {
namespace {

using mesh_protocol::most_triangles;

/// Cutting a face into triangles takes a time that grows with the square of this.
constexpr unsigned most_corners = 4096;

using Transform = aiMatrix4x4t<double>;
using Point = aiVector3t<double>;

/// A file system with a single file, which is in memory.
class OneFile : public Assimp::IOSystem {
 public:
  OneFile(std::string name, const std::string& content) : name_(std::move(name)), content_(content) {}

  bool Exists(const char* file) const override { return file == name_; }
  char getOsSeparator() const override { return '/'; }
  Assimp::IOStream* Open(const char* file, const char* mode) override {
    if (!Exists(file) || mode[0] != 'r') return nullptr;
    return new Assimp::MemoryIOStream(reinterpret_cast<const std::uint8_t*>(content_.data()), content_.size());
  }
  void Close(Assimp::IOStream* stream) override { delete stream; }

 private:
  std::string name_;
  const std::string& content_;
};

/// Leaves the importer of one format.
void keep_importer(const std::string& format, Assimp::Importer& importer) {
  const Assimp::BaseImporter* kept = importer.GetImporter(format.c_str());
  if (!kept) throw Refused("Assimp on this machine does not read " + format);
  for (std::size_t i = importer.GetImporterCount(); i-- > 0;) {
    Assimp::BaseImporter* const other = importer.GetImporter(i);
    if (other == kept) continue;
    importer.UnregisterLoader(other);
    delete other;  // ours from then on
  }
}

[[noreturn]] void refuse(const Assimp::Importer& importer) {
  throw Refused(std::string("no mesh: ") + importer.GetErrorString());
}

[[noreturn]] void refuse_size() {
  throw Refused("it has more than " + std::to_string(most_triangles) + " triangles");
}

/// Before faces are cut into triangles.
void check_faces(const aiScene& scene) {
  std::size_t triangles = 0;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const unsigned corners = mesh.mFaces[f].mNumIndices;
      if (corners > most_corners)
        throw Refused("a face has " + std::to_string(corners) + " corners, more than " + std::to_string(most_corners));
      if (corners >= 3) triangles += corners - 2;
    }
  }
  if (triangles > most_triangles) refuse_size();
}

/// Triangles whose vertices are found by their coordinates.
class TriangleList {
 public:
  /// The meshes of a node and of those below it; `above`: what places the node. Assimp's own step for this,
  /// aiProcess_PreTransformVertices, skips transforms that differ from none by less than 0.01, that is, by a centimetre.
  void add(const aiScene& scene, const aiNode& node, const Transform& above) {
    const Transform placed = above * static_cast<Transform>(node.mTransformation);
    for (unsigned m = 0; m < node.mNumMeshes; ++m) add(*scene.mMeshes[node.mMeshes[m]], placed);
    for (unsigned c = 0; c < node.mNumChildren; ++c) add(scene, *node.mChildren[c], placed);
  }

  Mesh take() && { return std::move(mesh_); }

 private:
  void add(const aiMesh& mesh, const Transform& placed) {
    const bool is_mirrored = placed.Determinant() < 0;
    for (unsigned f = 0; f < mesh.mNumFaces; ++f) {
      const aiFace& face = mesh.mFaces[f];
      if (face.mNumIndices != 3) continue;  // points and lines
      mesh_protocol::Triangle triangle;
      for (int i = 0; i < 3; ++i) {
        if (face.mIndices[i] >= mesh.mNumVertices) throw Refused("a face has a vertex that is not there");
        const aiVector3D& vertex = mesh.mVertices[face.mIndices[i]];
        triangle[i] = index_of(placed * Point(vertex.x, vertex.y, vertex.z));
      }
      if (is_mirrored) std::swap(triangle[1], triangle[2]);
      // A triangle between two points: its neighbours on both sides are neighbours.
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) continue;
      mesh_.triangles.push_back(triangle);
      if (mesh_.triangles.size() > most_triangles) refuse_size();
    }
  }

  std::int32_t index_of(const Point& vertex) {
    const mesh_protocol::Vertex key{static_cast<float>(vertex.x), static_cast<float>(vertex.y), static_cast<float>(vertex.z)};
    for (const float coordinate : key)
      if (!std::isfinite(coordinate)) throw Refused("a vertex is not finite");
    const auto [found, is_new] = indices_.emplace(key, static_cast<std::int32_t>(mesh_.vertices.size()));
    if (is_new) mesh_.vertices.push_back(key);
    return found->second;
  }

  std::map<mesh_protocol::Vertex, std::int32_t> indices_;
  Mesh mesh_;
};

}  // namespace

Mesh import(const std::string& format, const std::string& content) {
  Assimp::Importer importer;
  keep_importer(format, importer);
  const std::string name = "mesh." + format;
  importer.SetIOHandler(new OneFile(name, content));  // the importer's from now on
  importer.SetPropertyInteger(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, 1);
  const aiScene* scene = importer.ReadFile(name, 0);
  if (!scene) refuse(importer);
  check_faces(*scene);
  scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene) refuse(importer);
  TriangleList triangles;
  triangles.add(*scene, *scene->mRootNode, Transform());
  Mesh mesh = std::move(triangles).take();
  if (mesh.triangles.empty()) throw Refused("no mesh: it has no triangles");
  return mesh;
}

}  // namespace verlet_cable::mesh_reader
