#include "scene_sources/scene_files.h"

#include <ros/package.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <system_error>

#include "scene_sources/scene_parameters.h"
#include "verlet_cable/core/quoted_text.h"
#include "verlet_cable/scene/scene_reader.h"

namespace verlet_cable {
namespace {

namespace fs = std::filesystem;

const std::string package_scheme = "package://";
constexpr std::size_t longest_path = 4096;
/// Nobody writes longer ones by hand; a file has no such limit.
constexpr std::size_t longest_text = 1 << 20;

[[noreturn]] void reject(const std::string& key, const std::string& file, const std::string& allowed) {
  throw SceneError({key + ": " + in_quotes(file) + "; allowed: " + allowed});
}

bool is_package_name(const std::string& name) {
  return !name.empty() && std::all_of(name.begin(), name.end(),
                                      [](unsigned char c) { return c < 128 && (std::isalnum(c) || c == '_' || c == '-'); });
}

bool is_inside(const fs::path& path, const fs::path& directory) {
  const auto [end, rest] = std::mismatch(directory.begin(), directory.end(), path.begin(), path.end());
  (void)rest;
  return end == directory.end();
}

fs::path package_file(const std::string& key, const std::string& file) {
  const std::string rest = file.substr(package_scheme.size());
  const std::size_t slash = rest.find('/');
  const std::string package = rest.substr(0, slash);
  const std::string directory = is_package_name(package) ? ros::package::getPath(package) : "";
  if (slash == std::string::npos || directory.empty()) reject(key, file, "package://PACKAGE/PATH of a package that is there");
  const fs::path path = (fs::path(directory) / rest.substr(slash + 1)).lexically_normal();
  // Links inside a package are its maintainers' own: a development space consists of them.
  if (!is_inside(path, fs::path(directory).lexically_normal())) reject(key, file, "a path inside the package");
  return path;
}

fs::path directory_file(const std::string& key, const std::string& file, const std::string& scene_directory) {
  std::error_code error;
  if (scene_directory.empty()) reject(key, file, "package://PACKAGE/PATH only, as scene_directory is empty");
  const fs::path directory = fs::canonical(scene_directory, error);
  if (error) reject(key, file, "package://PACKAGE/PATH only, as there is no scene_directory " + in_quotes(scene_directory));
  const fs::path path = fs::canonical(directory / file, error);
  const std::string allowed = "files inside scene_directory " + in_quotes(scene_directory) + ", or package://PACKAGE/PATH";
  if (error || !is_inside(path, directory)) reject(key, file, allowed);
  return path;
}

}  // namespace

std::string find_scene_file(const std::string& key, const std::string& file, const std::string& scene_directory) {
  if (file.empty() || file.size() > longest_path || file.find('\0') != std::string::npos) reject(key, file, "the path of a file");
  const bool in_package = file.compare(0, package_scheme.size(), package_scheme) == 0;
  const fs::path path = in_package ? package_file(key, file) : directory_file(key, file, scene_directory);
  std::error_code error;
  // Reading a pipe or a device would never end.
  if (!fs::is_regular_file(path, error)) reject(key, file, "a file that is there");
  return path.string();
}

std::string writable_scene_file(const std::string& key, const std::string& file, const std::string& scene_directory) {
  if (file.empty() || file.size() > longest_path || file.find('\0') != std::string::npos) reject(key, file, "the path of a file");
  std::error_code error;
  if (scene_directory.empty()) reject(key, file, "none, as scene_directory is empty");
  const fs::path directory = fs::canonical(scene_directory, error);
  if (error) reject(key, file, "none, as there is no scene_directory " + in_quotes(scene_directory));
  const fs::path path = directory / file, parent = fs::canonical(path.parent_path(), error);
  const bool has_name = path.has_filename() && path.filename() != "." && path.filename() != "..";
  if (error || !has_name || !is_inside(parent, directory))
    reject(key, file, "files in directories inside scene_directory " + in_quotes(scene_directory));
  const fs::path place = parent / path.filename();
  const fs::file_status status = fs::symlink_status(place, error);
  // What a link leads to may be anywhere.
  if (fs::exists(status) && !fs::is_regular_file(status)) reject(key, file, "a new file, or one that is replaced");
  return place.string();
}

SceneDesc read_requested_scene(const LoadScene::Request& request, const SceneDesc& current, const std::string& node) {
  if (request.file.empty() == request.yaml.empty()) {
    throw SceneError(
        {std::string("file, yaml: ") + (request.file.empty() ? "both empty" : "both given") + "; allowed: one of them"});
  }
  if (request.yaml.size() > longest_text) {
    throw SceneError({"yaml: " + std::to_string(request.yaml.size()) + " bytes; allowed: at most " +
                      std::to_string(longest_text) + ", longer scenes as a file"});
  }
  const SceneSources sources = node_sources(current.scene_directory, node);
  SceneDesc scene = request.file.empty()
                        ? read_scene_text(request.yaml, sources)
                        : read_scene_file(find_scene_file("file", request.file, current.scene_directory), sources);
  // A scene must not widen what it may do itself.
  scene.scene_directory = current.scene_directory;
  scene.limits = current.limits;
  log_warnings(scene);
  return scene;
}

}  // namespace verlet_cable
