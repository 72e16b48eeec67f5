#include "mesh_cache.h"

#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace verlet_cable {
namespace {

constexpr std::size_t most_triangles = 500'000;  // of all meshes that are kept

}  // namespace

MeshCache::Key MeshCache::key_of(const std::string& path, const Vector3& scale) {
  struct stat file;
  if (stat(path.c_str(), &file) != 0) throw ResourceError(std::generic_category().message(errno));
  const std::int64_t changed = std::int64_t{file.st_mtim.tv_sec} * 1'000'000'000 + file.st_mtim.tv_nsec;
  return {path, scale.x(), scale.y(), scale.z(), file.st_ino, file.st_size, changed};
}

std::shared_ptr<const TriangleMesh> MeshCache::read(const std::string& path, const Vector3& scale, const Patience& patience) {
  // Of before it is read: what changes meanwhile is read again.
  const Key key = key_of(path, scale);
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) { return entry.key == key; });
  if (known != entries_.end()) {
    entries_.splice(entries_.begin(), entries_, known);
  } else {
    entries_.push_front({key, read_mesh_file(path, scale, patience)});
  }
  const auto mesh = entries_.front().mesh;
  std::size_t triangles = 0;
  const auto too_many = std::find_if(entries_.begin(), entries_.end(), [&](const Entry& entry) {
    triangles += entry.mesh->triangles().size();
    return triangles > most_triangles;
  });
  entries_.erase(too_many, entries_.end());
  return mesh;
}

}  // namespace verlet_cable
