#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "verlet_cable/scene/resource.h"

namespace verlet_cable {
namespace {

namespace fs = std::filesystem;

/// Packages are looked for so many directories below the paths.
constexpr int deepest_level = 8;

/// The text between <name> and </name> of a package.xml, its own name: tags inside of other names do not come before it. Empty if
/// there is none.
std::string name_in(const fs::path& package_xml) {
  std::string xml;
  try {
    xml = read_file(package_xml.string());
  } catch (const ResourceError&) {
    return "";
  }
  const std::string open = "<name>";
  const std::size_t begin = xml.find(open), end = xml.find("</name>");
  if (begin == std::string::npos || end == std::string::npos || end < begin) return "";
  const std::string name = xml.substr(begin + open.size(), end - begin - open.size());
  const char* blanks = " \t\r\n";
  const std::size_t first = name.find_first_not_of(blanks);
  return first == std::string::npos ? "" : name.substr(first, name.find_last_not_of(blanks) - first + 1);
}

std::vector<fs::path> search_paths() {
  std::vector<fs::path> paths;
  const char* variable = std::getenv("ROS_PACKAGE_PATH");
  std::istringstream list(variable ? variable : "");
  for (std::string path; std::getline(list, path, ':');)
    if (!path.empty()) paths.emplace_back(path);
  for (const char* installed : {"/opt/ros/noetic/share", "/usr/share"}) paths.emplace_back(installed);
  return paths;
}

bool is_package(const fs::path& directory, const std::string& name) {
  return name_in(directory / "package.xml") == name;
}

/// As rospack does: links are followed, packages inside packages are not looked for, nor anything hidden or marked CATKIN_IGNORE.
std::optional<std::string> find_below(const fs::path& directory, const std::string& name, int levels) {
  std::error_code error;
  if (is_package(directory, name)) return directory.string();
  if (levels == 0 || fs::exists(directory / "package.xml", error) || fs::exists(directory / "CATKIN_IGNORE", error))
    return std::nullopt;
  std::vector<fs::path> children;
  for (fs::directory_iterator it(directory, error), end; !error && it != end; it.increment(error)) {
    std::error_code of_child;
    if (it->is_directory(of_child) && it->path().filename().string()[0] != '.') children.push_back(it->path());
  }
  std::sort(children.begin(), children.end());
  for (const fs::path& child : children)
    if (auto found = find_below(child, name, levels - 1)) return found;
  return std::nullopt;
}

}  // namespace

std::optional<std::string> find_package(const std::string& name) {
  if (name.empty() || name.find_first_of("./") == 0) return std::nullopt;
  const std::vector<fs::path> paths = search_paths();
  // Most packages are in a directory of their name: no need to go through all of a workspace.
  for (const fs::path& path : paths)
    if (is_package(path / name, name)) return (path / name).string();
  for (const fs::path& path : paths) {
    if (path == "/usr/share") continue;  // distributions install each package in a directory of its name
    if (auto found = find_below(path, name, deepest_level)) return found;
  }
  return std::nullopt;
}

}  // namespace verlet_cable
