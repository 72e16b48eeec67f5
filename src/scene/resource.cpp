#include "verlet_cable/scene/resource.h"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <system_error>
#include <vector>

#include "file_descriptor.h"
#include "verlet_cable/core/quoted_text.h"

namespace verlet_cable {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t largest_file = std::uintmax_t{64} << 20;
constexpr const char* too_large = "it is larger than 64 MB";

bool starts_with(const std::string& text, const std::string& start) {
  return text.compare(0, start.size(), start) == 0;
}

/// Both without links and dots.
bool is_inside(const fs::path& file, const fs::path& directory) {
  const auto [end_of_directory, rest] = std::mismatch(directory.begin(), directory.end(), file.begin(), file.end());
  return end_of_directory == directory.end() && rest != file.end();
}

/// The file without links and dots. Throws ResourceError where it is not there, or no regular file.
fs::path existing_file(const fs::path& path) {
  std::error_code error;
  const fs::path file = fs::canonical(path, error);
  if (error) throw ResourceError(error.message());
  if (!fs::is_regular_file(file, error)) throw ResourceError("it is not a file");
  if (fs::file_size(file, error) > largest_file) throw ResourceError(too_large);
  return file;
}

fs::path file_in_package(const std::string& path) {
  const std::size_t slash = std::min(path.find('/'), path.size());
  const std::string package = path.substr(0, slash);
  const std::optional<std::string> directory = find_package(package);
  if (!directory) throw ResourceError("package " + in_quotes(package) + " is not found in ROS_PACKAGE_PATH");
  // By what the path says, not by where its links lead: a package in a workspace may be made of links.
  const fs::path inside = fs::path(path.substr(slash)).relative_path().lexically_normal();
  if (!inside.empty() && *inside.begin() == "..") throw ResourceError("it is outside of the package");
  return existing_file(fs::path(*directory) / inside);
}

}  // namespace

std::string file_of(const std::string& uri, const FileAccess& access) {
  if (uri.find('\0') != std::string::npos) throw ResourceError("it names no file");
  const std::string package = "package://", file = "file://";
  if (starts_with(uri, package)) return file_in_package(uri.substr(package.size())).string();
  fs::path path;
  if (starts_with(uri, file)) {
    path = uri.substr(file.size());
    if (!path.is_absolute()) throw ResourceError("its path does not start with /");
  } else if (uri.find("://") != std::string::npos || uri.empty()) {
    throw ResourceError("it names no file");
  } else {
    path = fs::path(access.directory) / uri;
  }
  const fs::path found = existing_file(path);
  if (access.anywhere) return found.string();
  std::error_code error;
  const fs::path directory = access.directory.empty() ? fs::path() : fs::canonical(access.directory, error);
  if (directory.empty() || error || !is_inside(found, directory))
    throw ResourceError("it is outside of scene_directory " + in_quotes(access.directory));
  return found.string();
}

FileDescriptor open_regular_file(const std::string& path) {
  const auto fail = [](int error) { throw ResourceError(std::generic_category().message(error)); };
  // Without O_NONBLOCK, opening a pipe waits for its other end.
  FileDescriptor file(open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
  if (file.number() < 0) fail(errno);
  struct stat status;
  if (fstat(file.number(), &status) != 0) fail(errno);
  if (!S_ISREG(status.st_mode)) throw ResourceError("it is not a file");
  if (static_cast<std::uintmax_t>(status.st_size) > largest_file) throw ResourceError(too_large);
  return file;
}

std::string read_file(const std::string& path) {
  const FileDescriptor file = open_regular_file(path);
  std::string text;
  std::vector<char> block(std::size_t{1} << 16);
  while (true) {
    const ssize_t size = read(file.number(), block.data(), block.size());
    if (size < 0 && errno == EINTR) continue;
    if (size < 0) throw ResourceError(std::generic_category().message(errno));
    if (size == 0) return text;
    text.append(block.data(), static_cast<std::size_t>(size));
    if (text.size() > largest_file) throw ResourceError(too_large);  // it grows
  }
}

}  // namespace verlet_cable
